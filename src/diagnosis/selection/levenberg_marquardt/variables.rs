//! The variables in which parameters are fitted: positive ones in their logarithm, those within limits between them, others in
//! units of their start, so that steps are of order one whatever the unit.

use crate::effects::{Parameter, Source};

/// One variable behind a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Variable {
    /// `p = exp(theta)`, from a least to a greatest value.
    Log(f64, f64),
    /// `p = unit theta`.
    Scaled(f64),
    /// `p = low + (high - low) / (1 + exp(-theta))`.
    Between(f64, f64),
}

/// Largest variable of a parameter within limits: a hundredth of their distance from them. Beyond, its derivative dies out, and a
/// descent that once overshot would never return.
const INSIDE: f64 = 4.6;

impl Variable {
    fn new(parameter: &Parameter, value: f64) -> Self {
        // What is above zero and may be many times its least value would hardly come near that between both.
        if parameter.least > 0.0 || (parameter.least == 0.0 && parameter.greatest.is_infinite()) {
            Self::Log(parameter.least, parameter.greatest)
        } else if parameter.least.is_finite() && parameter.greatest.is_finite() {
            Self::Between(parameter.least, parameter.greatest)
        } else {
            Self::Scaled(if value == 0.0 { 1e-6 } else { value.abs() })
        }
    }

    fn unknown_of(self, value: f64) -> f64 {
        match self {
            Self::Log(..) => value.max(1e-300).ln(),
            Self::Scaled(unit) => value / unit,
            Self::Between(low, high) => {
                let share = ((value - low) / (high - low)).clamp(1e-6, 1.0 - 1e-6);
                (share / (1.0 - share)).ln().clamp(-INSIDE, INSIDE)
            }
        }
    }

    fn to_value(self, theta: f64) -> f64 {
        match self {
            Self::Log(low, high) => theta.clamp(-600.0, 600.0).exp().clamp(low, high),
            Self::Scaled(unit) => unit * theta,
            Self::Between(low, high) => low + (high - low) / (1.0 + (-theta.clamp(-INSIDE, INSIDE)).exp()),
        }
    }

    /// Derivative of the parameter by the variable.
    fn slope(self, theta: f64) -> f64 {
        match self {
            Self::Log(..) => self.to_value(theta),
            Self::Scaled(unit) => unit,
            Self::Between(low, high) => {
                let share = (self.to_value(theta) - low) / (high - low);
                (high - low) * share * (1.0 - share)
            }
        }
    }
}

impl Variable {
    /// Least and largest value.
    fn bounds(self) -> [f64; 2] {
        match self {
            Self::Log(low, high) => [low.ln(), high.ln()],
            Self::Scaled(_) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Between(..) => [-INSIDE, INSIDE],
        }
    }
}

/// The variables of the parameters of some effects, in order.
#[derive(Debug, Clone)]
pub(crate) struct Variables {
    template: Vec<Source>,
    variables: Vec<Variable>,
}

impl Variables {
    /// All parameters of `effects`, with their variables at the start.
    pub(crate) fn new(effects: &[Source]) -> (Self, Vec<f64>) {
        let mut variables = Vec::new();
        let mut start = Vec::new();
        for effect in effects {
            for (parameter, &value) in effect.effect.parameters().iter().zip(&effect.parameters) {
                let variable = Variable::new(parameter, value);
                variables.push(variable);
                start.push(variable.unknown_of(value));
            }
        }
        (Self { template: effects.to_vec(), variables }, start)
    }

    /// Number of variables.
    pub(crate) fn len(&self) -> usize {
        self.variables.len()
    }

    /// Least and largest value of each.
    pub(crate) fn bounds(&self) -> Vec<[f64; 2]> {
        self.variables.iter().map(|v| v.bounds()).collect()
    }

    /// The effects at `theta`.
    pub(crate) fn effects(&self, theta: &[f64]) -> Vec<Source> {
        let mut effects = self.template.clone();
        let values = self.variables.iter().zip(theta).map(|(v, &t)| v.to_value(t));
        effects.iter_mut().flat_map(|e| e.parameters.iter_mut()).zip(values).for_each(|(p, v)| *p = v);
        effects
    }

    /// Derivative of each parameter by its variable.
    pub(crate) fn slopes(&self, theta: &[f64]) -> Vec<f64> {
        self.variables.iter().zip(theta).map(|(v, &t)| v.slope(t)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Effect, Place};

    /// Bouc-Wen hysteresis of exponent 1, the least of 1 to 50, is a bound that is reached, and none that steps leave.
    #[test]
    fn the_least_exponent_is_reached() {
        let source = Source::known(Effect::BoucWen, Place::Dofs(vec![0]), &[5e3, 2.0, 1.3]);
        let (variables, start) = Variables::new(&[source]);
        let [least, greatest] = variables.bounds()[2];
        let exponent = |theta: f64| variables.effects(&[start[0], start[1], theta])[0].parameters[2];
        assert!((exponent(start[2]) - 1.3).abs() < 1e-12);
        assert_eq!([exponent(least), exponent(least - 1.0), exponent(greatest + 1.0)], [1.0, 1.0, 50.0]);
        let slope = (exponent(start[2] + 1e-6) - exponent(start[2] - 1e-6)) / 2e-6;
        assert!((variables.slopes(&start)[2] - slope).abs() < 1e-6);
    }
}
