//! What becomes of a suggestion that is added: a known source, a larger coefficient of one that is there, or a correction
//! of a channel.

use crate::effects::{Kind, Place, Source, State};
use crate::exchange::Project;
use crate::exchange::project::file::ProjectFile;
use crate::session::{Command, EffectAt, SourceAt, SourceSpec};
use crate::structure::Structure;
use std::collections::BTreeMap;

/// The command that adds an effect at its values.
///
/// # Errors
/// One sentence: the effect does not exist here, or is there already and two of it are not one.
pub fn add(source: &Source, p: &Project, file: &ProjectFile) -> Result<Command, String> {
    if let Place::Channel(channel) = &source.place {
        return Ok(correct(channel, source, file));
    }
    source.check_on(&p.structure).map_err(|e| e.to_string())?;
    let (dofs, elements) = labels(&source.place, &p.structure);
    let names = source.effect.parameters().iter().map(|parameter| parameter.name.to_owned());
    let values = source.parameters.iter().copied();
    let there = p.sources.iter().find(|s| s.state == State::Known && s.is_same(source));
    let Some(there) = there else {
        let parameters = names.zip(values).collect();
        let (law, state) = (source.effect, State::Known);
        return Ok(Command::AddSource(SourceSpec { law, dofs, elements, state, parameters }));
    };
    let sum = together(there, source)?;
    let at = SourceAt { law: source.effect, dofs, elements, state: Some(State::Known) };
    Ok(Command::SetSourceParameters { source: at, parameters: BTreeMap::from([sum]) })
}

/// Name and value of the coefficient of two sources of one law at one place, where they act as one.
fn together(there: &Source, more: &Source) -> Result<(String, f64), String> {
    let parameters = there.effect.parameters();
    let alike = |k: usize| parameters[k].linear || there.parameters[k] == more.parameters[k];
    match there.effect.coefficient() {
        Some(k) if (0..parameters.len()).all(alike) => {
            Ok((parameters[k].name.to_owned(), there.parameters[k] + more.parameters[k]))
        }
        _ => Err(format!("{} is in the model there already; change its values in the inspector", there.effect.title())),
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
pub fn take_over(found: &[(usize, f64)], p: &Project) -> Result<Vec<Command>, String> {
    let mut commands = Vec::new();
    for &(index, value) in found {
        let source = p.sources.get(index).ok_or_else(|| format!("there is no source {}", index + 1))?;
        let name = source.effect.coefficient().map(|k| source.effect.parameters()[k].name);
        let name = name.ok_or_else(|| format!("{} has no coefficient to be taken over", source.effect.title()))?;
        let (dofs, elements) = labels(&source.place, &p.structure);
        let at = SourceAt { law: source.effect, dofs, elements, state: Some(source.state) };
        let known = SourceAt { state: Some(State::Known), ..at.clone() };
        // What is known there already gets the coefficient on top of its own.
        let there = p.sources.iter().find(|s| s.state == State::Known && s.is_same(source));
        let own = there.zip(source.effect.coefficient()).map(|(s, k)| s.parameters[k]);
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
    let (dofs, elements) = labels(&source.place, structure);
    let channel = match &source.place {
        Place::Channel(channel) => Some(channel.clone()),
        Place::Dofs(_) | Place::Whole(_) => None,
    };
    EffectAt { law: source.effect, dofs, elements, channel }
}

/// Labels of the DOFs of a place, or its range of elements counted from 1.
pub fn labels(place: &Place, structure: &Structure) -> (Vec<String>, Option<[i64; 2]>) {
    match place {
        Place::Dofs(dofs) => (dofs.iter().map(|&d| structure.label(d).to_owned()).collect(), None),
        Place::Whole(range) => (Vec::new(), range.map(|r| r.map(|e| e as i64 + 1))),
        Place::Channel(_) => (Vec::new(), None),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use crate::control::Control;
    use crate::effects::{Effect, Place, Source};
    use crate::exchange::project::load;
    use crate::window::document::{Applied, Document};
    use crate::window::edits::Edit;

    const CHAIN: &str = "[project]\nformat = 1\ntitle = \"Chain\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\n\
                         ground_stiffness = [100.0, 0.0]\ncoupling_stiffness = [50.0]\n\
                         [[harmonics]]\nfile = \"h.csv\"\n";
    const HARMONICS: &str = "run,frequency_hz,channel,harmonic,cos,sin\na,2.0,force@1 [N],1,1.0,0.0\na,2.0,force@1 [N],2,0.0,0.0\n\
                             a,2.0,acc@2 [m/s^2],1,0.3,-0.4\na,2.0,acc@2 [m/s^2],2,0.01,0.02\n";

    fn document() -> (tempfile::TempDir, Document) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("h.csv"), HARMONICS).unwrap();
        let path = folder.path().join("project.toml");
        std::fs::write(&path, CHAIN).unwrap();
        let document = Document::open(&path, &Control::unattended()).unwrap().0;
        (folder, document)
    }

    /// Adds an effect, and reads what that needs.
    fn add(d: &mut Document, source: &Source) -> Result<(), String> {
        let command = super::add(source, &d.project, d.session().document().file())?;
        match d.apply(&Edit::Do(command))? {
            Applied::Done(_) => Ok(()),
            Applied::Waits(waiting) => d.finish(waiting.read(&Control::unattended())?),
        }
    }

    fn channel(effect: Effect, value: f64) -> Source {
        Source::known(effect, Place::Channel("acc@2".to_owned()), &[value])
    }

    #[test]
    fn a_corrected_channel_is_that_of_the_saved_project_read_anew_and_undo_restores_it() {
        let (folder, mut d) = document();
        let before = d.project.runs.clone();
        for error in [channel(Effect::Delay, 2e-3), channel(Effect::Gain, 1.1), channel(Effect::Delay, 1e-3)] {
            add(&mut d, &error).unwrap();
        }
        d.save().unwrap();
        let again = load(&folder.path().join("project.toml"), &Control::unattended()).unwrap();
        for (now, read) in d.project.runs[0].fit.channels.iter().zip(&again.runs[0].fit.channels) {
            for (a, b) in now.amplitudes.iter().zip(&read.amplitudes) {
                assert!((a - b).norm() < 1e-14, "{a} is not {b}");
            }
        }
        assert_ne!(d.project.runs, before);
        while d.undo().is_some() {}
        assert_eq!(d.project.runs, before);
    }

    #[test]
    fn an_effect_that_is_there_already_grows_by_what_was_found() {
        let (_folder, mut d) = document();
        let damper = |c: f64| Source::known(Effect::Viscous, Place::Dofs(vec![0, 1]), &[c]);
        add(&mut d, &damper(2.0)).unwrap();
        add(&mut d, &damper(0.5)).unwrap();
        assert_eq!(d.project.sources.len(), 1);
        assert!((d.project.sources[0].parameters[0] - 2.5).abs() < 1e-15);
        let slider = |force: f64| Source::known(Effect::ElasticSlider, Place::Dofs(vec![1]), &[1000.0, force]);
        add(&mut d, &slider(1.0)).unwrap();
        assert!(add(&mut d, &slider(2.0)).unwrap_err().contains("already"));
        assert_eq!(d.undo().as_deref(), Some("add elastic slider"));
    }
}
