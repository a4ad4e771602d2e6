//! The DOFs of frequency responses mended: in the lists of a table where it has them, else under `[frf.dofs]` and, where forces
//! act elsewhere than the sensors of that name, under `[frf.reference_dofs]`.

use crate::exchange::project::file::Label;
use crate::exchange::project::frf::FrfTable;
use crate::session::command::Mending;
use crate::structure::{Direction, Structure};

/// Turns, exchanges or moves the DOFs of frequency responses, or scales all of them.
pub(super) fn mend(table: &mut FrfTable, mending: &Mending, on: &Structure) -> Result<(), String> {
    let labels: Vec<&str> = mending.channels.iter().map(|name| label_of(name)).collect();
    let of_force = mending.channels.iter().all(|name| name.starts_with("force@"));
    match (mending.factor, &labels[..]) {
        // One scale holds for all functions of a file.
        (Some(factor), _) if of_force || labels.len() > 1 => {
            let scale = table.scale.unwrap_or(1.0);
            table.scale = Some(if of_force { scale * factor } else { scale / factor });
            Ok(())
        }
        (Some(-1.0), &[label]) => change(
            table,
            false,
            &mending.driven,
            on,
            &|plain, minus| same(on, plain, label).then(|| (plain.to_owned(), !minus)),
            &[label],
        ),
        (Some(_), _) => Err("frequency responses have no factor a channel; mend the file".to_owned()),
        (None, &[from, to]) if mending.elsewhere => change(
            table,
            of_force,
            &mending.driven,
            on,
            &|plain, minus| same(on, plain, from).then(|| (to.to_owned(), minus)),
            &[from],
        ),
        (None, &[a, b]) => change(
            table,
            false,
            &mending.driven,
            on,
            &|plain, minus| {
                let other = if same(on, plain, a) { Some(b) } else { same(on, plain, b).then_some(a) };
                other.map(|other| (other.to_owned(), minus))
            },
            &[a, b],
        ),
        _ => Err("two channels are exchanged, no more and no fewer".to_owned()),
    }
}

/// What becomes of a label and of whether it is reversed; none where it stays.
type Change<'a> = &'a dyn Fn(&str, bool) -> Option<(String, bool)>;

/// Changes the labels of the sensors, or of the forces, those that are changed being `labels`. Where forces act at the same
/// points as sensors (`driven`), they stay where they are said to be.
fn change(
    table: &mut FrfTable,
    of_force: bool,
    driven: &[String],
    on: &Structure,
    new: Change,
    labels: &[&str],
) -> Result<(), String> {
    if !table.responses.is_empty() {
        let list = if of_force == table.reciprocity { &mut table.responses } else { &mut table.references };
        list.iter_mut().for_each(|label| renew(label, new));
        return Ok(());
    }
    for label in labels {
        let known = |own: &Label| same(on, plain(own), label);
        if !table.dofs.values().chain(table.reference_dofs.values()).any(known) {
            let key = of_file(on, label).ok_or_else(|| format!("DOF {label} has no node and direction"))?;
            table.dofs.insert(key, Label((*label).to_owned()));
        }
    }
    let is_driven = |own: &Label| driven.iter().any(|label| same(on, plain(own), label));
    let concerned = |own: &Label| labels.iter().any(|label| same(on, plain(own), label));
    let (dofs, forces) = (&mut table.dofs, &mut table.reference_dofs);
    let known = of_force && forces.values().any(concerned);
    for (key, own) in dofs.iter_mut().filter(|(_, own)| concerned(own) && !known) {
        if of_force || is_driven(own) {
            forces.entry(key.clone()).or_insert(own.clone());
        }
        if !of_force {
            renew(own, new);
        }
    }
    if of_force {
        forces.values_mut().for_each(|label| renew(label, new));
    }
    forces.retain(|key, label| dofs.get(key) != Some(label));
    Ok(())
}

fn renew(label: &mut Label, new: Change) {
    if let Some((name, minus)) = new(plain(label), label.0.starts_with('-')) {
        label.0 = if minus { format!("-{name}") } else { name };
    }
}

fn plain(label: &Label) -> &str {
    label.0.trim_start_matches('-')
}

/// Whether two labels are those of one DOF.
fn same(on: &Structure, a: &str, b: &str) -> bool {
    a == b || on.dof(a).is_some_and(|row| on.dof(b) == Some(row))
}

/// A DOF as Universal Files name it.
fn of_file(structure: &Structure, label: &str) -> Option<String> {
    let dof = &structure.dofs()[structure.dof(label)?];
    let direction = match dof.direction {
        Direction::X => "+X",
        Direction::Y => "+Y",
        Direction::Z => "+Z",
        Direction::Rx => "+RX",
        Direction::Ry => "+RY",
        Direction::Rz => "+RZ",
        Direction::Q => return None,
    };
    Some(format!("{}:{direction}", structure.nodes()[dof.node].label))
}

/// The label in the name of a channel, such as `7` of `acc@7`.
pub(super) fn label_of(name: &str) -> &str {
    name.split_once('@').map_or(name, |(_, label)| label)
}
