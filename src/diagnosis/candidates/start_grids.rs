//! Starts of the parameters of every law: a small sensible grid of the shape, whose scale is found linearly.
//!
//! Every law is proportional to a common factor of some of its parameters (`F(s p) = s F(p)`): its coefficient, or
//! stiffness and force of a slider together. The other parameters shape the force; their grid is laid over the motion
//! that was measured.

use crate::effects::Effect;

/// Range of a motion over the runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Largest relative displacement, m.
    pub displacement: f64,
    /// Least of the runs' amplitudes, m.
    pub least: f64,
    /// Largest relative velocity, m/s.
    pub velocity: f64,
    /// Geometric mean of the circular frequencies, rad/s.
    pub omega: f64,
}

/// Which parameters share the factor to which the force is proportional.
pub fn scaled(effect: Effect) -> &'static [usize] {
    match effect {
        Effect::ElasticSlider | Effect::Maxwell | Effect::Iwan | Effect::Stribeck => &[0, 1],
        _ => &[0],
    }
}

/// Parameters of unit scale on the grid of shapes.
pub fn shapes(effect: Effect, range: &Range) -> Vec<Vec<f64>> {
    let yields = geometric(0.3 * range.least.max(0.02 * range.displacement), 0.95 * range.displacement, 8);
    match effect {
        Effect::Power => [0.25, 0.5, 0.75, 1.3, 1.6, 2.5, 3.0].map(|e| vec![1.0, e]).to_vec(),
        Effect::Fractional => [0.15, 0.3, 0.45, 0.6, 0.75, 0.9].map(|order| vec![1.0, order]).to_vec(),
        Effect::Gap => geometric(0.1 * range.displacement, 0.95 * range.displacement, 10)
            .into_iter()
            .map(|gap| vec![1.0, gap])
            .collect(),
        Effect::ElasticSlider => yields.into_iter().map(|x| vec![1.0, x]).collect(),
        Effect::Maxwell => [0.1, 0.3, 1.0, 3.0, 10.0].map(|x| vec![1.0, x / range.omega]).to_vec(),
        Effect::Stribeck => {
            let velocities = geometric(0.02 * range.velocity, 0.8 * range.velocity, 5);
            velocities.into_iter().flat_map(|v| [1.3, 2.0, 4.0].map(|s| vec![1.0, s, v])).collect()
        }
        Effect::Iwan => geometric(0.1 * range.least.max(0.05 * range.displacement), 3.0 * range.displacement, 6)
            .into_iter()
            .flat_map(|x| [-0.7, -0.4, -0.1].into_iter().flat_map(move |chi| [0.3, 1.5].map(|b| vec![1.0, x, chi, b])))
            .collect(),
        _ => vec![vec![1.0; effect.parameters().len()]],
    }
}

/// `count` values from `first` to `last` in equal ratios.
fn geometric(first: f64, last: f64, count: usize) -> Vec<f64> {
    let (first, last) = (first.max(1e-300), last.max(1e-300));
    let ratio = (last / first).powf(1.0 / (count - 1) as f64);
    (0..count).map(|k| first * ratio.powi(k as i32)).collect()
}
