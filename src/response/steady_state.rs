//! Linear steady state under a periodic force, harmonic by harmonic: `Z(h omega) X_h = F_h`.

use super::dynamic_stiffness::{DynamicStiffness, DynamicStiffnessError};
use faer::c64;

/// Complex displacement amplitudes of harmonics 1..H, m, for force amplitudes `forces[h - 1]` in N (n values each) at
/// the fundamental circular frequency `omega` (rad/s). Harmonics without force are at rest.
///
/// # Errors
/// [`DynamicStiffnessError`] when a harmonic meets an undamped resonance or a force has the wrong length.
pub fn steady_state(
    stiffness: &DynamicStiffness<'_>,
    omega: f64,
    forces: &[Vec<c64>],
) -> Result<Vec<Vec<c64>>, DynamicStiffnessError> {
    let silent = |force: &[c64]| force.iter().all(|f| f.re == 0.0 && f.im == 0.0);
    forces
        .iter()
        .enumerate()
        .map(|(index, force)| {
            if force.len() == stiffness.size() && silent(force) {
                return Ok(vec![c64::new(0.0, 0.0); force.len()]);
            }
            stiffness.solve((index + 1) as f64 * omega, force)
        })
        .collect()
}
