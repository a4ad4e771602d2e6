//! Where the measurements go, and the model that is laid under them.

use super::draft::Draft;
use crate::window::appearance::theme::space;
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{t, tr};
use egui::{TextEdit, Ui};
use std::path::{Path, PathBuf};

/// What is asked for at the foot of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImportAction {
    /// Make it.
    Accept,
    /// Forget the files.
    Cancel,
    /// Choose the files of a model.
    Model,
    /// Look at the files without a model.
    NoModel,
}

impl Draft {
    /// The project that is written, or the open one.
    pub fn destination(&self) -> PathBuf {
        match (&self.open, self.into) {
            (Some(open), true) => open.path.clone().unwrap_or_else(|| PathBuf::from("project.toml")),
            _ => PathBuf::from(self.target.trim()),
        }
    }
}

/// Shows destination, model and buttons.
pub(crate) fn show(ui: &mut Ui, draft: &mut Draft) -> Option<ImportAction> {
    let mut action = model(ui, draft);
    ui.horizontal(|ui| {
        if draft.open.is_some() {
            let into = ui.radio(draft.into, t!("Into this project"));
            let new = ui.radio(!draft.into, t!("New project"));
            draft.into = (draft.into || into.clicked()) && !new.clicked();
        }
        if draft.into_open() {
            return;
        }
        let label = ui.hint(if draft.open.is_some() { "" } else { "Project" });
        let field = TextEdit::singleline(&mut draft.target).desired_width(ui.available_width() - space::S);
        ui.add(field)
            .labelled_by(label.id)
            .on_hover_text(t!("The project file that is written; measurements stay where they are."));
    });
    ui.add_space(space::XS);
    let fault = draft.fault();
    ui.horizontal(|ui| {
        let label = if draft.into_open() { "Add to the project" } else { "Make the project" };
        if ui.add_enabled_ui(fault.is_none(), |ui| ui.primary(label)).inner.clicked() {
            action = Some(ImportAction::Accept);
        }
        if ui.button(t!("Cancel")).clicked() {
            action = Some(ImportAction::Cancel);
        }
        match fault {
            Some(fault) => ui.add(egui::Label::new(egui::RichText::new(tr(fault)).color(ui.palette().warning)).wrap()),
            None => ui.hint("The mapping is kept in the project; further files of this layout are read by it."),
        };
    });
    action
}

/// The finite-element model, where there is one.
fn model(ui: &mut Ui, draft: &Draft) -> Option<ImportAction> {
    if draft.into_open() {
        return None;
    }
    let request = &draft.request;
    let parts = [("mass", &request.mass), ("stiffness", &request.stiffness), ("nodes", &request.nodes)];
    let named = parts.iter().filter_map(|(what, path)| {
        let name = path.as_deref().and_then(Path::file_name)?.to_string_lossy().into_owned();
        Some(format!("{what} {name}"))
    });
    let named: Vec<String> = named.collect();
    let mut action = None;
    ui.horizontal(|ui| {
        ui.hint("Model");
        if named.is_empty() {
            ui.hint("none: only energies at the measured points are balanced")
                .on_hover_text(t!("A beam or a chain of masses: File > New from template first, then import into it."));
        } else {
            ui.label(tr(named.join(", ")));
            if ui.button(t!("Without")).clicked() {
                action = Some(ImportAction::NoModel);
            }
        }
        let what = "Mass and stiffness of NASTRAN (bulk data, punch, OUTPUT4), Abaqus or CalculiX, or Matrix Market, and nodes.";
        if ui.button(t!("Choose files…")).on_hover_text(tr(what)).clicked() {
            action = Some(ImportAction::Model);
        }
    });
    action
}
