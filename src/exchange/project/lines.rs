//! Where every part of a project file stood, for messages about what is found wrong later.

use std::collections::BTreeMap;

/// Line, from 1, of every part of a project file, for messages about what is found wrong later.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Lines {
    /// Keys of `[structure]`; the empty key is its head.
    pub structure: BTreeMap<String, usize>,
    /// Tables `[[structure.lumped_mass]]`.
    pub lumped_mass: Vec<usize>,
    /// Tables `[[structure.correction]]`.
    pub correction: Vec<usize>,
    /// Keys of each `[[source]]`; the empty key is its head.
    pub source: Vec<BTreeMap<String, usize>>,
    /// Keys of each `[[candidates]]`.
    pub candidates: Vec<BTreeMap<String, usize>>,
    /// Tables `[[sensor]]`.
    pub sensor: Vec<usize>,
    /// Keys of each `[[ruled_out]]`.
    pub ruled_out: Vec<BTreeMap<String, usize>>,
    /// Tables `[[channel]]`.
    pub channel: Vec<usize>,
    /// Keys of each `[[run]]`.
    pub run: Vec<BTreeMap<String, usize>>,
    /// Tables `[[harmonics]]`.
    pub harmonics: Vec<usize>,
    /// Tables `[[frf]]`.
    pub frf: Vec<usize>,
    /// Tables `[[modes]]`.
    pub modes: Vec<usize>,
    /// Table `[simulate]`.
    pub simulate: usize,
}
