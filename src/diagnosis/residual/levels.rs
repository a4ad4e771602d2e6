//! Levels of the runs: their labels where all have one, else amplitudes that runs share. Tests are controlled by the force
//! or by the response; what is held within a level is what little of it scatters.

use super::data::{Data, Problem, RunData};
use super::whiteness::numbered;
use crate::measurement::Quantity;

/// Runs without labels whose forces differ by less than this share are of one level.
const SAME_LEVEL: f64 = 0.2;
/// Scatter of a response within its levels, relative, up to which a controller may have held it.
const HELD: f64 = 0.05;
/// Scatter of the force within its levels from which on it was not what was held; nor was it where it has more levels than
/// a response that was held.
const LOOSE: f64 = 0.15;

/// The level of every run.
pub(crate) struct Levels {
    /// Numbers from the least level up.
    pub numbers: Vec<usize>,
    /// Name of each run's level.
    pub names: Vec<String>,
}

/// Least runs to a session from which on sessions are told apart.
const RUNS_OF_A_SESSION: usize = 4;

/// The session of every run: as they are named, else the level it was measured at, or of frequency responses the force that they are
/// of; none where there is but one, or hardly a run to each.
pub(crate) fn sessions(problem: &Problem, data: &Data) -> Vec<usize> {
    let names: Option<Vec<&String>> = data.runs.iter().map(|run| problem.runs[run.index].session.as_ref()).collect();
    let numbers = match names {
        Some(names) => first_alike(&names),
        None if data.per_unit_force => {
            first_alike(&data.runs.iter().map(|run| run.forces.first().map(|force| &force.name)).collect::<Vec<_>>())
        }
        None => Levels::new(problem, data).numbers,
    };
    let mut distinct: Vec<usize> = numbers.clone();
    distinct.sort_unstable();
    distinct.dedup();
    if distinct.len() < 2 || data.runs.len() < RUNS_OF_A_SESSION * distinct.len() {
        return Vec::new();
    }
    numbers.iter().map(|number| distinct.iter().position(|other| other == number).unwrap_or(0)).collect()
}

/// The number of the first of `keys` that is the same, of each.
fn first_alike<T: PartialEq>(keys: &[T]) -> Vec<usize> {
    keys.iter().map(|key| keys.iter().position(|other| other == key).unwrap_or(0)).collect()
}

impl Levels {
    /// Levels of the runs of `data`.
    pub(crate) fn new(problem: &Problem, data: &Data) -> Self {
        let labels = data.runs.iter().map(|run| problem.runs[run.index].level);
        if let Some(labels) = labels.collect::<Option<Vec<i64>>>() {
            return Self::labelled(&labels);
        }
        let force = |run: &RunData| run.forces.iter().map(|f| f.measured.first().map_or(0.0, |f| f.norm())).sum();
        let forces = Self::by_amplitude(&data.runs.iter().map(force).collect::<Vec<f64>>(), "N");
        match held_response(data) {
            Some(held) if forces.scatter > LOOSE || held.count < forces.count => held.levels,
            _ => forces.levels,
        }
    }

    fn labelled(labels: &[i64]) -> Self {
        let mut sorted = labels.to_vec();
        sorted.sort_unstable();
        sorted.dedup();
        let number = |label: &i64| sorted.iter().position(|s| s == label).unwrap_or(0);
        Self { numbers: labels.iter().map(number).collect(), names: labels.iter().map(i64::to_string).collect() }
    }

    fn by_amplitude(amplitudes: &[f64], unit: &str) -> Grouped {
        let numbers = numbered(amplitudes, SAME_LEVEL);
        let own = |number: usize| amplitudes.iter().zip(&numbers).filter(move |(_, n)| **n == number).map(|(a, _)| *a);
        let name = |number: &usize| {
            let (least, most) = own(*number).fold((f64::INFINITY, 0.0_f64), |(a, b), f| (a.min(f), b.max(f)));
            if most > 1.01 * least { format!("{least:.3} to {most:.3} {unit}") } else { format!("{most:.3} {unit}") }
        };
        let squares = amplitudes.iter().zip(&numbers).map(|(a, &number)| {
            let mean = own(number).sum::<f64>() / own(number).count() as f64;
            if mean > 0.0 { (a / mean - 1.0).powi(2) } else { 0.0 }
        });
        let scatter = (squares.sum::<f64>() / amplitudes.len().max(1) as f64).sqrt();
        let count = numbers.iter().max().map_or(0, |most| most + 1);
        let names = numbers.iter().map(name).collect();
        Grouped { scatter, count, levels: Self { numbers, names } }
    }
}

