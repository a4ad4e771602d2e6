//! The panes of the stage, each on its own: error map, the cell that was clicked, suggestions, ledger.

use super::detail::Detail;
use super::look::Look;
use super::map::{self, Map};
use super::request::Request;
use super::scene::Scene;
use super::{card, cards, ledger, record};
use crate::diagnosis::Comparison;
use crate::display::format::in_words;
use crate::effects::{Source, State};
use crate::identify::{Estimate, Outcome};
use crate::plots::error_map::{ENERGY, Scale};
use crate::plots::response_curve::Curve;
use crate::plots::samples;
use crate::session::validation::only_records;
use crate::window::app::ask::Ask;
use crate::window::app::opened::Opened;
use crate::window::appearance::theme::{size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::background::cache::Cached;
use crate::window::language::{t, tr};
use egui::{Align, Label, Layout, Rect, RichText, Ui};
use std::sync::Arc;

/// What the map and the cell show.
struct Shown<'a> {
    /// Of the model as it stands, or of the last one while that is computed.
    comparison: &'a Arc<Comparison>,
    /// Whether it is of an earlier model.
    stale: bool,
    /// Effect on trial and the comparison with it, once it is there.
    trial: Option<(&'a Source, Option<&'a Arc<Comparison>>)>,
}

impl<'a> Shown<'a> {
    /// What there is; otherwise says why there is nothing.
    fn new(ui: &mut Ui, scene: &Scene<'a>, look: &'a Look, asks: &mut Vec<Ask>) -> Option<Self> {
        let (document, explained) = (scene.document, scene.explained);
        let now = match explained.comparison(document) {
            Some(Err(error)) => {
                ui.title("The model cannot be compared", "");
                ui.colored_label(ui.palette().error, tr(error));
                if ui.button(t!("Compare again")).clicked() {
                    asks.push(Ask::Explain(Request::Retry));
                }
                return None;
            }
            Some(Ok(comparison)) => Some(comparison),
            None => None,
        };
        let Some(comparison) = now.or(explained.last_comparison()) else {
            ui.empty("The model is being compared", "Its progress is in the bar below.");
            return None;
        };
        let trial = look.trial.as_ref().filter(|_| now.is_some());
        let tried = |t: &Source| explained.trial(document, t).and_then(|c| c.as_ref().ok());
        Some(Self { comparison, stale: now.is_none(), trial: trial.map(|t| (t, tried(t))) })
    }

    fn tried(&self) -> Option<&'a Arc<Comparison>> {
        self.trial.and_then(|(_, comparison)| comparison)
    }
}

/// The error map with its legend.
pub(crate) fn error_map(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let document = opened.document;
    let p = &document.project;
    if p.runs.is_empty() && !only_records(p) {
        ui.empty("Nothing to compare with", "Import measurements: runs, decays or frequency responses.");
        return;
    }
    let scene = Scene { document, explained: &opened.derived.explained };
    let mut look = opened.view.explain.clone();
    let before = look.clone();
    let Some(shown) = Shown::new(ui, &scene, &before, asks) else { return };
    let previewed = shown.tried().unwrap_or(shown.comparison);
    let grid = look.grid(previewed);
    let scale = Scale::new(scene.explained.ledger.least_floor(), scene.explained.ledger.worst());
    let outcome = opened.derived.known_outcome(document).and_then(Result::ok);
    let untaken = said_of_untaken(&scene, outcome.as_deref()).filter(|_| shown.trial.is_none());
    // In a low pane the errors, which stand above and below it too, leave their line to the cells and their scale.
    let beside = if untaken.is_some() { CRAMPED } else { SENTENCE + map::height(&grid, map::LEAST) + LEGEND };
    let is_low = ui.available_height() < beside && look.in_bar[0];
    let line = (!is_low).then(|| head(ui, &mut look, previewed));
    if let Some(said) = untaken {
        not_taken_over(ui, said, is_low, asks);
    }
    if let Some((source, tried)) = shown.trial {
        preview(ui, &scene, source, shown.comparison, tried.map(Arc::as_ref), asks);
    }
    let records = p.runs.is_empty();
    let run = opened.view.run.min(if records { p.transient_runs.len() } else { p.runs.len() }.saturating_sub(1));
    let name = if records { look.record.clone() } else { samples::selected(p, run, opened.view.channel) };
    let selected = if grid.channels[0] == ENERGY { Some(ENERGY) } else { name.as_deref() };
    let selected = selected.map(|channel| (run, channel));
    if is_low {
        ui.spacing_mut().item_spacing.y = 0.0;
    }
    let map = Map { project: p, grid: &grid, scale, selected, stale: shown.stale, line };
    // The cells come first: what is left over is said in a line of its own where they are high enough beside it.
    let (room, said) = (ui.available_height() - if is_low { LOW_LEGEND } else { LEGEND }, left_over(previewed));
    let with_words = room - SENTENCE >= map::height(&grid, LOW);
    let clicked = map.show(ui, if with_words { room - SENTENCE } else { room });
    ui.add_space(if is_low { 1.0 } else { space::XS });
    let legend = map::legend(ui, &scale);
    if with_words {
        ui.add(Label::new(RichText::new(tr(said)).size(size::SMALL).color(ui.palette().weak)).truncate());
    } else if !said.is_empty() {
        legend.on_hover_text(tr(said));
    }
    let worst = || grid.runs.first().zip(grid.channels.first()).map(|(run, channel)| (*run, channel.clone()));
    let first = !before.chosen && before.worst_first && opened.view.run == 0;
    look.chosen = true;
    if let Some((run, channel)) = clicked.or_else(|| worst().filter(|_| first)) {
        opened.view.channel = samples::index(p, run, &channel).unwrap_or(opened.view.channel);
        opened.view.run = run;
        look.record = Some(channel);
    }
    opened.view.explain = look;
}

