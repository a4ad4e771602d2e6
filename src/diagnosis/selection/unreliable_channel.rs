//! A response channel that does not fit the others from run to run: a loose sensor, a cable that breaks. One that is relied on keeps
//! any law from agreeing, so that it is looked for before laws are: with its readings doubted, free forces at one place leave noise, and
//! without far more.

use crate::diagnosis::channels::{ChannelFault, Fault, mended};
use crate::diagnosis::localisation::cell::FreeForce;
use crate::diagnosis::localisation::free_force::Screen;
use crate::diagnosis::localisation::location::Spot;
use crate::diagnosis::residual::data::{DiagnosisError, if_possible};
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::updating::parameters::Updating;
use faer::c64;
use std::f64::consts::PI;

/// Fewest channels that are relied on: of two that do not fit each other either may be the loose one. One more for each channel that is
/// not relied on already, as what the others are out of tune by fits a doubt the sooner the fewer they are.
const FEWEST: usize = 3;
/// Scatters of what a channel reads, relative. With the greatest it is doubted first: then free forces explain the other channels alone.
/// Where the least is the likeliest it is not the channel.
const SCATTERS: [f64; 6] = [0.32, 0.16, 0.08, 0.04, 0.02, 0.01];
/// Squared residual per datum up to which free forces at a place leave noise, where the model is out of tune.
const NOISE: f64 = 2.0;
/// How many times as much must be left where any other channel is doubted, or none.
const PLAIN: f64 = 4.0;
/// Delays that are tried per radian of the highest frequency, and at most up to the longest.
const PER_RADIAN: f64 = 20.0;
const MOST_STEPS: f64 = 1e4;
/// Most channels that are doubted, of many.
const MOST_DOUBTED: usize = 12;
/// Most that are suspected of them.
const SUSPECTS: usize = 2;
/// Share of its squared errors which a constant gain and a delay may explain of a channel that scatters: where they explain more, most of
/// them is the same in all runs, which looseness is not.
const STEADY: f64 = 0.9;

/// A channel with its readings doubted.
struct Doubt {
    channel: String,
    /// Scatter of what it reads, relative.
    scatter: f64,
    /// Squared residual that free forces at the best place leave then, and `ln det` of the noise.
    left: f64,
    /// Number of that place.
    spot: usize,
}

