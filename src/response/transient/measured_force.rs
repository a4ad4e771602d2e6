//! What channels show of a measured force beside the one that the steps take.
//!
//! Steps go straight from sample to sample, so that a band-limited force is given to them sharpened: then modes follow it as
//! they would follow the force itself. What feels a force at once feels the measured one `u`, not the sharpened `u_s`: the
//! accelerometer at the driven place, and coordinates above the sampled band, which follow without delay:
//!
//! ```text
//! y += (d + sum_fast c_k beta_k / (-lambda_k)) (u - u_s),    fast: |lambda_k| h > pi
//! ```
//!
//! `d` is the direct term of a channel (`phi^T M^-1 b` of an acceleration), `c_k` its share of the damped mode `z_k`.

use super::model::TransientModel;
use super::setup::SampledForces;
use dashpot_numerics::dot;
use faer::c64;
use std::f64::consts::PI;

impl TransientModel {
    /// Adds to `channels` what the measured forces are more than those of the steps.
    pub(super) fn add_measured(&self, forces: &SampledForces, channels: &mut [Vec<f64>]) {
        for (drive, (measured, marched)) in forces.measured.iter().zip(&forces.forces).enumerate() {
            let static_state = self.static_state_of_fast(self.legs.len() + drive, forces.step);
            for (sensor, list) in self.sensors.iter().zip(&mut *channels) {
                let direct = match sensor.drive {
                    Some(own) => f64::from(u8::from(own == drive)),
                    None => {
                        sensor.functional.inputs[self.legs.len() + drive] + dot(&sensor.functional.row, &static_state)
                    }
                };
                list.iter_mut().zip(measured.iter().zip(marched)).for_each(|(y, (u, s))| *y += direct * (u - s));
            }
        }
    }

    /// State under a unit force at an input of the damped modes beyond the band of samples `step` s apart.
    fn static_state_of_fast(&self, input: usize, step: f64) -> Vec<f64> {
        let at_rest = |(lambda, beta): (&c64, &c64)| match lambda.norm() * step {
            phase if phase > PI => -beta / lambda,
            _ => c64::new(0.0, 0.0),
        };
        let state: Vec<c64> = self.system.lambda.iter().zip(&self.system.beta[input]).map(at_rest).collect();
        state.iter().map(|z| z.re).chain(state.iter().map(|z| z.im)).collect()
    }
}