/// Height of the pane below which lines of words give way to the map, points.
const CRAMPED: f32 = 170.0;
/// Height of the legend of the map, and of the sentence under it, points.
const LEGEND: f32 = 40.0;
const LOW_LEGEND: f32 = 29.0;
const SENTENCE: f32 = 22.0;
/// Least height of cells beside which the sentence has room, points.
const LOW: f32 = 14.0;

/// How many times the noise floor an error may be that is no more than noise.
const AT_FLOOR: f64 = 1.2;

/// `frequency, level and place`.
fn listed(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

/// Whether what is left over depends on anything, in one sentence.
fn left_over(comparison: &Comparison) -> String {
    /// Probability below which noise alone is not believed.
    const RARE: f64 = 0.01;
    let on: Vec<&str> = comparison.whiteness.iter().filter(|w| w.probability < RARE).map(|w| w.of.word()).collect();
    // An error at the floor is explained, even where many runs make a faint trend in it certain.
    let faint = comparison.error <= AT_FLOOR * comparison.noise_floor;
    match &on[..] {
        _ if comparison.whiteness.is_empty() => String::new(),
        [] => "What is left looks like noise: it depends on nothing.".to_owned(),
        _ if faint => format!("What is left is as small as the noise; a faint trend with {} is in it.", listed(&on)),
        on => format!("What is left depends on {}: it is not noise.", listed(on)),
    }
}

/// Measured against model in the selected cell.
pub(crate) fn cell(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let document = opened.document;
    let p = &document.project;
    let scene = Scene { document, explained: &opened.derived.explained };
    let mut look = opened.view.explain.clone();
    let before = look.clone();
    let Some(shown) = Shown::new(ui, &scene, &before, asks) else { return };
    if shown.comparison.runs.iter().all(|r| r.channels.is_empty()) {
        ui.empty("Energies only", "Points have no model of mass and stiffness: the energy of each run is compared.");
        return;
    }
    if p.runs.is_empty() {
        record::show(ui, &scene, &mut look, opened.view.run);
        opened.view.explain = look;
        return;
    }
    let run = opened.view.run.min(p.runs.len().saturating_sub(1));
    let Some(name) = samples::selected(p, run, opened.view.channel) else {
        ui.empty("No motion", "The selected run measures forces only.");
        return;
    };
    let good = |found: Option<&Cached<Vec<Curve>>>| found.and_then(|c| c.as_ref().ok()).map(Arc::clone);
    let own = good(scene.explained.curve(document, run));
    let other = shown.trial.and_then(|(t, _)| good(scene.explained.trial_curve(document, t, run)));
    let detail = Detail {
        project: p,
        comparison: shown.comparison,
        trial: shown.tried().map(Arc::as_ref),
        run,
        channel: &name,
        curves: own.as_deref().map_or(&[][..], Vec::as_slice),
        trial_curves: other.as_deref().map_or(&[][..], Vec::as_slice),
    };
    detail.show(ui, &mut look);
    opened.view.explain = look;
}

/// What is missing?
pub(crate) fn missing(ui: &mut Ui, opened: &mut Opened<'_>, asks: &mut Vec<Ask>) {
    let document = opened.document;
    let mut look = opened.view.explain.clone();
    cards::show(ui, &Scene { document, explained: &opened.derived.explained }, &mut look, opened.view.limit_s, asks);
    opened.view.explain = look;
}

/// The way so far.
pub(crate) fn way(ui: &mut Ui, opened: &Opened<'_>, asks: &mut Vec<Ask>) {
    let document = opened.document;
    ledger::show(ui, &Scene { document, explained: &opened.derived.explained }, asks);
}

/// Title and order of the map; gives back where the title stands.
fn head(ui: &mut Ui, look: &mut Look, comparison: &Comparison) -> Rect {
    let energy = if comparison.energy_error.is_finite() {
        format!(", energy error {}", in_words(comparison.energy_error))
    } else {
        String::new()
    };
    let text = format!("error {}{energy}; cells in %", in_words(comparison.error));
    let words = Label::new(RichText::new(tr(&text)).size(size::SMALL).color(ui.palette().weak)).truncate();
    if look.in_bar[0] {
        return ui.add(words).rect;
    }
    let beside = |ui: &mut Ui| {
        super::switches::order(ui, look);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.add(words).rect).inner
    };
    ui.horizontal(|ui| ui.with_layout(Layout::right_to_left(Align::Center), beside).inner).inner
}

