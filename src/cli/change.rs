//! `dashpot change`: what changed between two states of a structure, each source and mode with its deviations.

use super::arguments::ChangeStates;
use super::source_json;
use super::table::{number, table};
use crate::control::Control;
use crate::display::change as said;
use crate::exchange::{Project, project::load};
use crate::identify::change::{LEVEL, ModeChange, Pair, SourceChange};
use crate::session::states::{Against, Compared, compare, states};
use crate::session::workers::Threads;
use anyhow::{Context, anyhow, bail};
use serde_json::{Value, json};
use std::sync::Arc;

pub(super) fn run(arguments: &ChangeStates) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let pair = projects(arguments, &control)?;
    pair.iter().for_each(super::remarks::tell_remarks);
    let second = arguments.after.as_ref().unwrap_or(&arguments.before);
    let found = compare(pair, &control)
        .with_context(|| format!("{} against {}", arguments.before.display(), second.display()))?;
    if arguments.json {
        return Ok(format!("{:#}\n", document(&found)));
    }
    Ok(text(&found))
}

/// Two projects, or one with the runs of two of its sessions.
fn projects(arguments: &ChangeStates, control: &Control) -> anyhow::Result<[Project; 2]> {
    let first = load(&arguments.before, control)?;
    match (&arguments.after, &arguments.sessions[..]) {
        (Some(after), []) => Ok([first, load(after, control)?]),
        (None, [one, two]) => {
            states(&first, &Against::Sessions([one.clone(), two.clone()]), control).map_err(|e| anyhow!(e))
        }
        _ => bail!("give two projects, or one project and --sessions FIRST,SECOND"),
    }
}

fn text(Compared { titles, structure, change }: &Compared) -> String {
    let mut out = format!("first   {}\nsecond  {}\n\n", titles[0], titles[1]);
    let head = ["source", "first", "+-", "second", "+-", "difference", "+-", "chance", ""];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for s in &change.sources {
        let place = s.source.place.cell(structure);
        let name = format!("{} {place}, {}", s.source.effect.noun(), said::unit(s));
        rows.push(row(name, &s.coefficient, 1.0));
    }
    out.push_str(&table(&rows));
    if !change.modes.is_empty() {
        out.push_str("\ndamping ratios, per cent\n");
        let head = ["mode at Hz", "first", "+-", "second", "+-", "difference", "+-", "chance", ""];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        rows.extend(change.modes.iter().map(|m| row(number(m.frequency_hz[0]), &m.ratio, 100.0)));
        out.push_str(&table(&rows));
    }
    out.push_str(&format!("\n{}\n", said::sentence(structure, change)));
    out
}

fn row(name: String, pair: &Pair, factor: f64) -> Vec<String> {
    let mark = if pair.is_significant() { "changed" } else { "" };
    let values =
        [pair.values[0], pair.deviations[0], pair.values[1], pair.deviations[1], pair.difference, pair.deviation];
    let cells = values.into_iter().map(|v| number(factor * v));
    std::iter::once(name).chain(cells).chain([said::chance(pair.chance), mark.to_owned()]).collect()
}

fn document(Compared { titles, structure, change }: &Compared) -> Value {
    let pair = |p: &Pair| {
        json!({"values": p.values, "deviations": p.deviations, "difference": p.difference, "deviation": p.deviation,
               "chance": p.chance, "changed": p.is_significant()})
    };
    let source = |s: &SourceChange| {
        let mut entry = source_json::of_law(&s.source, structure);
        entry.insert("coefficient".into(), pair(&s.coefficient));
        entry.insert("unit".into(), json!(said::unit(s)));
        entry.insert("energy_percent".into(), json!(s.energy_percent));
        entry.insert("accepted".into(), json!(s.accepted));
        Value::Object(entry)
    };
    let mode = |m: &ModeChange| json!({"frequency_hz": m.frequency_hz, "damping_ratio": pair(&m.ratio)});
    json!({
        "titles": titles, "level": LEVEL, "chi_square": change.chi_square,
        "degrees_of_freedom": change.sources.len(), "chance": change.chance,
        "sentence": said::sentence(structure, change),
        "sources": change.sources.iter().map(source).collect::<Vec<_>>(),
        "modes": change.modes.iter().map(mode).collect::<Vec<_>>(),
    })
}
