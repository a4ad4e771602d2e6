//! Which part of a complex number the name of a column says it is: `H11 Real`, `Re(H11)`, `|H11|`, `Phase H11 [deg]`.

use crate::units::is_unit;

/// What a column holds of a complex number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Real,
    Imaginary,
    Magnitude,
    Phase,
}

/// How the numbers of a column are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scale {
    Decibel,
    Degrees,
    Radians,
}

/// A name taken apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Said {
    pub part: Option<Part>,
    /// In the words of the name alone.
    pub scale: Option<Scale>,
    /// Whether it is a coherence.
    pub coherence: bool,
    /// The name without the words above, for people.
    pub rest: String,
    /// The same for comparing: letters and digits in lower case.
    pub stem: String,
    /// The stem without words for frequency responses.
    pub core: String,
    /// A unit in brackets within the name.
    pub unit: Option<String>,
}

const REAL: &[&str] = &["re", "real", "realteil", "reale", "reel", "réel", "réelle", "realpart", "inphase"];
const IMAGINARY: &[&str] = &[
    "im",
    "imag",
    "img",
    "imaginary",
    "imaginär",
    "imaginärteil",
    "imaginaerteil",
    "imagteil",
    "immaginaria",
    "immaginario",
    "imaginaire",
    "imagpart",
    "quadrature",
];
const MAGNITUDE: &[&str] = &[
    "mag",
    "magn",
    "magnitude",
    "amp",
    "ampl",
    "amplitude",
    "abs",
    "absolute",
    "modulus",
    "modul",
    "modulo",
    "module",
    "betrag",
    "ampiezza",
    "gain",
];
const PHASE: &[&str] =
    &["phase", "phas", "ph", "angle", "ang", "arg", "winkel", "fase", "phasenwinkel", "phasengang", "phi", "φ"];
const COHERENCE: &[&str] = &["coh", "coherence", "coherenza", "cohérence", "kohärenz", "kohaerenz", "gamma2", "coher"];
const DECIBEL: &[&str] = &["db", "decibel"];
const DEGREES: &[&str] = &["deg", "degree", "degrees", "grad", "gradi", "°"];
const RADIANS: &[&str] = &["rad", "radian", "radians", "radianti"];
/// Words that say nothing beside those above.
const FILL: &[&str] =
    &["part", "teil", "parte", "partie", "value", "values", "of", "lin", "linear", "component", "level", "pegel"];
/// Words for frequency responses.
const RESPONSE: &[&str] = &[
    "frf",
    "h",
    "tf",
    "transfer",
    "function",
    "frequency",
    "response",
    "accelerance",
    "inertance",
    "mobility",
    "receptance",
    "compliance",
    "übertragungsfunktion",
    "dynamic",
];

/// Takes a name apart.
pub(super) fn said(name: &str) -> Said {
    let mut said = Said::default();
    let (name, unit) = without_unit(name);
    said.unit = unit;
    let bars = name.trim().strip_prefix('|').and_then(|rest| rest.split_once('|'));
    let name = match bars {
        Some((inner, behind)) if !inner.trim().is_empty() => {
            said.part = Some(Part::Magnitude);
            format!("{inner} {behind}")
        }
        _ => name,
    };
    let (mut rest, mut core) = (String::new(), String::new());
    let mut found = said.part.is_some();
    said.coherence = numbered_coherence(&name);
    for token in tokens(&name).into_iter().skip(usize::from(said.coherence)) {
        let word = token.to_lowercase();
        let is = |list: &[&str]| list.contains(&word.as_str());
        let part =
            [(REAL, Part::Real), (IMAGINARY, Part::Imaginary), (MAGNITUDE, Part::Magnitude), (PHASE, Part::Phase)];
        let part = part.into_iter().find(|(list, _)| is(list)).map(|(_, part)| part);
        let scale = [(DECIBEL, Scale::Decibel), (DEGREES, Scale::Degrees), (RADIANS, Scale::Radians)];
        let scale = scale.into_iter().find(|(list, _)| is(list)).map(|(_, scale)| scale);
        match (part, scale) {
            (Some(part), _) if !found || said.part == Some(part) => {
                found = true;
                said.part = Some(part);
            }
            (None, Some(scale)) if said.scale.is_none() => said.scale = Some(scale),
            _ if is(COHERENCE) || word == "γ²" => said.coherence = true,
            _ if is(FILL) => {}
            _ => {
                rest.push_str(token);
                if token.chars().any(char::is_alphanumeric) {
                    said.stem.push_str(&word);
                    if !is(RESPONSE) {
                        core.push_str(&word);
                    }
                }
            }
        }
    }
    said.core = core;
    said.rest = tidy(&rest);
    said
}

/// `C1,2(f)`: the coherence beside `H1,2(f)` of dynamic signal analysers.
fn numbered_coherence(name: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let Some((from, to)) = name.trim().strip_prefix('C').and_then(|rest| rest.split_once(',')) else { return false };
    let to = to.split_once('(').map_or(to, |(number, _)| number);
    digits(from) && digits(to.trim())
}

