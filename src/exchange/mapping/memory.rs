//! Whether a record can be held in memory, told before any of it is read.

/// Bytes for each value of a run: samples, times, and the working copies of their fit.
const BYTES_A_VALUE: f64 = 48.0;

/// Memory that is free, bytes; none where the system does not say.
fn free() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? * 1024.0)
}

/// What is wrong where `values` numbers of `channels` channels are more than memory holds.
pub(super) fn too_large(values: u64, channels: usize) -> Option<String> {
    too_large_for(values, channels, free()?)
}

fn too_large_for(values: u64, channels: usize, free: f64) -> Option<String> {
    let bytes = values as f64 * BYTES_A_VALUE;
    (bytes > free).then(|| {
        format!(
            "{channels} channels with {values} values together need {:.0} GB of memory, and {:.0} GB are free; map fewer \
             channels, or cut the record into shorter ones",
            (bytes * 1e-9).ceil(),
            (free * 1e-9).floor()
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_said_in_words() {
        assert_eq!(too_large_for(1_000_000, 2, 1e9), None);
        let words = too_large_for(8_000_000_000, 16, 16e9).unwrap_or_default();
        assert!(
            words.starts_with("16 channels with 8000000000 values together need 384 GB of memory, and 16 GB are free"),
            "{words}"
        );
    }
}