impl ReferenceModel<'_> {
    /// The channel that plainly does not fit the others, whatever the model lacks at one of the places that `screen` sees from it.
    pub(super) fn unreliable_channel(&self, screen: &Screen) -> Result<Option<ChannelFault>, DiagnosisError> {
        let (all, doubts) = self.doubts(screen)?;
        let noise = NOISE * self.count() as f64;
        // Two channels alone agree beside many a place.
        let enough = doubts.len() > FEWEST;
        let Some(best) = doubts.first().filter(|best| enough && best.left < noise) else { return Ok(None) };
        let next = doubts.get(1).map_or(all, |next| next.left.min(all));
        if next < PLAIN * best.left.max(self.count() as f64) {
            return Ok(None);
        }
        self.scattering(best)
    }

    /// The channels that may be unreliable beside this model: that which lets free forces leave least when it is doubted, and the next where
    /// that lets them leave about as little. None where one is doubted already.
    pub(super) fn suspects(&self) -> Result<Vec<ChannelFault>, DiagnosisError> {
        if !self.data.doubted.is_empty() {
            return Ok(Vec::new());
        }
        let (_, doubts) = self.doubts(&self.view(None)?.screen)?;
        let noise = self.count() as f64;
        let least = doubts.first().map_or(0.0, |best| best.left.max(noise));
        let near = doubts.iter().take(SUSPECTS).filter(|doubt| doubt.left < PLAIN * least);
        let faults = near.map(|doubt| self.scattering(doubt)).collect::<Result<Vec<_>, _>>()?;
        Ok(faults.into_iter().flatten().collect())
    }

    /// What free forces at one place leave of this model, seen from it by `screen`, and the channels doubted one at a time, that which lets
    /// least be left first; none where free forces at a place that is no channel leave noise, or of too few channels.
    fn doubts(&self, screen: &Screen) -> Result<(f64, Vec<Doubt>), DiagnosisError> {
        let placings = screen.singles();
        let all = placings.first().map_or(0.0, |placing| placing.chi_square);
        let doubted = self.data.doubted.len();
        let few = self.data.channel_names()[0].len() < FEWEST + 2 * doubted;
        let noise = NOISE * self.count() as f64;
        let at_channel = placings.first().is_some_and(|best| matches!(screen.spots[best.spots[0]], Spot::Response(_)));
        if few || (all < noise && !at_channel) || self.control.is_late() {
            return Ok((all, Vec::new()));
        }
        // Those whose own errors explain most come first; where these alone leave noise, it may be one that does.
        let most = if all < noise { noise } else { f64::INFINITY };
        let response = |spot: &Spot| match spot {
            Spot::Response(name) if !self.data.doubted.contains(name) => Some(name.clone()),
            _ => None,
        };
        let likely = placings.iter().take_while(|placing| placing.chi_square <= most);
        let channels = likely.filter_map(|placing| response(&screen.spots[placing.spots[0]]));
        let channels: Vec<String> = channels.take(MOST_DOUBTED).collect();
        let doubt = |c: usize| self.doubt(&channels[c], SCATTERS[0], &self.linearisation.updating);
        let doubts = self.control.map(channels.len(), doubt).into_iter().collect::<Result<Vec<_>, _>>()?;
        let relative = |doubt: Doubt| Doubt { left: doubt.left - self.noise_determinant(), ..doubt };
        let mut doubts: Vec<Doubt> = doubts.into_iter().flatten().map(relative).collect();
        doubts.sort_by(|a, b| a.left.total_cmp(&b.left));
        Ok((all, doubts))
    }

    /// A channel doubted by a scatter; none where the model with `updating` has no response.
    fn doubt(&self, channel: &str, scatter: f64, updating: &Updating) -> Result<Option<Doubt>, DiagnosisError> {
        let doubt = Doubt { channel: channel.to_owned(), scatter, left: 0.0, spot: 0 };
        let data = mended(self.data, &[doubt.fault()]);
        let doubting = self.with_data(&data);
        let Some(doubting) = if_possible(doubting.updated(updating, &[], &Vec::new()))? else { return Ok(None) };
        let placings = doubting.view(None)?.screen.singles();
        let Some(best) = placings.first() else { return Ok(None) };
        let left = best.chi_square + doubting.noise_determinant();
        Ok(Some(Doubt { left, spot: best.spots[0], ..doubt }))
    }

    /// By how much the channel of `doubt` scatters: the likeliest of a few scatters, each beside free forces at the place that leaves least
    /// and the updating parameters that fit these. None where a gain and a delay explain what it reads.
    fn scattering(&self, doubt: &Doubt) -> Result<Option<ChannelFault>, DiagnosisError> {
        let updating = &self.linearisation.updating;
        let moved = |k: usize| -> Result<Option<(Doubt, Updating)>, DiagnosisError> {
            let Some(there) = self.doubt(&doubt.channel, SCATTERS[k], updating)? else { return Ok(None) };
            let data = mended(self.data, &[there.fault()]);
            let Some((_, updating)) = self.with_data(&data).moved_beside_place(updating.clone(), there.spot)? else {
                return Ok(None);
            };
            Ok(self.doubt(&doubt.channel, SCATTERS[k], &updating)?.map(|moved| (moved, updating)))
        };
        let moved = self.control.map(SCATTERS.len(), moved).into_iter().collect::<Result<Option<Vec<_>>, _>>()?;
        let Some(moved) = moved else { return Ok(None) };
        let Some(scatter) = likeliest(&moved.iter().map(|(doubt, _)| doubt.left).collect::<Vec<f64>>()) else {
            return Ok(None);
        };
        let Some((best, updating)) = moved.into_iter().min_by(|(a, _), (b, _)| a.left.total_cmp(&b.left)) else {
            return Ok(None);
        };
        let best = Doubt { scatter, ..best };
        Ok((!self.is_steady(&best, &updating)?).then(|| best.fault()))
    }

    /// Whether a gain and a delay explain what the channel of `doubt` reads beside free forces at its place.
    fn is_steady(&self, doubt: &Doubt, updating: &Updating) -> Result<bool, DiagnosisError> {
        let data = mended(self.data, &[doubt.fault()]);
        let screen = self.with_data(&data).updated(updating, &[], &Vec::new())?.view(None)?.screen;
        let is_own = |spot: &Spot| matches!(spot, Spot::Response(name) if *name == doubt.channel);
        let own = screen.spots.iter().position(is_own).filter(|&own| own != doubt.spot);
        let spots: Vec<usize> = std::iter::once(doubt.spot).chain(own).collect();
        let Some(errors) = screen.forces(&spots).pop() else { return Ok(false) };
        let omegas: Vec<f64> = self.data.runs.iter().map(|run| run.omega).collect();
        Ok(are_steady(&errors, &omegas))
    }
}

