//! What is missing? The verdict, the ranked suggestions as cards, and what the user has ruled out.

use super::look::Look;
use super::ranking::{open, ranked};
use super::request::Request;
use super::scene::Scene;
use super::{card, channels, force, limit, runs};
use crate::diagnosis::Diagnosis;
use crate::diagnosis::result::Verdict;
use crate::diagnosis::updating::parameters::UpdatingParameter;
use crate::display::findings::{self, is_detuned, is_stuck, sentence_of};
use crate::display::format::in_words;
use crate::display::{format, words};
use crate::effects::Source;
use crate::session::corrections::{self, Adopted};
use crate::session::validation::only_records;
use crate::window::app::Ask;
use crate::window::appearance::theme::{self, size, space};
use crate::window::appearance::widgets::UiExt;
use crate::window::explained::{Standing, WITHOUT_DAMPING};
use crate::window::language::{t, tr};
use egui::{Align, Button, Layout, RichText, ScrollArea, Sense, Ui, vec2};

/// Corrections that are told here; all of them have a pane of their own.
const MOST_CORRECTIONS: usize = 4;

/// Shows the pane.
pub(super) fn show(ui: &mut Ui, scene: &Scene<'_>, look: &mut Look, limit_s: Option<f64>, asks: &mut Vec<Ask>) {
    if scene.document.project.runs.is_empty() && !only_records(&scene.document.project) {
        ui.empty("Nothing to compare with", "Import measurements: runs, decays or frequency responses.");
        return;
    }
    match scene.explained.diagnosis(scene.document) {
        None if scene.explained.is_cancelled(scene.document) => {
            ui.horizontal(|ui| {
                ui.label(t!("The search was cancelled."));
                if ui.button(t!("Search again")).clicked() {
                    asks.push(Ask::Explain(Request::Retry));
                }
            });
            so_far(ui, scene, look, asks);
        }
        None if super::scene::is_undamped(scene.document) && !look.anyway => {
            ui.title("The model has no damping yet", "");
            ui.label(t!("Its sources are candidates: identified, but not acting, so that its errors say nothing of what is missing."));
            ui.add_space(space::XS);
            ui.hint("Once they are known they act, and it is searched for what they do not explain.");
            ui.add_space(space::XS);
            waiting(ui, true, asks);
        }
        None if far_off(scene) && !look.anyway => {
            ui.label(t!(
                "The model is wrong by > 1000 %: at these frequencies hardly anything in it takes out energy."
            ));
            ui.hint("Give it the damping that is known, or add the identified sources; then its errors say something.");
            waiting(ui, false, asks);
        }
        None => searching(ui, scene, look, limit_s, asks),
        Some(Err(error)) => {
            ui.colored_label(ui.palette().error, tr(error));
            if ui.button(t!("Search again")).clicked() {
                asks.push(Ask::Explain(Request::Retry));
            }
        }
        Some(Ok(diagnosis)) => {
            ScrollArea::vertical().id_salt("cards").auto_shrink(false).show(ui, |ui| {
                answer(ui, scene, diagnosis, look, asks);
                limit::setting(ui, limit_s, asks);
            });
        }
    }
}

/// Ways on where the search waits.
fn waiting(ui: &mut Ui, identified: bool, asks: &mut Vec<Ask>) {
    ui.horizontal_wrapped(|ui| {
        let tip = "Makes the identified sources known at their values, and searches for what is missing beside them.";
        if identified && ui.primary("Add them and search").on_hover_text(tr(tip)).clicked() {
            asks.push(Ask::Explain(Request::TakeOver));
        }
        if ui.button(t!("Search anyway")).clicked() {
            asks.push(Ask::Explain(Request::Search));
        }
    });
}

/// The search goes on: what it does, then the cards that there are so far.
fn searching(ui: &mut Ui, scene: &Scene<'_>, look: &mut Look, limit_s: Option<f64>, asks: &mut Vec<Ask>) {
    let (found, standing) = scene.explained.suggestions(scene.document);
    let doing = match standing {
        Standing::Before => "It is searched for what else it could be.",
        _ if found.is_empty() => "Every effect is tried at every place.",
        _ => "The best so far are being fitted to the end.",
    };
    ui.horizontal(|ui| {
        ui.spinner();
        ui.label(tr(doing));
    });
    if found.is_empty() {
        ui.hint("Place before law: where does a free force explain the difference? Then: which law does it follow?");
    }
    limit::while_searching(ui, limit_s, asks);
    so_far(ui, scene, look, asks);
}

