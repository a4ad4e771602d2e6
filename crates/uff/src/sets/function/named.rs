//! DOFs that the lines of free text name where the fields of a function are empty (node 0).
//!
//! Several programs write `FRF Acc_3:+Z / Ham_5:+Z`, or `Reference: 5:+Z`, and leave the fields of nodes at zero.

use super::header::FunctionHeader;
use super::kind::FunctionKind;
use crate::dof::Dof;

/// Beginnings of words for an excitation.
const EXCITATION: [&str; 8] = ["ref", "ham", "force", "exc", "input", "imp", "shaker", "drive"];
/// Beginnings of words for a response.
const RESPONSE: [&str; 2] = ["resp", "output"];

impl FunctionHeader {
    /// DOFs of response and reference of a function of two: those of the fields, or, where these name no point, those that a line of free text
    /// names as `RESPONSE / REFERENCE` or behind the words for them. A point without a direction is a scalar (direction 0).
    pub fn stated_dofs(&self) -> [Dof; 2] {
        let fields = [self.response.clone(), self.reference.clone()];
        let empty = |dof: &Dof| dof.node == 0 && dof.direction == 0;
        let two = matches!(
            self.kind,
            FunctionKind::FrequencyResponse
                | FunctionKind::Transmissibility
                | FunctionKind::Coherence
                | FunctionKind::CrossSpectrum
                | FunctionKind::CrossCorrelation
                | FunctionKind::General
        );
        if !two || !fields.iter().any(empty) {
            return fields;
        }
        let behind = |words: &[&str]| self.id.iter().find_map(|line| labelled(line, words));
        let named = match self.id.iter().find_map(|line| pair(line)) {
            Some(pair) => pair.map(Some),
            None => [behind(&RESPONSE), behind(&EXCITATION)],
        };
        let mut sides = fields.into_iter().zip(named).map(|(field, named)| match named {
            Some(named) if empty(&field) => named,
            _ => field,
        });
        [sides.next().unwrap_or_default(), sides.next().unwrap_or_default()]
    }
}

/// Response and reference of a line with a stroke between two points: `Acc_3:+Z / Ham_5:+Z`; the excitation may stand first.
fn pair(line: &str) -> Option<[Dof; 2]> {
    line.match_indices('/').find_map(|(at, _)| {
        let (left, right) = (&line[..at], &line[at + 1..]);
        let last = left.char_indices().rfind(|(i, c)| c.is_ascii_digit() && !digit_before(left, *i))?.0;
        let (first, second) = (point(left, last)?, first_point(right)?);
        // A point stands beside the stroke, and dates, ratios and units have neither a word in front nor a direction behind.
        let beside = left[last + first.length..].trim().is_empty();
        let said = [&first, &second].iter().all(|point| point.named || point.dof.direction != 0);
        let [is_first, is_second] = [left, right].map(|side| words(side).any(|word| begins(word, &EXCITATION)));
        let turned = is_first && !is_second;
        (beside && said).then_some(if turned { [second.dof, first.dof] } else { [first.dof, second.dof] })
    })
}

/// The point behind a word such as `Reference:`.
fn labelled(line: &str, labels: &[&str]) -> Option<Dof> {
    let word = words(line).find(|word| begins(word, labels))?;
    let at = word.as_ptr() as usize - line.as_ptr() as usize;
    let behind = &line[at + word.len()..];
    // `Ref1` alone is a channel of the analyser.
    let glued = behind.starts_with(|c: char| c.is_ascii_digit());
    first_point(behind).map(|point| point.dof).filter(|dof| !glued || dof.direction != 0)
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_empty())
}

fn begins(word: &str, known: &[&str]) -> bool {
    let word = word.to_lowercase();
    known.iter().any(|known| word.starts_with(known))
}

/// A point in a text.
struct Point {
    dof: Dof,
    /// Whether a word stands in front of it, as in `Acc_3` or `Point 3`.
    named: bool,
    /// Bytes of it.
    length: usize,
}

