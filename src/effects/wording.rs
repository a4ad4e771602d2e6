//! What effects and places are called in tables, titles and sentences: the law's one name, its sentence, where it acts.

use super::effect::Effect;
use super::place::Place;
use super::source::Source;
use crate::structure::Structure;
use std::sync::LazyLock;

/// The names with a capital letter, in the order of [`Effect::ALL`].
static TITLES: LazyLock<Vec<String>> = LazyLock::new(|| Effect::ALL.map(|effect| capital(effect.noun())).to_vec());

/// With a capital letter at the start.
pub(crate) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

impl Effect {
    /// Its one name as in the middle of a sentence, such as `viscous dashpot`.
    pub fn noun(self) -> &'static str {
        self.description().name
    }

    /// The same at the start of a sentence and in titles, such as `Viscous dashpot`.
    pub fn title(self) -> &'static str {
        &TITLES[self as usize]
    }

    /// What it is physically, in one sentence.
    pub fn sentence(self) -> &'static str {
        self.description().sentence
    }
}

impl Place {
    /// As read after the name of an effect: `at DOF 15`, `between DOF 3 and 5`, `of acc@7`.
    pub fn phrase(&self, structure: &Structure) -> String {
        match self {
            Self::Dofs(dofs) => match &labels(dofs, structure)[..] {
                [dof] => format!("at DOF {dof}"),
                [first, second] => format!("between DOF {first} and {second}"),
                chain => format!("along DOF {}", chain.join("–")),
            },
            Self::Whole(None) => "of the whole structure".to_owned(),
            Self::Whole(Some([first, last])) if first == last => format!("of element {}", first + 1),
            Self::Whole(Some([first, last])) => format!("of elements {}–{}", first + 1, last + 1),
            Self::Channel(channel) => format!("of {channel}"),
        }
    }

    /// As read in a column of places: `7 to ground`, `7–9`, `1–3–5`, `whole structure`, `acc@7`.
    pub fn cell(&self, structure: &Structure) -> String {
        let short = self.short_cell(structure);
        if matches!(self, Self::Dofs(dofs) if dofs.len() == 1) { format!("{short} to ground") } else { short }
    }

    /// The same as [`Self::cell`] without the ground: `7`, `7–9`.
    pub fn short_cell(&self, structure: &Structure) -> String {
        match self {
            Self::Dofs(dofs) => labels(dofs, structure).join("–"),
            Self::Whole(None) => "whole structure".to_owned(),
            Self::Whole(Some([first, last])) if first == last => format!("element {}", first + 1),
            Self::Whole(Some([first, last])) => format!("elements {}–{}", first + 1, last + 1),
            Self::Channel(channel) => channel.clone(),
        }
    }
}

/// Labels of DOFs; a question mark for one that the structure lacks, for errors name such places too.
fn labels<'a>(dofs: &[usize], structure: &'a Structure) -> Vec<&'a str> {
    dofs.iter().map(|&dof| structure.dofs().get(dof).map_or("?", |d| d.label.as_str())).collect()
}

impl Source {
    /// Law and place as in the middle of a sentence: `Coulomb friction at DOF 15`, `loss factor of the whole structure`.
    pub fn phrase(&self, structure: &Structure) -> String {
        format!("{} {}", self.effect.noun(), self.place.phrase(structure))
    }

    /// The same at the start of a sentence: `Loss factor of the whole structure`.
    pub fn title(&self, structure: &Structure) -> String {
        capital(&self.phrase(structure))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::models;
    use crate::effects::WrittenPlace;

    #[test]
    fn a_place_is_read_in_a_sentence_and_in_a_column_and_written_by_its_labels() {
        let structure = models::five_masses();
        let dofs = |dofs: &[usize]| Place::Dofs(dofs.to_vec());
        for (place, phrase, cell, short) in [
            (dofs(&[1]), "at DOF 2", "2 to ground", "2"),
            (dofs(&[0, 1]), "between DOF 1 and 2", "1–2", "1–2"),
            (dofs(&[0, 1, 2]), "along DOF 1–2–3", "1–2–3", "1–2–3"),
            (dofs(&[99]), "at DOF ?", "? to ground", "?"),
            (Place::Whole(None), "of the whole structure", "whole structure", "whole structure"),
            (Place::Whole(Some([1, 3])), "of elements 2–4", "elements 2–4", "elements 2–4"),
            (Place::Whole(Some([1, 1])), "of element 2", "element 2", "element 2"),
            (Place::Channel("acc@2".into()), "of acc@2", "acc@2", "acc@2"),
        ] {
            assert_eq!(place.phrase(&structure), phrase);
            assert_eq!((place.cell(&structure), place.short_cell(&structure)), (cell.into(), short.into()));
        }
        let friction = Source::candidate(Effect::Coulomb, dofs(&[1]));
        assert_eq!(friction.title(&structure), "Coulomb friction at DOF 2");
        let written = |place: Place| (place.written(&structure), place.exported(&structure));
        let labels = WrittenPlace { dofs: vec!["1".into(), "2".into()], ..WrittenPlace::default() };
        assert_eq!(written(dofs(&[0, 1])), (labels, "1-2".into()));
        let elements = WrittenPlace { elements: Some([2, 4]), ..WrittenPlace::default() };
        assert_eq!(written(Place::Whole(Some([1, 3]))), (elements, "elements 2-4".into()));
        assert_eq!(written(Place::Whole(None)), (WrittenPlace::default(), "structure".into()));
        let channel = WrittenPlace { channel: Some("acc@2".into()), ..WrittenPlace::default() };
        assert_eq!(written(Place::Channel("acc@2".into())), (channel, "acc@2".into()));
    }
}
