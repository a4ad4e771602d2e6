//! The functions of a test on all lines of its band.

use super::{ChannelCorrection, ResponseSet};
use crate::measurement::Channel;
use crate::measurement::whole_functions::{WholeFunction, WholeFunctions};
use faer::c64;
use std::f64::consts::TAU;

impl ResponseSet {
    /// All lines in the band; `variances` are those of the functions as they are measured.
    pub(super) fn whole(
        &self,
        band: [f64; 2],
        variances: &[Vec<f64>],
        corrections: &[ChannelCorrection],
    ) -> WholeFunctions {
        let inside = |line: &usize| (band[0]..=band[1]).contains(&self.frequencies_hz[*line]);
        let lines: Vec<usize> = (0..self.frequencies_hz.len()).filter(inside).collect();
        let omega: Vec<f64> = lines.iter().map(|&line| TAU * self.frequencies_hz[line]).collect();
        let whole = |(function, variance): (&super::FrequencyResponse, &Vec<f64>)| {
            let derivatives = function.response.quantity.derivatives().unwrap_or(0);
            let factor = |w: f64| {
                let [motion, force] = [&function.response, &function.reference].map(|c| undone(corrections, c, w));
                motion / force * c64::new(0.0, w).powi(-derivatives)
            };
            let factors: Vec<c64> = omega.iter().map(|&w| factor(w)).collect();
            let at = lines.iter().zip(&factors);
            WholeFunction {
                response: function.response.dof,
                reference: function.reference.dof,
                receptance: at.clone().map(|(&line, z)| function.values[line] * z).collect(),
                deviation: at.map(|(&line, z)| variance[line].sqrt() * z.norm()).collect(),
            }
        };
        let functions = self.functions.iter().zip(variances).map(whole).collect();
        WholeFunctions { omega, functions }
    }
}

/// What undoes all known errors of a channel at a circular frequency.
fn undone(corrections: &[ChannelCorrection], channel: &Channel, omega: f64) -> c64 {
    corrections.iter().filter(|error| error.is_of(channel)).map(|error| error.undone(omega)).product()
}
