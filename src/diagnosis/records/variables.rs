//! How parameters of laws are varied in a fit: logarithms where they are positive, so that no step leaves their range.

use crate::effects::{Effect, Parameter, Source};

/// How a parameter of a law is varied: its value and slope at `t`.
pub(crate) fn at_variable(parameter: &Parameter, scale: f64, t: f64) -> [f64; 2] {
    let width = parameter.greatest - parameter.least;
    if width.is_finite() {
        let share = 1.0 / (1.0 + (-t).exp());
        return [parameter.least + width * share, width * share * (1.0 - share)];
    }
    if parameter.least.is_finite() {
        let size = t.clamp(-300.0, 300.0).exp();
        return [parameter.least + size, size];
    }
    [scale * t, scale]
}

/// The variable at which [`at_variable`] gives `value`.
pub(crate) fn variable(parameter: &Parameter, scale: f64, value: f64) -> f64 {
    let width = parameter.greatest - parameter.least;
    if width.is_finite() {
        let share = ((value - parameter.least) / width).clamp(1e-6, 1.0 - 1e-6);
        return (share / (1.0 - share)).ln();
    }
    if parameter.least.is_finite() { (value - parameter.least).max(1e-300).ln() } else { value / scale }
}

/// Scales of parameters that may have either sign, by effect.
pub(crate) fn scales(effects: &[Source]) -> Vec<Vec<f64>> {
    effects.iter().map(|e| e.parameters.iter().map(|p| p.abs().max(1e-12)).collect()).collect()
}

/// Derivative of each law parameter by its variable.
pub(crate) fn slopes(effects: &[Source], scales: &[Vec<f64>]) -> Vec<f64> {
    let slopes_of_law = |(effect, scales): (&Source, &Vec<f64>)| -> Vec<f64> {
        let list: &[Parameter] = Effect::parameters(effect.effect);
        let slope =
            |(j, p): (usize, &Parameter)| at_variable(p, scales[j], variable(p, scales[j], effect.parameters[j]))[1];
        list.iter().enumerate().map(slope).collect()
    };
    effects.iter().zip(scales).flat_map(slopes_of_law).collect()
}
