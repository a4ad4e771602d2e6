//! Universal Files to measured frequency responses: functions of type 4, coherences of type 6 beside them.

use super::checks::{drop_zero, is_coherence, same_frequencies};
use super::error::FrfProblem;
use super::names::{keys, place, place_of_name};
use super::source::FrfSource;
use super::units::{Form, is_bare, names_no_unit, of_form, ratio};
use crate::control::Control;
use crate::measurement::frf::{FrequencyResponse, ResponseSet};
use crate::measurement::{Channel, Quantity};
use crate::structure::Structure;
use faer::c64;
use std::collections::BTreeMap;
use uff::{File, Function, FunctionHeader, FunctionKind, Set, Summary};

/// Type of an abscissa of frequencies.
const FREQUENCY: i64 = 18;

/// Reads the functions of one file for a structure.
pub(super) struct Reader<'a> {
    pub file: &'a mut File<std::fs::File>,
    pub source: &'a FrfSource,
    pub structure: &'a Structure,
}

/// A response in the file.
struct Found {
    set: usize,
    function: FrequencyResponse,
    pair: [uff::Dof; 2],
    /// Whether SI units are assumed.
    assumed: bool,
    /// Which estimator it is, by its lines of text: a place in [`ESTIMATORS`].
    estimator: Option<usize>,
}

/// Estimators of a frequency response, the one to take first: H1 takes the noise to be in the response, as deviations by
/// the coherence do; Hv shares it out; H2 takes it to be in the force.
const ESTIMATORS: [&str; 3] = ["H1", "HV", "H2"];

impl Reader<'_> {
    /// All responses with their coherences, and the faults that were read over.
    pub(super) fn read(mut self, name: &str, control: &Control) -> Result<(ResponseSet, Vec<String>), FrfProblem> {
        let entries = self.file.sets().to_vec();
        let units = entries.iter().find_map(|entry| match &entry.summary {
            Summary::Units(units) => Some(units.clone()),
            _ => None,
        });
        let named =
            |summary: &Summary| matches!(summary, Summary::Function(f) if f.kind == FunctionKind::FrequencyResponse);
        let unnamed = !entries.iter().any(|entry| named(&entry.summary));
        let mut faults: Vec<String> = self.file.warnings().iter().map(|fault| format!("{name}: {fault}")).collect();
        let (mut found, mut frequencies, mut coherences) = (Vec::new(), Vec::new(), Vec::new());
        for (set, entry) in entries.iter().enumerate() {
            let Summary::Function(header) = &entry.summary else { continue };
            let wanted = match header.kind {
                FunctionKind::FrequencyResponse | FunctionKind::Coherence => true,
                // Some programs leave the type out.
                FunctionKind::General => unnamed && header.complex && header.abscissa.quantity == FREQUENCY,
                _ => false,
            };
            if !wanted {
                continue;
            }
            if control.check().is_err() {
                break;
            }
            let reading = self.file.read(set).map_err(FrfProblem::File)?;
            faults.extend(reading.warnings.iter().map(|fault| format!("{name}: {fault}")));
            let Set::Function(function) = reading.set else { continue };
            common_frequencies(&mut frequencies, &function, set)?;
            if header.kind == FunctionKind::Coherence {
                coherences.push((set, function));
            } else {
                found.push(self.response([set, found.len()], &function, units.as_ref())?);
            }
        }
        if found.is_empty() {
            return Err(FrfProblem::NoResponses);
        }
        let (mut found, taken) = one_estimator(found);
        faults.extend(taken.map(|taken| format!("{name}: {taken}")));
        no_pair_twice(&found)?;
        faults.extend(assumed(name, &found));
        for (set, coherence) in coherences {
            attach(&mut found, set, &coherence)?;
        }
        let functions = found.into_iter().map(|found| found.function).collect();
        let mut set = ResponseSet {
            name: name.to_string(),
            frequencies_hz: frequencies,
            functions,
            averages: self.source.averages,
        };
        drop_zero(&mut set);
        Ok((set, told_once(&faults)))
    }

    /// Set number `set`, the `k`-th that is a frequency response.
    fn response(
        &mut self,
        [set, k]: [usize; 2],
        function: &Function,
        units: Option<&uff::Units>,
    ) -> Result<Found, FrfProblem> {
        let header = &function.header;
        let wrong = |what: String| FrfProblem::set(set, what);
        let (form, scale, assumed) = self.form(header, units).map_err(wrong)?;
        let pair = header.stated_dofs();
        let sides = match self.source.listed(k).map_err(wrong)? {
            Some(listed) => {
                [0, 1].map(|side| place_of_name(&listed[side], self.named(side, &[&listed[side]]), self.structure))
            }
            None => [0, 1].map(|side: usize| place(&pair[side], self.named(side, &keys(&pair[side])), self.structure)),
        };
        let [first, second] = sides;
        let (mut response, mut reference) = (first.map_err(wrong)?, second.map_err(wrong)?);
        if self.source.reciprocity {
            std::mem::swap(&mut response, &mut reference);
        }
        let ((response, sign), (reference, other)) = (response, reference);
        if form.is_inverse() && response != reference {
            return Err(wrong(
                "force over motion between different DOFs is not the inverse of a response; export motion over force"
                    .to_string(),
            ));
        }
        let factor = scale * sign * other;
        let value = |i: usize| {
            let [re, im] = function.values.get(i).unwrap_or([f64::NAN; 2]);
            let value = c64::new(re, im) * factor;
            if form.is_inverse() { c64::new(1.0, 0.0) / value } else { value }
        };
        let channel = |quantity, dof: usize| Channel { quantity, dof, label: self.structure.label(dof).to_string() };
        let function = FrequencyResponse {
            response: channel(form.quantity(), response),
            reference: channel(Quantity::Force, reference),
            values: (0..function.values.len()).map(value).collect(),
            coherence: None,
        };
        Ok(Found { set, function, pair, assumed, estimator: estimator(header) })
    }

    /// What the project calls the DOFs of a side of the file that has these names, responses first.
    fn named(&self, side: usize, names: &[impl AsRef<str>]) -> &BTreeMap<String, String> {
        self.source.names((side == 1) != self.source.reciprocity, names)
    }

    /// Form and factor to SI, and whether it is assumed: from the project, else from the units of the file, else SI.
    fn form(&self, header: &FunctionHeader, units: Option<&uff::Units>) -> Result<(Form, f64, bool), String> {
        let (form, scale) = match (self.source.form, self.source.scale) {
            (Some(form), Some(scale)) => return Ok((form, scale, false)),
            said => said,
        };
        let ratio = match (ratio(header, units), form) {
            (Err(_), Some(form)) if names_no_unit(header) => {
                let (to_si, assumed) = of_form(form, units);
                return Ok((form, to_si, assumed));
            }
            (ratio, _) => ratio?,
        };
        if form.is_some_and(|form| form != ratio.form) {
            return Err(format!(
                "its units are those of another form ({:?}); correct `form` (of import: --form), or give `scale` (--scale) too",
                ratio.form
            ));
        }
        // With a form in the units, a scale corrects them.
        Ok((ratio.form, ratio.to_si * scale.unwrap_or(1.0), ratio.assumed && scale.is_none()))
    }
}

