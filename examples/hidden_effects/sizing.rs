//! Where the hidden effects act and how large they are: such that the response changes by a wanted share.

use super::random::Random;
use dashpot::control::Control;
use dashpot::effects::{Effect, Kind, Place, Source};
use dashpot::response::harmonic_balance::{Excitation, ForwardModel, Response, Settings};
use dashpot::structure::Structure;

/// A random place for an effect, its parameters to be sized.
pub(crate) fn place(
    effect: Effect,
    structure: &Structure,
    sensors: &[usize],
    force: usize,
    random: &mut Random,
) -> Source {
    let place = match effect.kind() {
        Kind::Whole(_) => Place::Whole(None),
        Kind::Channel(_) => {
            let n = random.below(sensors.len() + 1);
            let response = |&s: &usize| format!("acc@{}", structure.label(s));
            Place::Channel(sensors.get(n).map_or(format!("force@{}", structure.label(force)), response))
        }
        Kind::Relative(_) => Place::Dofs(dofs(structure, random)),
    };
    Source::candidate(effect, place)
}

fn dofs(structure: &Structure, random: &mut Random) -> Vec<usize> {
    let (pairs, translations) = (structure.neighbours(), structure.translations());
    match random.uniform() {
        x if x < 0.3 => pairs[random.below(pairs.len())].to_vec(),
        x if x < 0.38 => vec![random.below(structure.len())],
        _ => vec![translations[random.below(translations.len())]],
    }
}

/// What sizes an effect: the largest relative displacement and velocity at its place, and a mean frequency.
struct Scale {
    d: f64,
    v: f64,
    omega: f64,
}

impl Scale {
    fn new(source: &Source, before: &[Response]) -> Self {
        let leg = source.place.legs().first().copied();
        let relative_amplitude = |r: &Response| leg.map_or(1.0, |l| l.relative(|i| r.amplitude(i, 1)).norm());
        let largest = |weight: &dyn Fn(f64) -> f64| {
            before.iter().map(|r| weight(r.omega) * relative_amplitude(r)).fold(0.0, f64::max)
        };
        let logs = before.iter().map(|r| r.omega.ln()).sum::<f64>();
        Self { d: largest(&|_| 1.0), v: largest(&|w| w), omega: (logs / before.len() as f64).exp() }
    }

    fn shaped(&self, effect: Effect, s: f64) -> Vec<f64> {
        shaped(effect, [self.d, self.v, self.omega], s)
    }
}

/// Parameters of an effect whose force is about `s` at the displacement `d`, the velocity `v` and the circular frequency
/// `omega`.
pub(crate) fn shaped(effect: Effect, [d, v, omega]: [f64; 3], s: f64) -> Vec<f64> {
    match effect {
        Effect::Power => vec![s / v.powf(1.6), 1.6],
        Effect::Fractional => vec![s / d / omega.powf(0.4), 0.4],
        Effect::ElasticSlider | Effect::Dahl => vec![s / (0.25 * d), s],
        Effect::BoucWen => vec![s / (0.25 * d), s, 1.5],
        Effect::StiffeningBoucWen => vec![0.7 * s / d, s, 0.3],
        Effect::AsymmetricViscous => vec![s / v, 0.5 * s / v],
        Effect::AsymmetricCoulomb => vec![s, 0.3 * s],
        Effect::Maxwell => vec![s / d, s / d / omega],
        Effect::Iwan => vec![s / (0.3 * d), s, -0.5, 1.0],
        Effect::Stribeck => vec![s, 2.0 * s, 0.1 * v],
        Effect::Gap | Effect::Stop => vec![s / d, 0.4 * d],
        Effect::ElasticSliderBacklash => vec![s / (0.25 * d), s, 0.2 * d],
        Effect::Coulomb => vec![s],
        Effect::Viscous => vec![s / v],
        Effect::Quadratic => vec![s / (v * v)],
        Effect::CubicStiffness => vec![s / d.powi(3)],
        Effect::QuadraticStiffness => vec![s / (d * d)],
        Effect::Mass => vec![s / (d * omega.powi(2))],
        Effect::LossFactor => vec![1e-2 * s],
        Effect::StiffnessProportional => vec![1e-2 * s / omega],
        Effect::MassProportional => vec![1e-2 * s * omega],
        _ => vec![s / d],
    }
}

/// Parameters such that the response changes by `target`; `None` where that cannot be had.
pub(crate) fn size(
    mut source: Source,
    structure: &Structure,
    known: &[Source],
    excitations: &[Excitation],
    sensors: &[usize],
    target: f64,
    random: &mut Random,
) -> Option<Source> {
    if matches!(source.effect.kind(), Kind::Channel(_)) {
        source.parameters = match source.effect {
            Effect::Delay => vec![random.within(2e-4, 8e-4) * target / 0.3],
            _ => vec![1.0 + target.min(0.5) * random.sign()],
        };
        return Some(source);
    }
    let base = ForwardModel::new(structure, known).unwrap();
    let control = Control::unattended();
    let respond = |model: &ForwardModel, e: &Excitation| model.respond(e, &Settings::fixed(7), None, &control).ok();
    let before: Vec<Response> = excitations.iter().map(|e| respond(&base, e)).collect::<Option<Vec<_>>>()?;
    let scale = Scale::new(&source, &before);
    let mut s = 0.02 * excitations[0].forces[0].harmonics[0].norm();
    for _ in 0..16 {
        source.parameters = scale.shaped(source.effect, s);
        let model = ForwardModel::new(structure, &[known, std::slice::from_ref(&source)].concat()).ok()?;
        let mut errors = Vec::new();
        for (e, b) in excitations.iter().zip(&before) {
            let after = respond(&model, e)?;
            let size = sensors.iter().map(|&i| after.amplitude(i, 1).norm()).fold(0.0, f64::max);
            for &i in sensors {
                let a = after.amplitude(i, 1);
                errors.push(((a - b.amplitude(i, 1)).norm() / a.norm().max(size / 20.0)).powi(2));
            }
        }
        let error = (errors.iter().sum::<f64>() / errors.len() as f64).sqrt();
        let ratio = (target / error).clamp(0.2, 5.0);
        if (ratio - 1.0).abs() < 0.15 {
            break;
        }
        s *= ratio.powf(0.8);
    }
    Some(source)
}
