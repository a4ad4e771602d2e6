//! Prior deviations of the updating parameters, a scale a class, which are estimated from the data.

/// Prior deviations by class of parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Stiffness and mass, relative.
    pub model: f64,
    /// Sizes of known sources and supports, relative.
    pub known: f64,
    /// Gains, relative.
    pub gain: f64,
    /// Phase of a channel at the geometric mean frequency of the runs, rad.
    pub phase: f64,
    /// Stiffness from run to run (re-seating, temperature), relative.
    pub shift: f64,
    /// Response from run to run, in proportion to it (level of the force, discrepancy).
    pub response: f64,
    /// Stiffness from session to session, relative.
    pub session: f64,
    /// Damping of single modes, relative.
    pub damping: f64,
    /// The same an octave above the natural frequency: between structural and viscous damping it is 0.69.
    pub damping_per_octave: f64,
}

impl Scales {
    /// Those of the search, before they are estimated beside each candidate: wide enough for what laboratories report,
    /// narrow enough that they leave to an effect what is an effect's.
    pub const SEARCH: Self = Self {
        model: 0.02,
        known: 0.2,
        gain: 0.01,
        phase: 3e-3,
        shift: 5e-4,
        response: 3e-3,
        session: 5e-4,
        damping: 0.05,
        damping_per_octave: 0.1,
    };
    /// Where their estimation starts, and what is kept where the data cannot tell: what laboratories report.
    pub const START: Self = Self {
        model: 0.01,
        known: 0.2,
        gain: 3e-3,
        phase: 1e-3,
        shift: 2e-4,
        response: 1e-3,
        session: 2e-4,
        damping: 0.05,
        damping_per_octave: 0.1,
    };
    /// Least: below any measurement.
    pub const LEAST: Self = Self {
        model: 1e-6,
        known: 1e-5,
        gain: 1e-6,
        phase: 1e-6,
        shift: 1e-8,
        response: 1e-7,
        session: 1e-8,
        damping: 1e-5,
        damping_per_octave: 1e-4,
    };
    /// Greatest: beyond, it is not this structure, or the record is not of this run.
    pub const GREATEST: Self = Self {
        model: 0.06,
        known: 0.5,
        gain: 0.015,
        phase: 0.02,
        shift: 0.01,
        response: 0.1,
        session: 0.02,
        damping: 0.5,
        damping_per_octave: 0.5,
    };

    /// The same scales in a list, in the order of the fields.
    pub fn list(&self) -> [f64; 9] {
        [
            self.model,
            self.known,
            self.gain,
            self.phase,
            self.shift,
            self.response,
            self.session,
            self.damping,
            self.damping_per_octave,
        ]
    }

    /// Minus twice the logarithm of their prior density, half-Cauchy about where they start.
    pub fn prior_cost(&self) -> f64 {
        let pairs = self.list().into_iter().zip(Self::START.list());
        pairs.map(|(s, start)| 2.0 * (1.0 + (s / start).powi(2)).ln()).sum()
    }

    /// The same scales, none below that of `least`.
    #[must_use]
    pub fn at_least(&self, least: &Self) -> Self {
        let (own, least) = (self.list(), least.list());
        Self::from_list(std::array::from_fn(|k| own[k].max(least[k])))
    }

    /// Scales from such a list, each kept between the least and the greatest.
    pub fn from_list(list: [f64; 9]) -> Self {
        let (least, greatest) = (Self::LEAST.list(), Self::GREATEST.list());
        let [model, known, gain, phase, shift, response, session, damping, damping_per_octave] =
            std::array::from_fn(|k| list[k].clamp(least[k], greatest[k]));
        Self { model, known, gain, phase, shift, response, session, damping, damping_per_octave }
    }
}