/// Faults of which several sets have the same, told of the first with the number of the others.
fn told_once(faults: &[String]) -> Vec<String> {
    // `file: set and line: what`
    let what = |fault: &str| fault.splitn(3, ": ").nth(2).map(str::to_owned);
    let mut told: Vec<(String, usize)> = Vec::new();
    for fault in faults {
        match told.iter_mut().find(|(first, _)| what(first).is_some() && what(first) == what(fault)) {
            Some((_, others)) => *others += 1,
            None => told.push((fault.clone(), 0)),
        }
    }
    let words = |(fault, others)| match others {
        0 => fault,
        1 => format!("{fault} (so in 1 further set)"),
        _ => format!("{fault} (so in {others} further sets)"),
    };
    told.into_iter().map(words).collect()
}

/// Takes the frequencies of the first function and compares those of the others.
fn common_frequencies(common: &mut Vec<f64>, function: &Function, set: usize) -> Result<(), FrfProblem> {
    let unit = function.header.abscissa.unit.as_str();
    if !matches!(unit, "Hz" | "hz" | "HZ" | "1/s") && !is_bare(unit) {
        return Err(FrfProblem::set(set, format!("its abscissa is in \"{unit}\"; export over frequency in Hz")));
    }
    let frequencies = function.abscissas();
    if frequencies.iter().any(|f| !f.is_finite()) || frequencies.windows(2).any(|pair| pair[1] <= pair[0]) {
        return Err(FrfProblem::set(set, "its frequencies do not increase; export over ascending frequencies"));
    }
    if common.is_empty() {
        *common = frequencies;
        return Ok(());
    }
    if same_frequencies(common, &frequencies) {
        return Ok(());
    }
    let what = "its frequencies are not those of the functions before it; put it into a file of its own";
    Err(FrfProblem::set(set, what))
}

/// What is said of functions without units.
fn assumed(name: &str, found: &[Found]) -> Option<String> {
    let count = found.iter().filter(|one| one.assumed).count();
    (count > 0).then(|| {
        format!(
            "{name}: {count} of {} functions name no unit: assumed to be in SI, motions in m, m/s or m/s^2 and forces in N; give \
             `scale` (of import: --scale) where they are not, such as 9.80665 for g",
            found.len()
        )
    })
}

