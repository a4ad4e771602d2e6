//! The context menu of the schematic: what can be done with a DOF or a source.

use super::Scene;
use super::gesture::Intent;
use super::hit::Target;
use crate::effects::{Effect, State};
use crate::session::Command;
use crate::window::appearance::widgets::UiExt;
use crate::window::document::edits::Edit;
use crate::window::language::{t, tf, tr};
use egui::Ui;

/// Shows the entries for what was pointed at.
pub(crate) fn show(ui: &mut Ui, scene: &Scene, target: Option<Target>, intents: &mut Vec<Intent>) {
    let chosen = match target {
        Some(Target::Dof(dof)) => self::dof(ui, scene, dof),
        Some(Target::Source(slot)) => source(ui, scene, slot),
        None => {
            ui.hint("Point at a degree of freedom or at a source.");
            None
        }
    };
    if let Some(intent) = chosen {
        intents.push(intent);
        ui.close();
    }
}

fn dof(ui: &mut Ui, scene: &Scene, dof: usize) -> Option<Intent> {
    let label = &scene.dofs[dof].label;
    ui.hint(format!("DOF {label}"));
    let mut chosen = None;
    // All others are in the palette.
    for law in Effect::ALL.into_iter().filter(|law| law.description().usual) {
        if ui.button(tf!("Candidate: {} to the ground", law.noun())).clicked() {
            chosen = Some(Intent::Edit(Edit::Draw(law, vec![dof])));
        }
    }
    ui.separator();
    if ui.button(t!("Add a mass of 0.1 kg")).clicked() {
        let command = Command::SetLumpedMass { dof: label.clone(), mass: Some(0.1) };
        chosen = Some(Intent::Edit(Edit::Do(command)));
    }
    if ui.button(t!("Select", "button")).clicked() {
        chosen = Some(Intent::SelectDof(dof));
    }
    chosen
}

fn source(ui: &mut Ui, scene: &Scene, slot: usize) -> Option<Intent> {
    let source = scene.sources.get(slot)?;
    ui.hint(source.effect.noun());
    let mut chosen = None;
    for state in [State::Candidate, State::Forced, State::Known, State::Off] {
        if ui.selectable_label(source.state == state, tr(state.word())).clicked() {
            chosen = Some(Intent::Edit(Edit::SetState(source.index, state)));
        }
    }
    ui.separator();
    if ui.button(t!("Remove")).clicked() {
        chosen = Some(Intent::RemoveSource(source.index));
    }
    chosen
}
