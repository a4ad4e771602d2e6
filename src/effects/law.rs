//! The three kinds of law: a force on a relative motion, a force over the whole structure, an error of a channel.

use super::{Memory, Motion};
use faer::c64;

/// One parameter of a law: its name in project files, its unit, its symbol in formulas and its physical range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name in files and on the command line, such as `loss_stiffness`.
    pub name: &'static str,
    /// SI unit in words of ASCII, such as `N s/m`; empty for a pure number.
    pub unit: &'static str,
    /// Symbol in formulas, such as `F_c`.
    pub symbol: &'static str,
    /// Least physical value (exclusive where the law is singular there).
    pub least: f64,
    /// Greatest physical value.
    pub greatest: f64,
    /// Whether the force is proportional to this parameter, all others fixed: the coefficient `c_j` of the energy equation.
    pub linear: bool,
    /// A sensible value for a candidate whose value is unknown; 1 for the linear one.
    pub typical: f64,
    /// Whether the limits themselves are allowed.
    pub ends: Ends,
}

/// Which limits of a range belong to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// Both.
    Closed,
    /// Only the greatest.
    OpenBelow,
    /// Neither.
    Open,
}

impl Parameter {
    /// A parameter to which the force is proportional, from 0 upwards.
    pub const fn coefficient(name: &'static str, unit: &'static str, symbol: &'static str) -> Self {
        let (least, greatest) = (0.0, f64::INFINITY);
        Self { name, unit, symbol, least, greatest, linear: true, typical: 1.0, ends: Ends::Closed }
    }

    /// A parameter that shapes the force, from 0 upwards.
    pub const fn shape(name: &'static str, unit: &'static str, symbol: &'static str, typical: f64) -> Self {
        Self { linear: false, typical, ..Self::coefficient(name, unit, symbol) }
    }

    /// The same parameter within other limits.
    #[must_use]
    pub const fn within(self, least: f64, greatest: f64, ends: Ends) -> Self {
        Self { least, greatest, ends, ..self }
    }

    /// The same parameter without limits.
    #[must_use]
    pub const fn of_any_sign(self) -> Self {
        self.within(f64::NEG_INFINITY, f64::INFINITY, Ends::Closed)
    }

    /// The same parameter without its lower limit itself.
    #[must_use]
    pub const fn above(self, least: f64) -> Self {
        let greatest = self.greatest;
        self.within(least, greatest, Ends::OpenBelow)
    }

    /// Whether `value` is finite and within the limits.
    pub fn allows(&self, value: f64) -> bool {
        let above = if self.ends == Ends::Closed { value >= self.least } else { value > self.least };
        let below = if self.ends == Ends::Open { value < self.greatest } else { value <= self.greatest };
        value.is_finite() && above && below
    }

    /// The limits in words, such as `above 0 and at most 5`.
    pub fn range(&self) -> String {
        let above = if self.ends == Ends::Closed { "at least" } else { "above" };
        let below = if self.ends == Ends::Open { "below" } else { "at most" };
        match (self.least.is_finite(), self.greatest.is_finite()) {
            (true, true) => format!("{above} {} and {below} {}", self.least, self.greatest),
            (true, false) => format!("{above} {}", self.least),
            (false, true) => format!("{below} {}", self.greatest),
            (false, false) => "a finite number".to_string(),
        }
    }
}

/// Value and slopes of a force that depends on the present displacement and velocity only.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    /// Force, N.
    pub force: f64,
    /// Derivative by the displacement, N/m.
    pub by_displacement: f64,
    /// Derivative by the velocity, N s/m.
    pub by_velocity: f64,
}

/// A force that depends on one relative displacement `d(t)` of the structure: `-F` acts on the first DOF, `+F` on the second.
///
/// All methods take the parameters `p` in the order of [`Law::parameters`].
pub trait Law: Sync {
    /// Parameters in the order of `p`. The first linear one is the coefficient that identification solves for.
    fn parameters(&self) -> &'static [Parameter];

    /// Dynamic stiffness `F_h / D_h` in N/m at the circular frequency `omega` (rad/s), for laws that are linear in `d`;
    /// `None` for all others.
    fn dynamic_stiffness(&self, p: &[f64], omega: f64) -> Option<c64> {
        let _ = (p, omega);
        None
    }

