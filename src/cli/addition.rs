//! Writes an effect into a project's text as known: a new table, a larger coefficient of what is known there already, or
//! an error of a channel on top of the one that is corrected already.

use super::diagnose::label;
use super::source_words::labels;
use crate::effects::{Effect, Place, Source, State};
use crate::exchange::Project;
use anyhow::bail;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, value};

/// Adds `source`; comments and everything else stay as they are.
///
/// # Errors
/// One sentence where the law is known at that place and two of it are not one, or the list is not written as tables.
pub(super) fn add(document: &mut DocumentMut, project: &Project, source: &Source) -> anyhow::Result<()> {
    if let Place::Channel(channel) = &source.place {
        correct_channel(list(document, "sensor")?, channel, source);
        return Ok(());
    }
    // Sources come in the order of their tables; members of families follow.
    let there = project.sources.iter().position(|s| s.state == State::Known && s.is_same(source));
    let Some(row) = there else {
        list(document, "source")?.push(written(project, source));
        return Ok(());
    };
    let Some(k) = coefficient_of_both(&project.sources[row], source) else {
        bail!(
            "{} is known at this place already, and two of it with other parameters are not one; change its values by hand",
            source.effect
        );
    };
    let name = source.effect.parameters()[k].name;
    let table = list(document, "source")?.get_mut(row);
    let known = table.as_deref().and_then(|t| t.get(name)).and_then(number);
    let (Some(table), Some(known)) = (table, known) else { bail!("source {} has no `{name}` to add to", row + 1) };
    table[name] = value(known + source.parameters[k]);
    Ok(())
}

/// The parameter whose values add up where two sources of one law act at one place.
fn coefficient_of_both(there: &Source, more: &Source) -> Option<usize> {
    let parameters = there.effect.parameters();
    let alike = |k: usize| parameters[k].linear || there.parameters[k] == more.parameters[k];
    there.effect.coefficient().filter(|_| (0..parameters.len()).all(alike))
}

/// The table of a known source.
fn written(project: &Project, source: &Source) -> Table {
    let mut table = Table::new();
    table["law"] = value(source.effect.name());
    let dofs = labels(&project.structure, &source.place);
    if !dofs.is_empty() {
        table["dofs"] = value(dofs.into_iter().map(label).collect::<Array>());
    }
    if let Place::Whole(Some(range)) = source.place {
        table["elements"] = value(range.map(|e| e as i64 + 1).into_iter().collect::<Array>());
    }
    table["state"] = value("known");
    for (parameter, number) in source.effect.parameters().iter().zip(&source.parameters) {
        table[parameter.name] = value(*number);
    }
    table
}

/// A gain times the one that is known, a delay on top of it.
fn correct_channel(sensors: &mut ArrayOfTables, channel: &str, error: &Source) {
    let name = error.effect.parameters()[0].name;
    let more = error.parameters[0];
    let same = |table: &Table| table.get("channel").and_then(Item::as_str).is_some_and(|c| c.trim() == channel);
    let Some(row) = sensors.iter().position(same) else {
        let mut table = Table::new();
        table["channel"] = value(channel);
        table[name] = value(more);
        sensors.push(table);
        return;
    };
    let Some(table) = sensors.get_mut(row) else { return };
    let known = table.get(name).and_then(number);
    table[name] = value(match error.effect {
        Effect::Delay => known.unwrap_or(0.0) + more,
        _ => known.unwrap_or(1.0) * more,
    });
}

fn number(item: &Item) -> Option<f64> {
    item.as_float().or_else(|| item.as_integer().map(|i| i as f64))
}

fn list<'a>(document: &'a mut DocumentMut, name: &str) -> anyhow::Result<&'a mut ArrayOfTables> {
    match document.entry(name).or_insert_with(|| ArrayOfTables::new().into()).as_array_of_tables_mut() {
        Some(list) => Ok(list),
        None => bail!("write `{name}` as [[{name}]] tables, so that one can be added"),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::*;
    use crate::control::Control;
    use crate::exchange::project::load;
    use tempfile::TempDir;

    const TEXT: &str = "# kept\n[project]\nformat = 1\ntitle = \"t\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\n\
        ground_stiffness = [100.0, 0.0]\ncoupling_stiffness = [50.0]\n\
        [[source]]\nlaw = \"viscous\"\ndofs = [2, 1]\nstate = \"known\"\nc = 2\n\
        [[source]]\nlaw = \"elastic_slider\"\ndofs = [2]\nstate = \"known\"\nstiffness = 10.0\nforce = 1.0\n\
        [[sensor]]\nchannel = \"acc@2\"\ngain = 1.1\n[[harmonics]]\nfile = \"h.csv\"\n";
    const HARMONICS: &str = "run,frequency_hz,channel,harmonic,cos,sin\na,2.0,force@1 [N],1,1.0,0.0\n\
        a,2.0,acc@2 [m/s^2],1,0.3,-0.4\n";

    fn project() -> (TempDir, Project) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("h.csv"), HARMONICS).unwrap();
        std::fs::write(folder.path().join("p.toml"), TEXT).unwrap();
        let project = load(&folder.path().join("p.toml"), &Control::unattended()).unwrap();
        (folder, project)
    }

    fn at(effect: Effect, dofs: &[usize], parameters: &[f64]) -> Source {
        Source::known(effect, Place::Dofs(dofs.to_vec()), parameters)
    }

    fn channel(effect: Effect, value: f64) -> Source {
        Source::known(effect, Place::Channel("acc@2".into()), &[value])
    }

    #[test]
    fn what_is_added_to_what_is_there_opens_and_has_the_sum() {
        let (folder, project) = project();
        let mut document: DocumentMut = TEXT.parse().unwrap();
        let more = [at(Effect::Viscous, &[0, 1], &[0.5]), at(Effect::Coulomb, &[1], &[3.0])];
        let channels = [channel(Effect::Gain, 2.0), channel(Effect::Delay, 1e-3)];
        for source in more.iter().chain(&channels) {
            add(&mut document, &project, source).unwrap();
        }
        std::fs::write(folder.path().join("p.toml"), document.to_string()).unwrap();
        let again = load(&folder.path().join("p.toml"), &Control::unattended()).unwrap();
        let found = |wanted: &Source| again.sources.iter().find(|s| s.is_same(wanted)).unwrap().parameters.clone();
        assert_eq!((found(&more[0]), found(&more[1])), (vec![2.5], vec![3.0]));
        let text = document.to_string();
        assert!(text.contains("gain = 2.2\n") && text.contains("delay = 0.001\n"), "{text}");
        assert_eq!(text.matches("[[sensor]]").count(), 1);
        assert!(document.to_string().starts_with("# kept"));
    }

    #[test]
    fn two_sliders_at_one_place_are_not_one() {
        let (_folder, project) = project();
        let mut document: DocumentMut = TEXT.parse().unwrap();
        let slider = at(Effect::ElasticSlider, &[1], &[20.0, 1.0]);
        let said = add(&mut document, &project, &slider).unwrap_err().to_string();
        assert!(said.contains("two of it with other parameters are not one"), "{said}");
    }
}
