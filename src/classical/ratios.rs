//! Methods of [`super::side_by_side`] that give damping ratios only, applied to the peaks and runs of each mode.

use super::error::ClassicalError;
use super::isolated::{about, alone};
use super::measured_ratios::{SAME_MODE, circle_ratios, half_power_ratios};
use super::resonant;
use super::responses::FrequencyResponses;
use super::side_by_side::{Applied, Data, Ratio, missing};
use faer::c64;
use std::f64::consts::{PI, TAU};

/// Least ratio of forces between runs of one mode that can tell friction from viscous damping: along one sweep the other
/// modes' share of the motion would pass for friction.
const LEVELS: f64 = 1.5;
/// Least part of a mode's largest displacement at the drive that shows the mode there.
const SEEN: f64 = 0.2;

impl Data<'_> {
    /// Ratios only, one a mode of the model at most.
    fn of_ratios(&self, found: impl IntoIterator<Item = (f64, f64)>, what: &str) -> Result<Applied, ClassicalError> {
        let mut ratios: Vec<Ratio> = Vec::new();
        for (omega, ratio) in found {
            let Some(mode) = self.model.nearest(omega) else { continue };
            let near = (omega - self.model.omega[mode]).abs() < SAME_MODE * self.model.omega[mode];
            if near && ratio.is_finite() && ratios.iter().all(|r| r.mode != mode) {
                ratios.push(Ratio { mode, frequency_hz: omega / TAU, ratio });
            }
        }
        ratios.sort_by_key(|r| r.mode);
        if ratios.is_empty() {
            return missing(what);
        }
        Ok(Applied { damping: None, ratios, eps_p: None, errors: None })
    }

    pub(super) fn half_power(&self) -> Result<Applied, ClassicalError> {
        let found = half_power_ratios(&self.model, self.responses()?, self.extracted);
        let what = "three lines within the half-power band of a peak, and lines on both flanks";
        self.of_ratios(found.iter().map(|r| (r.omega, r.ratio)), what)
    }

    pub(super) fn circle_fit(&self) -> Result<Applied, ClassicalError> {
        let found = circle_ratios(&self.model, self.responses()?, self.extracted);
        self.of_ratios(
            found.iter().map(|r| (r.omega, r.ratio)),
            "five lines around a peak, three within its half-power band",
        )
    }

    /// Loss of the drive's loop over the energy of the nearest mode: `zeta = area / (2 pi w_r^2 |q|^2)`.
    pub(super) fn loops(&self) -> Result<Applied, ClassicalError> {
        let of_runs = self.modal_losses();
        let of_runs = of_runs.iter().map(|l| (l.omega, l.ratio()));
        let found: Vec<(f64, f64)> = self.losses_of_modes().into_iter().chain(of_runs).collect();
        self.of_ratios(found, "runs near a resonance with a sensor at the drive")
    }

    /// Resonance and ratio of every mode that was extracted, by the loops under a unit force over the lines within its half-power
    /// band, the other modes taken off, at the drive that moves most.
    fn losses_of_modes(&self) -> Vec<(f64, f64)> {
        let Some(responses) = &self.responses else { return Vec::new() };
        let of_mode = |r: usize| {
            let pole = self.extracted[r].pole;
            let mode = self.model.nearest(pole.norm())?;
            let phi = |j: usize| self.model.shapes[(responses.drives[j], mode)].abs();
            let drives = (0..responses.drives.len()).filter(|&j| self.shows(responses, responses.drives[j], mode));
            let drive = drives.max_by(|&a, &b| phi(a).total_cmp(&phi(b)))?;
            let sensor = responses.sensors.iter().position(|dof| *dof == responses.drives[drive])?;
            let within = |k: &usize| (responses.omega[*k] - pole.im).abs() < pole.re.abs();
            let (mut area, mut energy) = (0.0, 0.0);
            for k in about(&responses.omega, pole).filter(within) {
                let x = alone(responses, self.extracted, r, k, (sensor, drive));
                let (omega, q) = (responses.omega[k], x.norm() / phi(drive));
                area += super::hysteresis_loop::from_harmonics(omega, &[x], &[c64::new(1.0, 0.0)], 1.0).area;
                energy += TAU * omega * pole.norm() * q * q;
            }
            (energy > 0.0).then(|| (pole.norm(), area / energy))
        };
        (0..self.extracted.len()).filter_map(of_mode).collect()
    }

    /// Whether a drive with a sensor moves with a mode enough.
    fn shows(&self, responses: &FrequencyResponses, drive: usize, mode: usize) -> bool {
        let amplitude = |dof: usize| self.model.shapes[(dof, mode)].abs();
        let largest = self.structure.translations().into_iter().map(amplitude).fold(0.0, f64::max);
        responses.sensors.contains(&drive) && amplitude(drive) > SEEN * largest
    }

    /// Viscous part of the single-degree balance over all runs of a mode.
    pub(super) fn energy_single(&self) -> Result<Applied, ClassicalError> {
        let losses = self.modal_losses();
        let mut found = Vec::new();
        let mut why = "two runs of different level near one resonance".to_string();
        for mode in 0..self.model.len() {
            let of_mode: Vec<&ModalLoss> = losses.iter().filter(|l| l.mode == mode).collect();
            if !have_levels(&of_mode) {
                continue;
            }
            let states: Vec<_> = of_mode.into_iter().map(ModalLoss::state).collect();
            match super::energy_single::viscous_and_friction(&states) {
                Ok(fit) if fit.c < 0.0 || fit.friction < 0.0 => {
                    why =
                        "runs that agree with viscous damping and friction: one of them came out negative".to_string();
                }
                Ok(fit) => found.push((self.model.omega[mode], fit.c / (2.0 * self.model.omega[mode]))),
                Err(error) => why = error.to_string(),
            }
        }
        self.of_ratios(found, &why)
    }

    /// Runs within reach of a mode, by the drive's motion.
    fn modal_losses(&self) -> Vec<ModalLoss> {
        let Some(responses) = &self.responses else { return Vec::new() };
        let runs = self.runs.iter().filter(|run| run.enabled);
        let mut losses: Vec<ModalLoss> = runs
            .filter_map(|run| {
                let [force] = run.fit.force_channels()[..] else { return None };
                let drive = run.fit.channels[force].channel.dof;
                let (f, x) = (run.fit.force(drive)?.amplitudes, run.fit.displacement(drive)?.amplitudes);
                let mode = self.model.nearest(run.fit.omega)?;
                let near = (run.fit.omega - self.model.omega[mode]).abs() < resonant::NEAR * self.model.omega[mode];
                let phi = self.model.shapes[(drive, mode)];
                let area = super::hysteresis_loop::from_harmonics(run.fit.omega, &x, &f, 1.0).area;
                let q = x[0].norm() / phi.abs();
                (near && self.shows(responses, drive, mode)).then_some(ModalLoss {
                    mode,
                    omega: run.fit.omega,
                    area,
                    force: f[0].norm(),
                    q,
                    natural: self.model.omega[mode],
                })
            })
            .collect();
        losses.sort_by(|a, b| (a.omega - a.natural).abs().total_cmp(&(b.omega - b.natural).abs()));
        losses
    }
}

/// What one run loses near one mode.
struct ModalLoss {
    mode: usize,
    omega: f64,
    natural: f64,
    /// J a period.
    area: f64,
    /// Amplitude at the drive, N.
    force: f64,
    /// Modal amplitude, kg^(1/2) m.
    q: f64,
}

/// Whether there are runs at levels far enough apart to tell friction from viscous damping.
fn have_levels(losses: &[&ModalLoss]) -> bool {
    let (least, most) =
        losses.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), l| (least.min(l.force), most.max(l.force)));
    losses.len() >= 2 && most >= LEVELS * least
}

impl ModalLoss {
    fn ratio(&self) -> f64 {
        self.area / (TAU * self.omega * self.natural * self.q * self.q)
    }

    /// As one degree of freedom of unit mass.
    fn state(&self) -> super::energy_single::SteadyState {
        let force = c64::new(0.0, self.area / (PI * self.q));
        super::energy_single::SteadyState {
            omega: self.omega,
            displacement: vec![c64::new(self.q, 0.0)],
            force: vec![force],
        }
    }
}
