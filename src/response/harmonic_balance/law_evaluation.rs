//! The nonlinear laws inside Newton's method: what a law answers to the harmonics of its force and relative motion.
//!
//! Unknowns are the harmonics `F` of the leg forces; the motion `D` follows from them. Each law gives `Phi(F, D)`, and
//! the balance asks for `F = Phi`:
//!
//! ```text
//! laws of d or d'         Phi = P f(d, d')
//! friction (set-valued)   Phi = P [ g(v) + clamp(F - g(v) + r v, low, high) ]       any r > 0
//! steep at rest           Phi = P f(v),  v the root of  f(v) + r v = F + r v
//! laws with memory        Phi = P [ steady state of the marched law ]
//! ```
//!
//! `P` projects samples on harmonics. The clamp is the exact statement of `low <= F - g <= high` at
//! rest and `F - g` at one of the bounds when slipping (Alart and Curnier 1991; Nacivet, Pierre, Thouverez and Jezequel 2003), whatever
//! `r`: there is no regularised velocity, and full stick, `v = 0`, is a regular solution. `g` is the smooth part of the
//! Stribeck law. Damping of a power below one is treated alike by its resolvent.

use super::fourier::{Fourier, differentiate, to_complex};
use super::friction;
use super::nonlinear_leg::{LawEvaluation, NonlinearLeg, add_velocity_columns};
use crate::effects::law::Variable;
use crate::effects::{Manner, Motion, Steep};

/// What a law gives at one instant: value and slopes by the leg's own force, displacement and velocity.
#[derive(Clone, Copy, Default)]
pub(crate) struct Instant {
    pub value: f64,
    pub by_force: f64,
    pub by_displacement: f64,
    pub by_velocity: f64,
}

impl NonlinearLeg {
    /// The law at one instant. `f` is the leg's force (looked at by steep laws only).
    fn instant(&self, f: f64, d: f64, v: f64) -> Instant {
        if let Some(law) = self.steep() {
            return self.resolvent(law, f + self.weight * v);
        }
        let point = self.law.point(&self.parameters, d, v).unwrap_or_default();
        Instant {
            value: point.force,
            by_force: 0.0,
            by_displacement: point.by_displacement,
            by_velocity: point.by_velocity,
        }
    }

    /// The law as one of infinite slope at rest, if it is to be asked so.
    fn steep(&self) -> Option<&dyn Steep> {
        self.law.steep().filter(|_| self.manner() == Manner::Steep)
    }

    /// Force on the graph `F = f(v)` where `F + r v = s`.
    fn resolvent(&self, law: &dyn Steep, s: f64) -> Instant {
        let r = self.weight;
        let speed = law.speed(&self.parameters, r, s.abs());
        let by_force = 1.0 - r / (law.slope(&self.parameters, speed) + r);
        let value = (s.abs() - r * speed) * s.signum();
        Instant { value, by_force, by_displacement: 0.0, by_velocity: r * by_force }
    }

    /// Derivative of the resolvent by parameter `k`, force and motion held.
    fn resolvent_by_parameter(&self, law: &dyn Steep, k: usize, s: f64) -> f64 {
        let (p, r) = (&self.parameters, self.weight);
        let speed = law.speed(p, r, s.abs());
        if speed == 0.0 {
            return 0.0;
        }
        r * law.by(p, k, speed) / (law.slope(p, speed) + r) * s.signum()
    }

    /// `Phi` at the given coefficients of force and motion.
    pub(crate) fn value(&self, fourier: &Fourier, omega: f64, force: &[f64], motion: &[f64]) -> Vec<f64> {
        if self.manner() == Manner::SetValued {
            return friction::value(self, fourier, omega, force, motion);
        }
        let mut samples = vec![0.0; fourier.samples()];
        if self.manner() == Manner::Memory {
            self.law.force(&self.parameters, &sampled(fourier, omega, motion), &mut samples);
        } else {
            let [f, d, v] = self.histories(fourier, omega, force, motion);
            for (n, s) in samples.iter_mut().enumerate() {
                *s = self.instant(f[n], d[n], v[n]).value;
            }
        }
        let mut coefficients = vec![0.0; fourier.width()];
        fourier.project(&samples, &mut coefficients);
        coefficients
    }

    /// `Phi` with its derivatives.
    pub(crate) fn evaluate(&self, fourier: &Fourier, omega: f64, force: &[f64], motion: &[f64]) -> LawEvaluation {
        match self.manner() {
            Manner::Memory => return self.evaluate_memory(fourier, omega, motion),
            Manner::SetValued => return friction::evaluate(self, fourier, omega, force, motion),
            Manner::Linear | Manner::Pointwise | Manner::Steep => {}
        }
        let [f, d, v] = self.histories(fourier, omega, force, motion);
        let instants: Vec<Instant> = (0..f.len()).map(|n| self.instant(f[n], d[n], v[n])).collect();
        let part = |pick: fn(&Instant) -> f64| -> Vec<f64> { instants.iter().map(pick).collect() };
        let mut value = vec![0.0; fourier.width()];
        fourier.project(&part(|i| i.value), &mut value);
        let set_valued = self.manner() == Manner::Steep;
        let by_force = set_valued.then(|| fourier.multiplier(&part(|i| i.by_force)));
        let mut by_motion = if set_valued {
            vec![0.0; fourier.width() * fourier.width()]
        } else {
            fourier.multiplier(&part(|i| i.by_displacement))
        };
        let slopes = part(|i| i.by_velocity);
        if slopes.iter().any(|&s| s != 0.0) {
            add_velocity_columns(&mut by_motion, &fourier.multiplier(&slopes), omega, fourier);
        }
        LawEvaluation { value, by_force, by_motion }
    }