/// Takes a unit in brackets out of a name.
fn without_unit(name: &str) -> (String, Option<String>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        let mut from = 0;
        while let Some(at) = name[from..].find(open).map(|at| from + at) {
            let Some(end) = closing(&name[at..], open, close) else { break };
            let inner = name[at + 1..at + end].trim();
            if is_unit(inner) && !inner.eq_ignore_ascii_case("h") {
                let rest = format!("{} {}", &name[..at], &name[at + end + 1..]);
                return (rest, Some(inner.to_owned()));
            }
            from = at + 1;
        }
    }
    (name.to_owned(), None)
}

/// Place of the bracket that closes the one at the start.
fn closing(text: &str, open: char, close: char) -> Option<usize> {
    let mut depth = 0;
    for (i, c) in text.char_indices() {
        depth += i32::from(c == open) - i32::from(c == close);
        if depth == 0 {
            return Some(i);
        }
    }
    None
}

/// Words, numbers and what is between them, in their order; `FrfReal` is two words, `H11re` three.
fn tokens(name: &str) -> Vec<&str> {
    let kind = |c: char| match c {
        _ if c.is_ascii_digit() => 1,
        'γ' | '²' | '°' => 2,
        _ if c.is_alphabetic() => 2,
        _ => 0,
    };
    let mut cuts = vec![0];
    let letters: Vec<(usize, char)> = name.char_indices().collect();
    for pair in letters.windows(2) {
        let ((_, a), (at, b)) = (pair[0], pair[1]);
        // `dB` is one word.
        if kind(a) != kind(b) || a.is_lowercase() && b.is_uppercase() && (a, b) != ('d', 'B') {
            cuts.push(at);
        }
    }
    cuts.push(name.len());
    let words: Vec<&str> = cuts.windows(2).map(|cut| &name[cut[0]..cut[1]]).filter(|word| !word.is_empty()).collect();
    joined(name, words)
}

/// `gamma2` is one word.
fn joined<'a>(name: &'a str, words: Vec<&'a str>) -> Vec<&'a str> {
    let mut out: Vec<&str> = Vec::new();
    for word in words {
        match out.last_mut() {
            Some(last) if last.eq_ignore_ascii_case("gamma") && word == "2" => {
                let start = last.as_ptr() as usize - name.as_ptr() as usize;
                *last = &name[start..start + 6];
            }
            _ => out.push(word),
        }
    }
    out
}

/// A name without empty brackets and signs at its ends.
fn tidy(text: &str) -> String {
    let mut text = text.replace("()", "").replace("[]", "").replace("( )", "").replace("[ ]", "");
    while text.contains("  ") {
        text = text.replace("  ", " ");
    }
    let ends = |c: char| c.is_whitespace() || matches!(c, '_' | '-' | '.' | ',' | ':' | ';' | '|' | '*' | '/' | '=');
    let mut text = text.trim_matches(ends).to_owned();
    // A bracket around all that is left: `Re(H11)`.
    let inner = |text: &str| text.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).map(str::to_owned);
    while let Some(inside) = inner(&text) {
        text = inside;
    }
    let text = text.trim_matches(ends).replace("_[", "[").replace("_(", "(");
    text.trim().to_owned()
}

/// Whether a name holds one of the words for a part and nothing else: a row of `Real`, `Imag` below the names.
pub(crate) fn is_bare_part(name: &str) -> bool {
    let said = said(name);
    said.part.is_some() && said.stem.is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str) -> (Option<Part>, String) {
        let said = said(name);
        (said.part, said.rest)
    }

    #[test]
    fn parts_in_the_words_of_laboratories() {
        for (name, part, rest) in [
            ("H11 Real", Part::Real, "H11"),
            ("Re(H11)", Part::Real, "H11"),
            ("H_2_1_im", Part::Imaginary, "H_2_1"),
            ("H_im[3]", Part::Imaginary, "H[3]"),
            ("FrfReal", Part::Real, "Frf"),
            ("|H11|", Part::Magnitude, "H11"),
            ("Phase H(7,1) [deg]", Part::Phase, "H(7,1)"),
            ("Imaginärteil", Part::Imaginary, ""),
            ("Real Part", Part::Real, ""),
            ("12:+Z/1:+Z Imag.", Part::Imaginary, "12:+Z/1:+Z"),
            ("Betrag Punkt 3", Part::Magnitude, "Punkt 3"),
            ("FRF 7/19 (m/s²/N) Mag", Part::Magnitude, "FRF 7/19"),
            ("H 2Z/8Z Level Phase", Part::Phase, "H 2Z/8Z"),
        ] {
            assert_eq!(of(name), (Some(part), rest.to_owned()), "{name}");
        }
        assert_eq!(said("Phase (rad)").scale.or(said("Phase rad").scale), Some(Scale::Radians));
        assert_eq!(said("FRF (m/s²/N) Mag").unit.as_deref(), Some("m/s²/N"));
        assert!(said("Coherence 7/19").coherence && said("gamma2").coherence && !said("Real").coherence);
        assert!(said("C1,2(f)").coherence && said("C1,2(f)").core == said("H1,2(f)").core);
        assert!(!said("Channel 1,2").coherence && !said("CH1").coherence);
        assert_eq!((said("Remark").part, said("Point 3").part), (None, None));
    }

    #[test]
    fn words_for_responses_do_not_tell_columns_apart() {
        assert_eq!(said("Accelerance 7/19 (dB)").core, said("Phase 7/19").core);
        // ISO 1683 calls a logarithm over a reference a level.
        assert_eq!(said("H 7/19 Level").core, said("H 7/19 Phase").core);
    }
}
