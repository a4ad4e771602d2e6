//! The contacts of a hammer in a record of its force.

/// Force, over its largest, that belongs to a contact.
const CONTACT: f64 = 0.1;
/// Longest force, over the record, that is a hammer's.
pub(super) const HAMMER: f64 = 0.1;

/// First and last sample of each contact; pauses shorter than the longest contact belong to it.
pub(super) fn contacts(force: &[f64]) -> Vec<(usize, usize)> {
    let most = force.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    if most == 0.0 {
        return Vec::new();
    }
    let mut found: Vec<(usize, usize)> = Vec::new();
    for n in (0..force.len()).filter(|&n| force[n].abs() > CONTACT * most) {
        match found.last_mut() {
            Some((first, last)) if n - *last <= (*last - *first).max(2) => *last = n,
            _ => found.push((n, n)),
        }
    }
    found
}

/// Whether a force is a hammer's: contacts that are short beside the record.
pub(super) fn is_blow(force: &[f64]) -> bool {
    let length: usize = contacts(force).iter().map(|(first, last)| last - first + 1).sum();
    length > 0 && length as f64 <= HAMMER * force.len() as f64
}
