//! The kernels of Dashpot on the problems of `benches/peers/peers.py`: JSON in, JSON with answers and times out.
//!
//! ```sh
//! cargo run --release --no-default-features --example peers -- problems.json > ours.json
//! ```
#![allow(clippy::disallowed_methods, reason = "an example times itself")]

use anyhow::{Context, Result, anyhow};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::math::nnls::nnls;
use dashpot::math::subsets::{SubsetProblem, branch_and_bound};
use dashpot::measurement::{Channel, Quantity, Record, fit, frequency};
use dashpot::response::transient::{SampledForces, TransientModel, TransientParameter, TransientSetup};
use dashpot::structure::chain::ChainParameters;
use faer::Mat;
use serde::Deserialize;
use serde_json::{Value, json};
use std::time::Instant;

/// The same problem for everybody.
#[derive(Deserialize)]
struct Problems {
    nnls: Columns,
    subset: Columns,
    /// Sensors over time, one row a channel.
    steady: Steady,
    oscillator: Oscillator,
}

/// A right-hand side and columns that make it up; `size` of them at most.
#[derive(Deserialize)]
struct Columns {
    a: Vec<Vec<f64>>,
    b: Vec<f64>,
    #[serde(default)]
    size: usize,
}

impl Columns {
    fn matrix(&self) -> Mat<f64> {
        Mat::from_fn(self.a.len(), self.a[0].len(), |i, j| self.a[i][j])
    }
}

#[derive(Deserialize)]
struct Steady {
    time: Vec<f64>,
    channels: Vec<Vec<f64>>,
    harmonics: usize,
}

/// `x'' + c x' + k x + k3 x^3 = 0` from `x0` at rest.
#[derive(Deserialize)]
struct Oscillator {
    c: f64,
    k: f64,
    k3: f64,
    x0: f64,
    step: f64,
    samples: usize,
}

/// The answer and the median time of several repetitions, s.
fn timed<T>(repeat: usize, work: impl Fn() -> Result<T>) -> Result<(T, f64)> {
    let mut times = Vec::new();
    let mut answer = work()?;
    for _ in 0..repeat {
        let start = Instant::now();
        answer = work()?;
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    Ok((answer, times[repeat / 2]))
}

fn non_negative(p: &Columns) -> Result<Value> {
    let a = p.matrix();
    let (found, seconds) = timed(51, || Ok(nnls(a.as_ref(), &p.b)?))?;
    Ok(json!({ "x": found.solution, "seconds": seconds }))
}

fn best_subset(p: &Columns) -> Result<Value> {
    let a = p.matrix();
    let question = SubsetProblem { a: a.as_ref(), b: &p.b, size: p.size, keep: 1, forced: &[], node_limit: u64::MAX };
    let (found, seconds) = timed(5, || Ok(branch_and_bound(&question, &Control::unattended())?))?;
    let best = found.sets.first().context("no set")?;
    Ok(json!({ "columns": best.columns, "proved": found.proved, "seconds": seconds }))
}

fn harmonics(p: &Steady) -> Result<Value> {
    let quantity = |k: usize| if k == 0 { Quantity::Force } else { Quantity::Acceleration };
    let channel = |k: usize| Channel { quantity: quantity(k), dof: k, label: format!("{}", k + 1) };
    let channels = (0..p.channels.len()).map(channel).collect();
    let record = Record::new(p.time.clone(), channels, p.channels.clone())?;
    let work = || {
        let found = frequency::estimate(&record, p.harmonics)?;
        Ok((found.omega, fit(&record, found.omega, p.harmonics)?))
    };
    let ((omega, fitted), seconds) = timed(11, work)?;
    let parts_of_amplitudes =
        |c: &dashpot::measurement::ChannelFit| c.amplitudes.iter().map(|y| [y.re, y.im]).collect::<Vec<_>>();
    let amplitudes: Vec<_> = fitted.channels.iter().map(parts_of_amplitudes).collect();
    Ok(json!({ "omega": omega, "amplitudes": amplitudes, "seconds": seconds }))
}

/// The motion with its derivatives by `c`, `k3`, the initial place and speed, at every sample.
fn oscillation(p: &Oscillator) -> Result<Value> {
    let chain = ChainParameters { masses: vec![1.0], ground_stiffness: vec![p.k], coupling_stiffness: vec![] };
    let structure = chain.build(&[])?;
    let modes = structure.modes()?;
    let place = || Place::Dofs(vec![0]);
    let sources =
        [Source::known(Effect::Viscous, place(), &[p.c]), Source::known(Effect::CubicStiffness, place(), &[p.k3])];
    let channels = [Channel { quantity: Quantity::Displacement, dof: 0, label: "1".into() }];
    let setup = TransientSetup {
        structure: &structure,
        modes: &modes,
        kept: 1,
        sources: &sources,
        drives: &[],
        channels: &channels,
        factors: [1.0; 2],
        mode_stiffness: &[],
        mode_damping: &[],
        shape_errors: &[],
        parts: &[],
        directions: &[],
        step: [p.step; 2],
    };
    let model = TransientModel::new(&setup).map_err(|e| anyhow!("{e}"))?;
    let by = |source| TransientParameter::Source { source, parameter: 0 };
    let parameters = [by(0), by(1), TransientParameter::Initial(0), TransientParameter::Initial(1)];
    let mut answers = Vec::new();
    for substeps in [1, 4] {
        let forces = SampledForces {
            step: p.step,
            samples: p.samples,
            forces: Vec::new(),
            substeps,
            every: 1,
            step_lengths: Vec::new(),
        };
        let work = || model.predict(&forces, &[p.x0, 0.0], &parameters).map_err(|e| anyhow!("{e}"));
        let (found, seconds) = timed(5, work)?;
        answers.push(json!({ "substeps": substeps, "x": found.channels[0], "seconds": seconds }));
    }
    Ok(json!(answers))
}

fn main() -> Result<()> {
    let file = std::env::args().nth(1).context("say the file of problems")?;
    let problems: Problems = serde_json::from_str(&std::fs::read_to_string(&file).context(file)?)?;
    let answers = json!({
        "nnls": non_negative(&problems.nnls)?,
        "subset": best_subset(&problems.subset)?,
        "steady": harmonics(&problems.steady)?,
        "oscillator": oscillation(&problems.oscillator)?,
    });
    println!("{answers}");
    Ok(())
}