/// The cards that there are before a search has ended: what it has told, or what was left of the search before.
fn so_far(ui: &mut Ui, scene: &Scene<'_>, look: &mut Look, asks: &mut Vec<Ask>) {
    match scene.explained.suggestions(scene.document) {
        ([], _) => {}
        (_, Standing::Before) => drop(ui.hint("These are the next best of the search before.")),
        _ => drop(ui.hint("Provisional: sizes, errors and probabilities may still change, and the order with them.")),
    }
    ui.add_space(space::XS);
    ScrollArea::vertical().id_salt("cards").auto_shrink(false).show(ui, |ui| list(ui, scene, look, asks));
}

/// Whether the model is so far from the data that it lacks its damping altogether.
fn far_off(scene: &Scene<'_>) -> bool {
    let comparison = scene.explained.comparison(scene.document).and_then(|c| c.as_ref().ok());
    comparison.is_some_and(|c| c.error > WITHOUT_DAMPING)
}

fn answer(ui: &mut Ui, scene: &Scene<'_>, diagnosis: &Diagnosis, look: &mut Look, asks: &mut Vec<Ask>) {
    if !diagnosis.complete {
        limit::best_so_far(ui, asks);
    }
    if let Some(runs) = findings::searched_runs(diagnosis) {
        ui.weak(runs);
    }
    channels::show(ui, diagnosis, asks);
    runs::show(ui, diagnosis, &scene.document.project.runs, asks);
    if matches!(diagnosis.verdict, Verdict::Adequate | Verdict::Detuned) {
        adequate(ui, scene, diagnosis);
    } else {
        let colour = if diagnosis.verdict == Verdict::Missing { ui.palette().missing } else { ui.palette().warning };
        ui.label(RichText::new(tr(sentence_of(diagnosis, stated(scene, diagnosis)))).color(colour));
    }
    detuned(ui, scene, diagnosis, asks);
    if matches!(diagnosis.verdict, Verdict::Undecided | Verdict::Unexplained) {
        next_tests(ui, scene, diagnosis);
    }
    if diagnosis.verdict == Verdict::Unexplained && diagnosis.suggestions.is_empty() {
        force::show(ui, scene, None);
    }
    ui.add_space(space::XS);
    list(ui, scene, look, asks);
}

/// Error of the model as it is and its noise floor: those that stand elsewhere on the screen, for a search predicts with other numbers
/// of harmonics.
fn stated(scene: &Scene<'_>, diagnosis: &Diagnosis) -> [f64; 2] {
    let compared = scene.explained.comparison(scene.document).and_then(|c| c.as_ref().ok());
    compared.map_or([diagnosis.error_before, diagnosis.noise_floor], |c| [c.error, c.noise_floor])
}

/// What is ruled out, then one card for every other suggestion.
fn list(ui: &mut Ui, scene: &Scene<'_>, look: &mut Look, asks: &mut Vec<Ask>) {
    let (list, standing) = ranked(scene.document, scene.explained);
    let ruled_out = scene.document.session().document().ruled_out();
    excluded(ui, scene, ruled_out, asks);
    let chosen = open(scene.document, scene.explained, look).map(|(s, _)| s.added.source.clone());
    for (rank, (suggestion, probability)) in list.iter().enumerate() {
        let source = &suggestion.added.source;
        let unfolded = chosen.as_ref().is_some_and(|c| c.is_same(source));
        let card = card::Card { scene, suggestion, probability: *probability, rank: rank + 1, unfolded, standing };
        if card.show(ui, look.trial.as_ref().is_some_and(|t| t.is_same(source)), asks) {
            look.open = Some(source.clone());
        }
        ui.add_space(space::XS);
    }
    if list.is_empty() && !ruled_out.is_empty() && standing == Standing::Final {
        ui.hint("Beside what is ruled out, nothing that was tried explains the difference.");
    }
}

/// What the model states wrongly and the search corrected beside the effects.
fn detuned(ui: &mut Ui, scene: &Scene<'_>, diagnosis: &Diagnosis, asks: &mut Vec<Ask>) {
    if diagnosis.corrections.is_empty() || is_stuck(diagnosis) {
        return;
    }
    ui.add_space(space::XS);
    ui.title("The model is detuned", "corrected in the search, not yet in the project");
    let told = findings::telling(&diagnosis.corrections, MOST_CORRECTIONS);
    for correction in &told {
        ui.pair(&corrected(scene, &correction.parameter), findings::change(correction));
    }
    let rest = diagnosis.corrections.len() - told.len();
    if rest > 0 {
        ui.hint(format!("{rest} more, less significant: tab Corrections."));
    }
    let adopted = adopted(scene, diagnosis);
    ui.horizontal_wrapped(|ui| {
        let tip = "Multiplies what the project states by these factors. Undo takes it back.";
        let can = !adopted.commands.is_empty();
        if ui.add_enabled(can, Button::new(t!("Correct the model"))).on_hover_text(tr(tip)).clicked() {
            asks.push(Ask::Explain(Request::Correct));
        }
        if !adopted.left.is_empty() {
            let left: Vec<String> = adopted
                .left
                .iter()
                .map(|&k| corrected(scene, &diagnosis.corrections[k].parameter).to_lowercase())
                .collect();
            ui.hint(format!("The project has no number for: {}.", left.join(", ")));
        }
    });
    ui.add_space(space::XS);
}