/// Levels by an amplitude, and how much it scatters within them.
struct Grouped {
    scatter: f64,
    count: usize,
    levels: Levels,
}

/// Levels by the response that scatters least within its own, where one was held.
fn held_response(data: &Data) -> Option<Grouped> {
    let [names, _] = data.channel_names();
    let candidates = names.iter().filter_map(|name| {
        let amplitude = |run: &RunData| {
            let channel = run.responses.iter().find(|c| c.name == *name)?;
            Some((channel.measured.first()?.norm(), channel.quantity))
        };
        let found = data.runs.iter().map(amplitude).collect::<Option<Vec<(f64, Quantity)>>>()?;
        let unit = format!("{} of {name}", found.first()?.1.si_unit(false));
        let amplitudes: Vec<f64> = found.into_iter().map(|(amplitude, _)| amplitude).collect();
        Some(Levels::by_amplitude(&amplitudes, &unit))
    });
    let held = candidates.filter(|g| g.scatter < HELD && 2 * g.count <= g.levels.numbers.len());
    held.min_by(|a, b| a.scatter.total_cmp(&b.scatter))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::measurement::{Channel, ChannelFit, HarmonicFit, Run};
    use crate::structure::chain::ChainParameters;
    use faer::{Mat, c64};

    fn run(name: usize, omega: f64, force: f64, acceleration: f64) -> Run {
        let channel = |quantity, amplitude: f64| ChannelFit {
            channel: Channel { quantity, dof: 0, label: "1".into() },
            offset: 0.0,
            slope: 0.0,
            amplitudes: vec![c64::new(amplitude, 0.0)],
            covariance: Mat::zeros(2, 2),
            noise: 0.0,
        };
        let channels = vec![channel(Quantity::Force, force), channel(Quantity::Acceleration, acceleration)];
        let fit = HarmonicFit { omega, omega_deviation: 0.0, channels };
        Run::from_harmonics(name.to_string(), None, true, fit, &[])
    }

    fn numbers(runs: &[Run]) -> (Vec<usize>, String) {
        let chain = ChainParameters { masses: vec![1.0], ground_stiffness: vec![1e4], coupling_stiffness: vec![] };
        let structure = chain.build(&[]).unwrap();
        let problem = Problem { structure: &structure, sources: &[], runs };
        let levels = Levels::new(&problem, &Data::new(&problem).unwrap());
        (levels.numbers, levels.names[0].clone())
    }

    /// Under a held response the force passes through its least at resonance; under a held force the response peaks.
    #[test]
    fn runs_belong_together_by_what_the_controller_held() {
        let peak = |omega: f64| 1.0 / (1.0 - omega * omega / 1e4).hypot(0.02);
        let (mut by_response, mut by_force) = (Vec::new(), Vec::new());
        for (level, size) in [1.0, 3.0].into_iter().enumerate() {
            for k in 0..9 {
                let (omega, wobble) = (92.0 + 2.0 * f64::from(k), 1.0 + 0.01 * f64::from(k % 3));
                by_response.push(run(100 * level, omega, size / peak(omega), size * wobble));
                by_force.push(run(100 * level, omega, size * wobble, size * peak(omega)));
            }
        }
        let expected: Vec<usize> = (0..18).map(|k| usize::from(k >= 9)).collect();
        assert_eq!(numbers(&by_response), (expected.clone(), "1.000 to 1.020 m/s^2 of acc@1".to_owned()));
        assert_eq!(numbers(&by_force), (expected, "1.000 to 1.020 N".to_owned()));
    }
}