    fn evaluate_memory(&self, fourier: &Fourier, omega: f64, motion: &[f64]) -> LawEvaluation {
        let width = fourier.width();
        let sampled_motion = sampled(fourier, omega, motion);
        let (mut samples, mut column) = (vec![0.0; fourier.samples()], vec![0.0; width]);
        let mut value = vec![0.0; width];
        let tangent = self.law.force_and_tangent(&self.parameters, &sampled_motion, &mut samples);
        fourier.project(&samples, &mut value);
        let mut by_motion = vec![0.0; width * width];
        // Laws with memory look at displacements only.
        let mut direction = Motion { velocity: Vec::new(), acceleration: Vec::new(), ..sampled_motion.clone() };
        for k in fourier.rows() {
            fourier.wave(k, &mut direction.displacement);
            tangent(&direction, &mut samples);
            fourier.project(&samples, &mut column);
            for (row, c) in column.iter().enumerate() {
                by_motion[row * width + k] = *c;
            }
        }
        LawEvaluation { value, by_force: None, by_motion }
    }

    /// Derivative of `Phi` by parameter `k`, force and motion held.
    pub(crate) fn by_parameter(
        &self,
        fourier: &Fourier,
        omega: f64,
        k: usize,
        force: &[f64],
        motion: &[f64],
    ) -> Vec<f64> {
        if self.manner() == Manner::SetValued {
            return friction::by_parameter(self, fourier, omega, k, force, motion);
        }
        let mut samples = vec![0.0; fourier.samples()];
        if let Some(law) = self.steep() {
            let [f, _, v] = self.histories(fourier, omega, force, motion);
            for (n, s) in samples.iter_mut().enumerate() {
                *s = self.resolvent_by_parameter(law, k, f[n] + self.weight * v[n]);
            }
        } else {
            self.law.parameter_tangent(&self.parameters, k, &sampled(fourier, omega, motion), &mut samples);
        }
        let mut coefficients = vec![0.0; fourier.width()];
        fourier.project(&samples, &mut coefficients);
        coefficients
    }

    /// Samples of force, displacement and velocity; those the law does not look at stay zero.
    pub(crate) fn histories(&self, fourier: &Fourier, omega: f64, force: &[f64], motion: &[f64]) -> [Vec<f64>; 3] {
        let blank = vec![0.0; fourier.samples()];
        let [mut f, mut d, mut v] = [blank.clone(), blank.clone(), blank];
        let velocity_law = self.law.variable() == Variable::Velocity;
        if self.takes_force() {
            fourier.synthesise(force, &mut f);
        } else if !velocity_law {
            fourier.synthesise(motion, &mut d);
        }
        if self.takes_force() || velocity_law {
            let mut velocity = vec![0.0; motion.len()];
            differentiate(omega, motion, &mut velocity);
            fourier.synthesise(&velocity, &mut v);
        }
        [f, d, v]
    }

    /// Local stiffness and damping along the period at a solution (for stability): the slopes of the law; where friction
    /// sticks, a damping that holds it.
    pub(crate) fn slopes(&self, fourier: &Fourier, omega: f64, force: &[f64], motion: &[f64]) -> Vec<[f64; 2]> {
        let [f, d, v] = self.histories(fourier, omega, force, motion);
        let answer = |n: usize| {
            let instant = self.instant(f[n], d[n], v[n]);
            match self.manner() {
                Manner::SetValued => friction::slope(self, f[n], v[n]),
                Manner::Steep if instant.by_force > 0.0 => [0.0, instant.by_velocity / (1.0 - instant.by_force)],
                _ => [instant.by_displacement, instant.by_velocity],
            }
        };
        (0..f.len()).map(answer).collect()
    }
}

/// The motion of real coefficients as laws take it.
pub(crate) fn sampled(fourier: &Fourier, omega: f64, coefficients: &[f64]) -> Motion {
    let (mean, harmonics) = to_complex(coefficients);
    let mut derivative = vec![0.0; coefficients.len()];
    let mut second = vec![0.0; coefficients.len()];
    differentiate(omega, coefficients, &mut derivative);
    differentiate(omega, &derivative, &mut second);
    let blank = vec![0.0; fourier.samples()];
    let mut motion =
        Motion { omega, mean, harmonics, displacement: blank.clone(), velocity: blank.clone(), acceleration: blank };
    fourier.synthesise(coefficients, &mut motion.displacement);
    fourier.synthesise(&derivative, &mut motion.velocity);
    fourier.synthesise(&second, &mut motion.acceleration);
    motion
}