    /// Force in N at every sample of one period of the motion, in steady state (memory laws march until periodic).
    /// `force.len() == motion.len()`.
    fn force(&self, p: &[f64], motion: &Motion, force: &mut [f64]);

    /// Directional (Gateaux) derivative of [`Law::force`] at `motion` along the periodic `direction`, N at every sample.
    fn tangent(&self, p: &[f64], motion: &Motion, direction: &Motion, tangent: &mut [f64]);

    /// Derivative of [`Law::force`] by parameter number `k`, N per unit of that parameter at every sample.
    fn parameter_tangent(&self, p: &[f64], k: usize, motion: &Motion, tangent: &mut [f64]);

    /// Energy in J taken out per cycle of `d = amplitude cos(omega t)`, where a closed form exists.
    fn energy_per_cycle(&self, p: &[f64], amplitude: f64, omega: f64) -> Option<f64>;

    /// Whether the force jumps where the velocity changes sign, so that solvers need the `smooth_` methods.
    fn jumps(&self) -> bool {
        false
    }

    /// The force at one instant, for laws without memory and inertia; `None` for all others. `width` as in
    /// [`Law::smooth_force`], 0 for the law itself.
    fn point(&self, p: &[f64], width: f64, displacement: f64, velocity: f64) -> Option<Point> {
        let _ = (p, width, displacement, velocity);
        None
    }

    /// The law with memory at rest at the origin, to be stepped through time. `None` for laws without memory (see
    /// [`Law::point`]), for mass, and for hysteretic and fractional damping, which exist in steady state only.
    fn memory(&self, p: &[f64]) -> Option<Box<dyn Memory>> {
        let _ = p;
        None
    }

    /// [`Law::force`] with every jump in velocity `v` smoothed over `width` (m/s): `sgn v` becomes
    /// `v / sqrt(v^2 + width^2)`. Laws that are smooth already do not look at `width`.
    fn smooth_force(&self, p: &[f64], width: f64, motion: &Motion, force: &mut [f64]) {
        let _ = width;
        self.force(p, motion, force);
    }

    /// Directional derivative of [`Law::smooth_force`].
    fn smooth_tangent(&self, p: &[f64], width: f64, motion: &Motion, direction: &Motion, tangent: &mut [f64]) {
        let _ = width;
        self.tangent(p, motion, direction, tangent);
    }

    /// Derivative of [`Law::smooth_force`] by parameter number `k`.
    fn smooth_parameter_tangent(&self, p: &[f64], k: usize, width: f64, motion: &Motion, tangent: &mut [f64]) {
        let _ = width;
        self.parameter_tangent(p, k, motion, tangent);
    }

    /// Whether the law can take out energy at all (a spring or mass cannot, so the energy balance does not see it).
    fn dissipates(&self) -> bool {
        true
    }

    /// Energy in J taken out over one period of `motion`: `integral d' F dt` by the trapezoidal rule, which is spectrally
    /// accurate for smooth periodic integrands. Laws with jumps override it with an exact formula.
    fn energy(&self, p: &[f64], motion: &Motion) -> f64 {
        let mut force = vec![0.0; motion.len()];
        self.force(p, motion, &mut force);
        motion.work(&force)
    }
}

/// Which matrix of the structure a whole-structure law multiplies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// Mass matrix, lumped masses included.
    Mass,
    /// Stiffness matrix, the chain's ground springs included.
    Stiffness,
}

/// A force over the whole structure, `F_h = factor(p, h omega) B X_h` with `B` the mass or stiffness matrix.
pub trait WholeLaw: Sync {
    /// The only parameter; the force is proportional to it.
    fn parameter(&self) -> &'static Parameter;
    /// Matrix that is multiplied.
    fn basis(&self) -> Basis;
    /// Complex factor of that matrix at circular frequency `omega` (rad/s).
    fn factor(&self, value: f64, omega: f64) -> c64;
}

/// An error of a measuring channel: recorded amplitude = `transfer` x true amplitude.
pub trait ChannelLaw: Sync {
    /// The only parameter.
    fn parameter(&self) -> &'static Parameter;
    /// Ratio of recorded to true complex amplitude at circular frequency `omega` (rad/s).
    fn transfer(&self, value: f64, omega: f64) -> c64;
    /// Derivative of [`ChannelLaw::transfer`] by the parameter.
    fn transfer_derivative(&self, value: f64, omega: f64) -> c64;
    /// Value at which the channel is without error.
    fn neutral(&self) -> f64;
}
