//! The schematic pane: what it shows at the stage that is open.

use crate::display::format;
use crate::effects::State;
use crate::exchange::Project;
use crate::identify::Estimate;
use crate::window::app::ask::Ask;
use crate::window::app::commands::Command;
use crate::window::app::opened::Opened;
use crate::window::app::view::{Stage, View as LookedAt};
use crate::window::language::tr;
use crate::window::schematic::hit::Target;
use crate::window::schematic::view::{SEPARATOR, View};
use crate::window::schematic::{Layout, Scene};
use crate::window::stages::{explain, select};
use egui::Ui;
use faer::c64;
use std::sync::Arc;

/// Shows the schematic.
pub(crate) fn show(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let document = opened.document;
    let mut scene = opened.derived.scene(document);
    let outcome = opened.derived.known_outcome(document).and_then(Result::ok);
    let mut shares = None;
    if let (Some(outcome), Stage::Select | Stage::Result) = (&outcome, opened.view.stage) {
        let estimates = match (opened.view.stage, select::current(opened.view, outcome)) {
            (Stage::Select, Some(step)) => &step.sources,
            _ => &outcome.sources,
        };
        scene = Arc::new(identified(&scene, &document.project, estimates));
        let total: Vec<f32> = outcome.results.energy_percent.iter().map(|v| 0.01 * *v as f32).collect();
        shares = (opened.view.stage == Stage::Result).then_some(total);
    }
    let mut errors = None;
    if opened.view.stage == Stage::Explain {
        let laid = explain::errors(&scene, document, opened.view, &opened.derived.explained);
        (scene, shares, errors) = (laid.scene, laid.shares, Some(laid.caption));
    }
    let (moved, caption) = moved(ui, opened, &scene);
    let of_errors = errors.is_some();
    let colours = match &shares {
        Some(_) if !of_errors => Some("shaded: share of the energy"),
        None if moved.is_some() && Layout::turns(&scene) => Some("shaded: displacement"),
        _ => None,
    };
    let base = (scene.on_moving_base && opened.view.stage != Stage::Pattern).then_some("driven at its base");
    let caption = errors.unwrap_or(caption);
    let caption = [Some(caption.as_str()), base, colours];
    let caption = caption.into_iter().flatten().filter(|s| !s.is_empty()).collect::<Vec<_>>().join(SEPARATOR);
    let shape = moved.as_ref().map(|m| m.at(opened.view.phase));
    let largest = moved.map_or(0.0, |m| m.largest);
    let slot = |index: usize| scene.sources.iter().position(|s| s.index == index).map(Target::Source);
    let selected = opened.view.source.and_then(slot).or(opened.view.dof.map(Target::Dof));
    let law = (opened.view.stage == Stage::Pattern).then_some(opened.view.law).filter(|law| law.law().is_some());
    let (shape, shares) = (shape.as_deref(), shares.as_deref());
    let view = View { scene: &scene, shape, largest, shares, errors: of_errors, selected, law, caption: &caption };
    let intents = view.show(ui, &mut opened.view.schematic);
    asks.extend(intents.into_iter().map(Ask::Schematic));
}

/// The scene with the values that were identified.
fn identified(scene: &Scene, p: &Project, estimates: &[Estimate]) -> Scene {
    let mut scene = scene.clone();
    for estimate in estimates {
        let Some(source) = p.sources.get(estimate.source).filter(|s| s.state != State::Known) else { continue };
        if let Some(drawn) = scene.sources.iter_mut().find(|s| s.index == estimate.source) {
            drawn.identified = Some(crate::display::words::coefficient(source, estimate));
        }
    }
    scene
}

/// A motion of all DOFs, `Re(x exp(i phase))`, real at its largest translation.
struct Moved {
    x: Vec<c64>,
    largest: f64,
}

impl Moved {
    fn new(scene: &Scene, x: &[c64]) -> Option<Self> {
        let size = |d: &usize| x.get(*d).map_or(0.0, |v| v.re.hypot(v.im));
        let most = scene.translations().into_iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let largest = size(&most);
        let turn = (largest > 0.0).then(|| x[most].conj() / largest)?;
        Some(Self { x: x.iter().map(|v| v * turn).collect(), largest })
    }

    fn at(&self, phase: f64) -> Vec<f64> {
        let (sin, cos) = phase.sin_cos();
        self.x.iter().map(|v| v.re * cos - v.im * sin).collect()
    }
}

/// The motion that the stage is about, and what it is.
fn moved(ui: &Ui, opened: &mut Opened<'_>, scene: &Scene) -> (Option<Moved>, String) {
    let document = opened.document;
    match opened.view.stage {
        Stage::Pattern => {
            let verb = "Click a DOF: source to ground  ·  drag to another DOF: between the two  ·  drag a box: chain  ·  click a source twice: its state";
            (None, verb.to_owned())
        }
        _ if !opened.view.shape => (None, String::new()),
        Stage::Structure => mode(ui, opened, scene),
        _ => {
            let Some(Ok(motions)) = opened.derived.motions(ui.ctx(), document) else { return (None, String::new()) };
            let (run, runs) = (opened.view.run, &document.project.runs);
            let moved = motions.get(run).and_then(|x| Moved::new(scene, x));
            let caption = runs.get(run).filter(|_| moved.is_some()).map_or_else(String::new, |r| {
                let (frequency, size) =
                    (r.fit.omega / std::f64::consts::TAU, moved.as_ref().map_or(0.0, |m| m.largest));
                let (frequency, size) = (format::with_unit(frequency, "Hz"), format::prefixed(size, "m"));
                format!("Run {}   {frequency}   largest {size} (peak)", run + 1)
            });
            (moved, caption)
        }
    }
}

fn mode(ui: &Ui, opened: &mut Opened<'_>, scene: &Scene) -> (Option<Moved>, String) {
    let document = opened.document;
    let number = opened.view.mode;
    match opened.derived.modes(ui.ctx(), document) {
        Some(Ok(modes)) if number < modes.len() => {
            let x: Vec<c64> = modes.shape(number).iter().map(|&v| c64::new(v, 0.0)).collect();
            let frequency = format::with_unit(modes.frequency_hz(number), "Hz");
            (Moved::new(scene, &x), format!("Mode {}   {frequency}", number + 1))
        }
        _ => (None, String::new()),
    }
}

/// Whether the shape is shown and moves, at the right of the pane's title.
pub(crate) fn switches(ui: &mut Ui, view: &LookedAt, asks: &mut Vec<Ask>) {
    if view.stage == Stage::Pattern {
        return;
    }
    for (command, on) in [(Command::Animate, view.animate), (Command::Shape, view.shape)] {
        let label = if command == Command::Shape { "Deflect" } else { "Animate" };
        if ui.selectable_label(on, tr(label)).on_hover_text(tr(command.entry().tooltip)).clicked() {
            asks.push(Ask::Command(command));
        }
    }
}