/// That what was identified does not act in the model yet, where that is so.
fn said_of_untaken(scene: &Scene<'_>, outcome: Option<&Outcome>) -> Option<&'static str> {
    let sources = &scene.document.project.sources;
    let sought = |s: &Source| s.state.is_sought();
    let found = |e: &Estimate| e.coefficient > 0.0 && sources.get(e.source).is_some_and(sought);
    if !outcome.is_some_and(|o| o.sources.iter().any(found)) {
        return None;
    }
    let known = sources.iter().any(|s| s.state == State::Known);
    Some(if known { "The identified sources are not in the model yet." } else { "The model has no damping yet." })
}

/// The same with the button that takes it over; in a low pane the button alone, which tells it under the pointer.
fn not_taken_over(ui: &mut Ui, said: &str, is_low: bool, asks: &mut Vec<Ask>) {
    ui.horizontal_wrapped(|ui| {
        if !is_low {
            ui.label(RichText::new(tr(said)).color(ui.palette().warning))
                .on_hover_text(t!("Only known sources act in the model."));
        }
        let tip = "Makes the identified sources known at their values.";
        let tip = if is_low { format!("{}\n{}", tr(said), tr(tip)) } else { tr(tip) };
        if ui.button(t!("Add the identified sources")).on_hover_text(tip).clicked() {
            asks.push(Ask::Explain(Request::TakeOver));
        }
    });
}

/// The line that says that what is shown is not so.
fn preview(
    ui: &mut Ui,
    scene: &Scene<'_>,
    source: &Source,
    now: &Comparison,
    tried: Option<&Comparison>,
    asks: &mut Vec<Ask>,
) {
    ui.horizontal(|ui| {
        let name = card::name(scene, source);
        ui.pill("Preview", ui.palette().missing);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button(t!("End preview")).clicked() {
                asks.push(Ask::Explain(Request::Stop));
            }
            let text = match (tried, scene.explained.trial(scene.document, source)) {
                (Some(tried), _) => {
                    let (before, after) = (in_words(now.error), in_words(tried.error));
                    format!("{name}: error {after} instead of {before}")
                }
                (None, Some(Err(error))) => error.clone(),
                (None, _) => format!("{name} is being tried"),
            };
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(Label::new(tr(text.as_str())).truncate()).on_hover_text(tr(text));
            });
        });
    });
}
