//! The sampling rate out of the lines above a block of numbers.

use super::header_line::{HeaderLine, label, uncommented};
use super::number::number;
use crate::tree::{Sampling, sampling};

/// The time between samples out of a line such as `Sampling rate: 2048 Hz` or `dt [s];0.001`.
pub(crate) fn step(cells: &[String]) -> Option<f64> {
    let line = cells.join(" ").to_lowercase();
    let line = uncommented(&line);
    let end = line.find([':', '=']).unwrap_or(line.len());
    let key: String = line[..end].chars().take_while(|c| !c.is_ascii_digit()).collect();
    let plain: String = key.chars().filter(|c| c.is_alphanumeric()).collect();
    let rate = ["samplerate", "samplingrate", "samplefreq", "samplingfreq", "abtastrate", "abtastfreq", "messrate"];
    let interval = [
        "samplinginterval",
        "sampleinterval",
        "sampleperiod",
        "samplingperiod",
        "timestep",
        "deltat",
        "deltax",
        "abtastintervall",
    ];
    let is_rate = rate.iter().any(|word| plain.contains(word)) || matches!(plain.as_str(), "fs" | "fshz" | "sr");
    let is_interval =
        interval.iter().any(|word| plain.contains(word)) || matches!(plain.as_str(), "dt" | "dts" | "dtms");
    if !is_rate && !is_interval {
        return None;
    }
    let rest = &line[key.len().min(line.len())..];
    let value = rest
        .split(|c: char| c.is_whitespace() || matches!(c, ':' | '=' | ';' | '[' | ']' | '(' | ')'))
        .find_map(|word| number(word, false).or_else(|| number(word, true)))
        .filter(|value| *value > 0.0 && value.is_finite())?;
    let scale = if is_rate && line.contains("khz") {
        1e3
    } else if !is_rate && (line.contains(" ms") || line.contains("[ms]") || line.contains("(ms)")) {
        1e-3
    } else {
        1.0
    };
    Some(if is_rate { 1.0 / (value * scale) } else { value * scale })
}

/// Words that a table may have above numbers of another meaning.
const LOOSE: [&str; 4] = ["step", "interval", "dx", "ts"];

/// The time between samples that stands below its name, as oscilloscopes write it: `X,CH1,Start,Increment` above
/// `Sequence,Volt,0.0,1e-3`.
pub(super) fn step_below(lines: &[HeaderLine]) -> Option<f64> {
    lines.windows(2).find_map(|pair| {
        let [names, values] = pair else { return None };
        let below =
            names.cells.iter().zip(&values.cells).skip(1).filter(|(name, _)| !LOOSE.contains(&label(name).as_str()));
        let mut stated = below.filter_map(|(name, value)| sampling(name, number(value, false)?));
        stated.find_map(|sampling| match sampling {
            Sampling::Step(step) => Some(step),
            Sampling::Start(_) => None,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_understood() {
        let step_in = |text: &str| step(&text.split(';').map(str::to_owned).collect::<Vec<_>>());
        assert_eq!(step_in("# Sampling rate: 2000 Hz"), Some(1.0 / 2000.0));
        assert_eq!(step_in("Abtastrate;2,5 kHz"), Some(1.0 / 2500.0));
        assert_eq!(step_in("dt = 0.5 ms"), Some(0.0005));
        assert_eq!(step_in("date: 2024"), None);
        let lines = ["X,CH1,CH2,Start,Increment", "Sequence,Volt,Volt,-0.001,0.0005"];
        let lines = lines.map(|line| HeaderLine { cells: line.split(',').map(str::to_owned).collect() });
        assert_eq!((step_below(&lines), step_below(&lines[1..])), (Some(0.0005), None));
    }
}