/// The estimator that the lines of text of a function name.
fn estimator(header: &FunctionHeader) -> Option<usize> {
    let words = header.id.iter().flat_map(|line| line.split(|c: char| !c.is_alphanumeric()));
    words.map(str::to_uppercase).find_map(|word| ESTIMATORS.iter().position(|known| *known == word))
}

/// The functions without those that are there by a better estimator too, and how that is said.
fn one_estimator(found: Vec<Found>) -> (Vec<Found>, Option<String>) {
    let pair = |one: &Found| (one.function.response.dof, one.function.reference.dof);
    let best: BTreeMap<(usize, usize), usize> = {
        let mut best = BTreeMap::new();
        for one in &found {
            if let Some(own) = one.estimator {
                best.entry(pair(one)).and_modify(|least: &mut usize| *least = own.min(*least)).or_insert(own);
            }
        }
        best
    };
    let worse = |one: &Found| one.estimator.is_some_and(|own| best.get(&pair(one)).is_some_and(|least| *least < own));
    let (left, kept): (Vec<Found>, Vec<Found>) = found.into_iter().partition(worse);
    let said = left.first().and_then(|one| {
        let taken = ESTIMATORS[*best.get(&pair(one))?];
        let other = ESTIMATORS[one.estimator?];
        Some(format!("{} functions are there as {taken} and as {other}; {taken} is taken", left.len()))
    });
    (kept, said)
}

fn no_pair_twice(found: &[Found]) -> Result<(), FrfProblem> {
    let mut seen: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for one in found {
        let pair = (one.function.response.dof, one.function.reference.dof);
        if let Some(first) = seen.insert(pair, one.set) {
            let what = format!(
                "{} over {} is in set {} already; keep one of them",
                one.function.response,
                one.function.reference,
                first + 1
            );
            return Err(FrfProblem::set(one.set, what));
        }
    }
    Ok(())
}

/// Gives a coherence to the response of the same DOFs; one without a response is left out.
fn attach(found: &mut [Found], set: usize, coherence: &Function) -> Result<(), FrfProblem> {
    let pair = coherence.header.stated_dofs();
    let same = |one: &&mut Found| {
        let key = |dof: &uff::Dof| (dof.node, dof.direction.abs());
        key(&one.pair[0]) == key(&pair[0]) && key(&one.pair[1]) == key(&pair[1])
    };
    let Some(one) = found.iter_mut().find(same) else { return Ok(()) };
    let values: Vec<f64> = (0..coherence.values.len()).filter_map(|i| coherence.values.get(i)).map(|v| v[0]).collect();
    if !is_coherence(&values) {
        return Err(FrfProblem::set(set, "this coherence is not between 0 and 1; export it without a scale"));
    }
    one.function.coherence = Some(values);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Found, estimator, one_estimator, told_once};
    use crate::measurement::frf::FrequencyResponse;
    use crate::measurement::{Channel, Quantity};
    use uff::{Dof, Function, FunctionKind, Values};

    /// Two functions by H2 and H1 in this order and one by H2 alone: H1 is taken where it is there.
    #[test]
    fn of_two_estimators_one_is_taken() {
        let found = |set: usize, dof: usize, line: &str| {
            let (pair, none) = ([Dof::new(1, 3), Dof::new(2, 3)], Values::Complex(Vec::new()));
            let mut function =
                Function::even(FunctionKind::FrequencyResponse, pair[0].clone(), pair[1].clone(), 0.0, 1.0, none);
            line.clone_into(&mut function.header.id[0]);
            let channel = |quantity| Channel { quantity, dof, label: dof.to_string() };
            let (response, reference) = (channel(Quantity::Acceleration), channel(Quantity::Force));
            let response = FrequencyResponse { response, reference, values: Vec::new(), coherence: None };
            Found { set, function: response, pair, assumed: false, estimator: estimator(&function.header) }
        };
        let (kept, said) =
            one_estimator(vec![found(0, 1, "FRF H2"), found(1, 1, "FRF H1 (10 avg)"), found(2, 5, "H2")]);
        assert_eq!(kept.iter().map(|one| one.set).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(said.as_deref(), Some("1 functions are there as H1 and as H2; H1 is taken"));
        assert_eq!(one_estimator(vec![found(0, 1, "FRF"), found(1, 1, "FRF")]).0.len(), 2);
    }

    #[test]
    fn a_fault_of_many_sets_is_told_once() {
        let faults =
            ["a: set 1, line 3: short", "a: set 2, byte 9: short", "a: set 3, line 4: long", "a: set 4, byte 1: short"];
        let told = told_once(&faults.map(str::to_owned));
        assert_eq!(told, ["a: set 1, line 3: short (so in 2 further sets)", "a: set 3, line 4: long"]);
    }
}