impl Doubt {
    fn fault(&self) -> ChannelFault {
        ChannelFault {
            fault: Fault::Unreliable(self.scatter),
            channels: vec![self.channel.clone()],
            error_before: self.scatter,
            error_after: self.scatter,
            own_error: [self.scatter; 2],
            frequencies: [0, 0],
        }
    }
}

/// The scatter by what is `left` with each of [`SCATTERS`], between them by a parabola over their logarithms; none where the least is the
/// likeliest.
fn likeliest(left: &[f64]) -> Option<f64> {
    let best = (0..left.len()).min_by(|&a, &b| left[a].total_cmp(&left[b]))?;
    let (above, below) = (best.checked_sub(1).map(|k| left[k]), *left.get(best + 1)?);
    let curvature = |above: f64| above - 2.0 * left[best] + below;
    let step =
        above.filter(|&above| curvature(above) > 0.0).map_or(0.0, |above| 0.5 * (above - below) / curvature(above));
    Some(SCATTERS[best] * 0.5_f64.powf(step))
}

/// Whether a gain `g` and a delay `t` explain most of the squares of the free relative errors `1 - g exp(-i w t)`, `[run][harmonic]`, of a
/// channel at the circular frequencies `w` of the runs (rad/s). Delays are looked for up to half the longest period.
fn are_steady(errors: &[Vec<FreeForce>], omegas: &[f64]) -> bool {
    let fundamentals = errors.iter().zip(omegas).filter_map(|(list, omega)| Some((list.first()?.value, *omega)));
    let fundamentals: Vec<(c64, f64)> = fundamentals.collect();
    let count = fundamentals.len() as f64;
    let all: f64 = fundamentals.iter().map(|(error, _)| error.norm_sqr()).sum();
    let lowest = omegas.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = omegas.iter().copied().fold(0.0, f64::max);
    let steps = (PER_RADIAN * PI * highest / lowest).ceil().min(MOST_STEPS);
    let left = |delay: f64| {
        let turned =
            || fundamentals.iter().map(move |(error, omega)| (1.0 - error) * c64::from_polar(1.0, omega * delay));
        let gain = turned().map(|ratio| ratio.re).sum::<f64>() / count;
        turned().map(|ratio| (ratio - gain).norm_sqr()).sum::<f64>()
    };
    let delays = (0..=2 * steps as usize).map(|k| (k as f64 / steps - 1.0) * PI / lowest);
    delays.map(left).fold(f64::INFINITY, f64::min) < (1.0 - STEADY) * all
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn errors(values: &[c64]) -> Vec<Vec<FreeForce>> {
        values.iter().map(|&value| vec![FreeForce { value, weight: 1.0 }]).collect()
    }

    /// Minus twice the logarithm of the normal likelihood of errors is least at their own scatter.
    #[test]
    fn the_likeliest_scatter_is_that_of_the_errors() {
        let left = |truth: f64| SCATTERS.map(|s| 100.0 * (2.0 * s.ln() + (truth / s).powi(2)));
        for truth in [0.04, 0.055, 0.03, 0.1] {
            let found = likeliest(&left(truth)).unwrap();
            assert!((found / truth).ln().abs() < 0.2, "{found} {truth}");
        }
        assert_eq!((likeliest(&left(0.004)), likeliest(&left(2.0))), (None, Some(SCATTERS[0])));
    }

    #[test]
    fn a_gain_and_a_delay_are_steady_and_looseness_is_not() {
        let omegas = [100.0, 200.0, 400.0, 800.0];
        for (gain, delay) in [(1.1, 2e-4), (0.7, 3e-3), (1.05, -1e-3), (1.0, 5e-4)] {
            let read = omegas.map(|w| c64::new(1.0, 0.0) - c64::from_polar(gain, -delay * w));
            assert!(are_steady(&errors(&read), &omegas), "{gain} {delay} s");
        }
        let loose = [0.08, -0.06, 0.05, -0.07].map(|g| c64::new(g, 0.0));
        assert!(!are_steady(&errors(&loose), &omegas));
    }
}