/// The commands that take the corrections over.
fn adopted(scene: &Scene<'_>, diagnosis: &Diagnosis) -> Adopted {
    let document = scene.document.session().document();
    corrections::adopt_all(&diagnosis.corrections, diagnosis.verdict, &scene.known(), document)
}

/// What a correction corrects.
pub(super) fn corrected(scene: &Scene<'_>, parameter: &UpdatingParameter) -> String {
    findings::corrected(&scene.document.project.structure, &scene.known(), parameter)
}

/// The end of the way: the model explains the data, and what brought it there.
fn adequate(ui: &mut Ui, scene: &Scene<'_>, diagnosis: &Diagnosis) {
    let palette = ui.palette();
    let spread = super::spread(scene.document, scene.explained).filter(|_| is_stuck(diagnosis));
    ui.add_space(space::M);
    ui.horizontal(|ui| {
        if is_stuck(diagnosis) {
            let said = match spread {
                Some(_) => "What is left is scatter from run to run",
                None => "Something is left that nothing here explains",
            };
            ui.label(RichText::new(tr(said)).size(size::HEADING + 2.0).color(palette.warning));
            return;
        }
        let (area, _) = ui.allocate_exact_size(vec2(30.0, 30.0), Sense::hover());
        let c = area.center();
        ui.painter().circle_filled(c, 13.0, palette.good);
        let tick = vec![c + vec2(-5.6, 0.4), c + vec2(-1.6, 4.8), c + vec2(6.0, -4.4)];
        ui.painter().add(egui::Shape::line(tick, theme::bold(palette.pane)));
        let detuned = is_detuned(diagnosis);
        let said = if detuned { "No effect is missing" } else { "The model now explains the data" };
        ui.label(RichText::new(tr(said)).size(size::HEADING + 2.0));
    });
    ui.add_space(space::XS);
    let now = scene.explained.comparison(scene.document).and_then(|c| c.as_ref().ok());
    ui.label(tr(match (&spread, now) {
        (Some(spread), _) => findings::scatter_sentence(diagnosis, spread),
        // The error that stands elsewhere on the screen: a search predicts with other numbers of harmonics.
        (None, Some(now)) if !is_detuned(diagnosis) => findings::explained(now.error, now.noise_floor),
        _ => sentence_of(diagnosis, stated(scene, diagnosis)),
    }));
    let ledger = &scene.explained.ledger;
    let path = ledger.path();
    if path.len() < 2 {
        return;
    }
    ui.add_space(space::M);
    ui.title("Changes so far", "since the project was opened");
    for step in path {
        let step = &ledger.steps()[step];
        ui.pair(&step.label, in_words(step.error));
    }
}

/// The tests that would decide, in words; nothing where nothing is missing.
pub(super) fn next_tests(ui: &mut Ui, scene: &Scene<'_>, diagnosis: &Diagnosis) {
    if matches!(diagnosis.verdict, Verdict::Adequate | Verdict::Detuned) || diagnosis.next_test.is_empty() {
        return;
    }
    let structure = &scene.document.project.structure;
    ui.title("Next test", "the run that would tell most");
    for test in &diagnosis.next_test {
        ui.label(tr(words::capital(&findings::next_test(structure, test))));
        let why = words::capital(&format::polished(test.why.trim_end_matches('.')));
        ui.hint(format!("{why}."));
    }
}

fn excluded(ui: &mut Ui, scene: &Scene<'_>, excluded: &[Source], asks: &mut Vec<Ask>) {
    if excluded.is_empty() {
        return;
    }
    ui.hint("Ruled out by you");
    let structure = &scene.document.project.structure;
    for source in excluded {
        ui.horizontal(|ui| {
            let name = source.phrase(structure);
            ui.label(RichText::new(tr(name)).strikethrough().color(ui.palette().weak));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.button(t!("Take back")).clicked() {
                    asks.push(Ask::Explain(Request::Restore(source.clone())));
                }
            });
        });
    }
    ui.add_space(space::XS);
}
