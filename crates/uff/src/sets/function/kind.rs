//! Kinds of functions, field 1 of record 6 of data set 58.

/// What a function is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FunctionKind {
    /// 0: general or unknown.
    General,
    /// 1: time response.
    TimeResponse,
    /// 2: auto spectrum.
    AutoSpectrum,
    /// 3: cross spectrum.
    CrossSpectrum,
    /// 4: frequency response function.
    FrequencyResponse,
    /// 5: transmissibility.
    Transmissibility,
    /// 6: coherence.
    Coherence,
    /// 7: auto correlation.
    AutoCorrelation,
    /// 8: cross correlation.
    CrossCorrelation,
    /// 9: power spectral density.
    PowerSpectralDensity,
    /// 10: energy spectral density.
    EnergySpectralDensity,
    /// 12: spectrum.
    Spectrum,
    /// 26: multiple coherence.
    MultipleCoherence,
    /// Any other number.
    Other(i64),
}

const NAMED: [(i64, FunctionKind, &str); 13] = [
    (0, FunctionKind::General, "general"),
    (1, FunctionKind::TimeResponse, "time response"),
    (2, FunctionKind::AutoSpectrum, "auto spectrum"),
    (3, FunctionKind::CrossSpectrum, "cross spectrum"),
    (4, FunctionKind::FrequencyResponse, "frequency response"),
    (5, FunctionKind::Transmissibility, "transmissibility"),
    (6, FunctionKind::Coherence, "coherence"),
    (7, FunctionKind::AutoCorrelation, "auto correlation"),
    (8, FunctionKind::CrossCorrelation, "cross correlation"),
    (9, FunctionKind::PowerSpectralDensity, "power spectral density"),
    (10, FunctionKind::EnergySpectralDensity, "energy spectral density"),
    (12, FunctionKind::Spectrum, "spectrum"),
    (26, FunctionKind::MultipleCoherence, "multiple coherence"),
];

/// Names of the numbers that have no case of their own.
const OTHERS: [(i64, &str); 15] = [
    (11, "probability density"),
    (13, "cumulative frequency distribution"),
    (14, "peaks valley"),
    (15, "stress/cycles"),
    (16, "strain/cycles"),
    (17, "orbit"),
    (18, "mode indicator function"),
    (19, "force pattern"),
    (20, "partial power"),
    (21, "partial coherence"),
    (22, "eigenvalue"),
    (23, "eigenvector"),
    (24, "shock response spectrum"),
    (25, "impulse response filter"),
    (27, "order function"),
];

impl FunctionKind {
    /// The kind of a number.
    pub fn from_number(number: i64) -> Self {
        NAMED.iter().find(|(n, ..)| *n == number).map_or(Self::Other(number), |(_, kind, _)| *kind)
    }

    /// The number of a kind.
    pub fn number(self) -> i64 {
        match self {
            Self::Other(number) => number,
            kind => NAMED.iter().find(|(_, k, _)| *k == kind).map_or(0, |(n, ..)| *n),
        }
    }

    /// Its name in words.
    pub fn name(self) -> &'static str {
        let number = self.number();
        let named = NAMED.iter().find(|(n, ..)| *n == number).map(|(.., name)| *name);
        named.or_else(|| OTHERS.iter().find(|(n, _)| *n == number).map(|(_, name)| *name)).unwrap_or("unknown function")
    }
}