fn digit_before(text: &str, at: usize) -> bool {
    text[..at].ends_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | ','))
}

fn first_point(text: &str) -> Option<Point> {
    let at = text.find(|c: char| c.is_ascii_digit())?;
    point(text, at)
}

/// The point whose number begins at `at`: `3`, `3:+Z`, `3-Z`, `3z`, `3 +RX`.
fn point(text: &str, at: usize) -> Option<Point> {
    let digits = text[at..].chars().take_while(char::is_ascii_digit).count();
    let node = text[at..at + digits].parse().ok().filter(|node| *node > 0)?;
    let rest = &text[at + digits..];
    let named = text[..at].trim_end_matches([' ', '_', '#', ':', '-']).ends_with(char::is_alphabetic);
    let behind = rest.trim_start_matches([':', '_', ' ']);
    let signed = behind.trim_start_matches(['+', '-']);
    let axis: String = signed.chars().take_while(|c| c.is_alphanumeric()).collect::<String>().to_uppercase();
    let direction = ["X", "Y", "Z", "RX", "RY", "RZ"].iter().position(|known| *known == axis);
    let Some(direction) = direction.and_then(|i| i64::try_from(i + 1).ok()) else {
        // A number that goes on is a value, a date or a count.
        let ends = !rest.starts_with(|c: char| c.is_alphanumeric() || matches!(c, '.' | ',' | '-'));
        return ends.then(|| Point { dof: Dof::new(node, 0), named, length: digits });
    };
    let sign = if behind.starts_with('-') { -1 } else { 1 };
    let length = digits + (rest.len() - signed.len()) + axis.len();
    Some(Point { dof: Dof::new(node, sign * direction), named, length })
}

#[cfg(test)]
mod tests {
    use super::super::Function;
    use super::*;
    use crate::values::Values;

    fn stated(lines: [&str; 2], fields: [Dof; 2]) -> String {
        let [response, reference] = fields;
        let mut function =
            Function::even(FunctionKind::FrequencyResponse, response, reference, 0.0, 1.0, Values::Complex(Vec::new()));
        for (id, line) in function.header.id.iter_mut().zip(lines) {
            line.clone_into(id);
        }
        function.header.stated_dofs().map(|dof| dof.to_string()).join(" ")
    }

    #[test]
    fn lines_of_free_text_name_points_where_the_fields_do_not() {
        let none = || [Dof::default(), Dof::default()];
        let dofs_of = |line: &str| stated([line, "21/03/24 10:11:12"], none());
        assert_eq!(dofs_of("FRF Acc_3:+Z / Ham_5:-Z"), "3:+Z 5:-Z");
        assert_eq!(dofs_of("FRF Ham_5:-Z / Acc_3:+Z"), "3:+Z 5:-Z");
        assert_eq!(dofs_of("beam:12:+X/beam:1:+X [m/s^2/N]"), "12:+X 1:+X");
        assert_eq!(dofs_of("H1 Point 3/Hammer 5"), "3:S 5:S");
        assert_eq!(dofs_of("Response: 3z  Reference: 5z"), "3:+Z 5:+Z");
        assert_eq!(stated(["Ref: Hammer 7:+Y", ""], [Dof::new(3, 2), Dof::default()]), "3:+Y 7:+Y");
        // What the fields say goes first; dates, units and ratios are no points.
        assert_eq!(stated(["Acc_3:+Z / Ham_5:+Z", ""], [Dof::new(1, 1), Dof::new(2, 1)]), "1:+X 2:+X");
        assert_eq!(dofs_of("Vib / Ref1 FRF"), "0:S 0:S");
        for line in ["Test 21/03/2024", "m/s^2/N", "Run 3/5 of 12", "Average 5, 12.5 Hz"] {
            assert_eq!(dofs_of(line), "0:S 0:S", "{line}");
        }
    }
}
