//! What becomes of a suggestion that is added: a known source, a larger coefficient of one that is there, or a correction
//! of a channel. The command line and the window add by the same commands.

use super::command::{Command, EffectAt, SourceAt, SourceSpec};
use super::document::Document;
use crate::effects::{Kind, Place, Source, State, WrittenPlace};
use crate::exchange::project::file::ProjectFile;
use crate::structure::Structure;
use std::collections::BTreeMap;

/// The command that adds an effect at its values.
///
/// # Errors
/// One sentence: the effect does not exist here, or is there already and two of it are not one.
pub fn add(source: &Source, document: &Document) -> Result<Command, String> {
    if let Place::Channel(channel) = &source.place {
        return Ok(correct(channel, source, document.file()));
    }
    source.check_on(document.structure()).map_err(|e| e.to_string())?;
    let WrittenPlace { dofs, elements, .. } = source.place.written(document.structure());
    let names = source.effect.parameters().iter().map(|parameter| parameter.name.to_owned());
    let values = source.parameters.iter().copied();
    let Some(there) = known_there(source, document) else {
        let parameters = names.zip(values).collect();
        let (law, state) = (source.effect, State::Known);
        return Ok(Command::AddSource(SourceSpec { law, dofs, elements, state, parameters }));
    };
    let sum = together(there, source)?;
    let at = SourceAt { law: source.effect, dofs, elements, state: Some(State::Known) };
    Ok(Command::SetSourceParameters { source: at, parameters: BTreeMap::from([sum]) })
}

/// The known source of the same law at the same place.
fn known_there<'a>(source: &Source, document: &'a Document) -> Option<&'a Source> {
    document.sources().iter().find(|s| s.state == State::Known && s.is_same(source))
}

/// Name and value of the coefficient of two sources of one law at one place, where they act as one.
fn together(there: &Source, more: &Source) -> Result<(String, f64), String> {
    let parameters = there.effect.parameters();
    let alike = |k: usize| parameters[k].linear || there.parameters[k] == more.parameters[k];
    match there.effect.coefficient() {
        Some(k) if (0..parameters.len()).all(alike) => {
            Ok((parameters[k].name.to_owned(), there.parameters[k] + more.parameters[k]))
        }
        _ => Err(format!(
            "{} is known at this place already, and two of it with other parameters are not one; change its values there",
            there.effect.title()
        )),
    }
}

/// A found error of a channel on top of what is known of it.
fn correct(channel: &str, error: &Source, file: &ProjectFile) -> Command {
    let known = file.sensor.iter().find(|sensor| sensor.channel == channel);
    let (mut delay, mut gain) = (known.and_then(|s| s.delay), known.and_then(|s| s.gain));
    let value = error.parameters.first().copied();
    if let (Kind::Channel(law), Some(more)) = (error.effect.kind(), value) {
        let known = if law.turns_phase() { &mut delay } else { &mut gain };
        *known = Some(law.joined(known.unwrap_or(law.neutral()), more));
    }
    Command::SetSensor { channel: channel.to_owned(), delay, gain }
}

/// The commands that make what was identified known at its values; `found` are indices of sources with coefficients.
///
/// # Errors
/// One sentence: a law without a coefficient.
pub fn take_over(found: &[(usize, f64)], document: &Document) -> Result<Vec<Command>, String> {
    let mut commands = Vec::new();
    for &(index, value) in found {
        let source = document.sources().get(index).ok_or_else(|| format!("there is no source {}", index + 1))?;
        let name = source.effect.coefficient().map(|k| source.effect.parameters()[k].name);
        let name = name.ok_or_else(|| format!("{} has no coefficient to be taken over", source.effect.title()))?;
        let WrittenPlace { dofs, elements, .. } = source.place.written(document.structure());
        let at = SourceAt { law: source.effect, dofs, elements, state: Some(source.state) };
        let known = SourceAt { state: Some(State::Known), ..at.clone() };
        // What is known there already gets the coefficient on top of its own.
        let own = known_there(source, document).zip(source.effect.coefficient()).map(|(s, k)| s.parameters[k]);
        let state = if own.is_some() { State::Off } else { State::Known };
        let value = value + own.unwrap_or(0.0);
        commands.push(Command::SetSourceState { source: at, state });
        let parameters = BTreeMap::from([(name.to_owned(), value)]);
        commands.push(Command::SetSourceParameters { source: known, parameters });
    }
    Ok(commands)
}

/// An effect at its place, in the words of the session.
pub fn effect_at(source: &Source, structure: &Structure) -> EffectAt {
    let WrittenPlace { dofs, elements, channel } = source.place.written(structure);
    EffectAt { law: source.effect, dofs, elements, channel }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::effects::Effect;
    use std::path::Path;

    const TEXT: &str = "[project]\nformat = 1\ntitle = \"t\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\n\
        ground_stiffness = [100.0, 0.0]\ncoupling_stiffness = [50.0]\n\
        [[source]]\nlaw = \"viscous\"\ndofs = [2, 1]\nstate = \"known\"\nc = 2\n\
        [[source]]\nlaw = \"elastic_slider\"\ndofs = [2]\nstate = \"known\"\nstiffness = 10.0\nforce = 1.0\n\
        [[sensor]]\nchannel = \"acc@2\"\ngain = 1.1\n";

    fn document() -> Document {
        Document::new(ProjectFile::parse(TEXT, "p.toml").unwrap().0, Path::new("")).unwrap()
    }

    fn at(effect: Effect, dofs: &[usize], parameters: &[f64]) -> Source {
        Source::known(effect, Place::Dofs(dofs.to_vec()), parameters)
    }

    fn channel(effect: Effect, value: f64) -> Source {
        Source::known(effect, Place::Channel("acc@2".into()), &[value])
    }

    #[test]
    fn what_is_added_to_what_is_there_has_the_sum() {
        let mut d = document();
        let more = [at(Effect::Viscous, &[0, 1], &[0.5]), at(Effect::Coulomb, &[1], &[3.0])];
        for source in more.iter().chain(&[channel(Effect::Gain, 2.0), channel(Effect::Delay, 1e-3)]) {
            d = d.after(&add(source, &d).unwrap()).unwrap();
        }
        let found = |wanted: &Source| d.sources().iter().find(|s| s.is_same(wanted)).unwrap().parameters.clone();
        assert_eq!((found(&more[0]), found(&more[1])), (vec![2.5], vec![3.0]));
        let [sensor] = &d.file().sensor[..] else { panic!("{:?}", d.file().sensor) };
        assert_eq!((sensor.gain, sensor.delay), (Some(2.2), Some(1e-3)));
    }

    #[test]
    fn two_sliders_at_one_place_are_not_one() {
        let said = add(&at(Effect::ElasticSlider, &[1], &[20.0, 1.0]), &document()).unwrap_err();
        assert!(said.contains("two of it with other parameters are not one"), "{said}");
    }
}
