//! What the schematic shows in the stage: the error at every sensor, and the suggested source in its place.

use super::ranking;
use crate::diagnosis::Comparison;
use crate::display::format::in_words;
use crate::effects::{Place, Source, State};
use crate::plots::error_map::Scale;
use crate::structure::Structure;
use crate::window::app::view::View;
use crate::window::document::Document;
use crate::window::explained::Explained;
use crate::window::schematic::Scene;
use crate::window::schematic::model::SceneSource;
use crate::window::schematic::view::SEPARATOR;
use std::sync::Arc;

/// What is laid over the schematic.
pub struct Errors {
    /// The scene with the suggested source.
    pub scene: Arc<Scene>,
    /// Place of the error at every DOF on the scale of colours, 0 to 1.
    pub shares: Option<Vec<f32>>,
    /// What is shown, in one line.
    pub caption: String,
}

/// Errors and suggestion for the schematic.
pub fn errors(scene: &Arc<Scene>, document: &Document, view: &View, explained: &Explained) -> Errors {
    let look = &view.explain;
    let best = ranking::open(document, explained, look);
    let suggested = look.trial.as_ref().or(best.map(|(s, _)| &s.added.source));
    let tried = look.trial.as_ref().and_then(|t| explained.trial(document, t)).and_then(|t| t.as_ref().ok());
    let comparison = tried.or_else(|| explained.comparison(document).and_then(|c| c.as_ref().ok()));
    let shares = comparison
        .map(|c| shares(c, &Scale::new(explained.ledger.least_floor(), explained.ledger.worst()), scene.dofs.len()));
    let mut caption =
        comparison.map_or_else(String::new, |c| format!("Error at the sensors (shaded) {}", in_words(c.error)));
    if let Some(source) = suggested {
        let verb = if look.trial.is_some() { "on trial" } else { "suggested" };
        let error = comparison.map(|c| format!("Error (shaded) {}", in_words(c.error)));
        let told = format!("{verb}: {}", source.phrase(&document.project.structure));
        caption = error.into_iter().chain([told]).collect::<Vec<_>>().join(SEPARATOR);
    }
    let scene =
        suggested.and_then(|s| with(scene, s, &document.project.structure)).map_or_else(|| Arc::clone(scene), Arc::new);
    Errors { scene, shares, caption }
}

/// The scene with one more source, where it acts on DOFs.
fn with(scene: &Scene, source: &Source, structure: &Structure) -> Option<Scene> {
    let Place::Dofs(dofs) = &source.place else { return None };
    let mut scene = scene.clone();
    let (index, effect, dofs) = (usize::MAX, source.effect, dofs.clone());
    let (name, state) = (source.phrase(structure), State::Reference);
    scene.sources.push(SceneSource { index, effect, dofs, state, identified: None, name, suggested: true });
    Some(scene)
}

/// Root mean square of the errors of the channels at every DOF, as places on the scale.
fn shares(comparison: &Comparison, scale: &Scale, count: usize) -> Vec<f32> {
    let mut sums = vec![(0.0, 0.0_f64, 0_usize); count];
    for channel in comparison.runs.iter().filter(|r| r.used).flat_map(|r| &r.channels) {
        if let Some((square, floor, n)) = sums.get_mut(channel.dof) {
            *square += channel.error * channel.error;
            *floor += channel.noise_floor * channel.noise_floor;
            *n += 1;
        }
    }
    let share = |&(square, floor, n): &(f64, f64, usize)| {
        let noise = n == 0 || square <= 2.0 * floor;
        if noise { 0.0 } else { scale.share((square / n as f64).sqrt()) }
    };
    sums.iter().map(share).collect()
}
