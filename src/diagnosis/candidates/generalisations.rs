//! Where a law explains much but not all: the laws that contain it, or one of its limits, fitted anew at its place. Their
//! own fits may have ended in another local minimum while the model was still far off.

use crate::diagnosis::candidates::start::UnfittedSet;
use crate::diagnosis::residual::data::DiagnosisError;
use crate::diagnosis::selection::fitted_model::FittedModel;
use crate::diagnosis::selection::reference_model::ReferenceModel;
use crate::diagnosis::selection::search::joined;
use crate::effects::Effect;
use std::sync::Arc;

/// Shapes of each law that are tried beside the one that does the same force.
const SHAPES: usize = 1;

impl ReferenceModel<'_> {
    /// The set `best` with each of its effects in turn replaced by laws that it may have been taken for, from their best
    /// shapes against the free force that the rest of `best` leaves at the place, and from where they do the same force; of these laws,
    /// those that are `wanted`.
    pub(crate) fn generalisations(
        &self,
        best: &FittedModel,
        wanted: impl Fn(Effect) -> bool,
    ) -> Result<Vec<FittedModel>, DiagnosisError> {
        let mut fits = Vec::new();
        for source in &best.effects {
            let laws: Vec<Effect> =
                source.effect.generalisations().into_iter().filter(|&effect| wanted(effect)).collect();
            if laws.is_empty() {
                continue;
            }
            let mut others = best.clone();
            others.effects.retain(|e| !e.is_same(source));
            others.starts.clear();
            let mut view = self.view(Some(&others))?;
            let Some(at) = view.screen.spots.iter().position(|spot| spot.place().is_same(&source.place)) else {
                continue;
            };
            self.need(&mut view, &[at])?;
            let (forces, fields) = self.free(&view, &[at]);
            let data = self.at_place(&view, at, &forces[0], &fields);
            let fields = Arc::new(fields);
            let with_force = data.with_force_of(source);
            let law_starts = |effect| {
                let alike = with_force.as_ref().and_then(|data| data.fit_within(effect, f64::INFINITY, data));
                data.starts(effect, SHAPES).into_iter().chain(alike).collect::<Vec<_>>()
            };
            let laws = laws.into_iter().flat_map(law_starts);
            let unfitted = |effect| UnfittedSet {
                effects: joined(&others.effects, &[effect]),
                score: 0.0,
                fields: fields.clone(),
            };
            let unfitted: Vec<UnfittedSet> =
                laws.map(|law| law.source).filter(|source| self.data.allows(source)).map(unfitted).collect();
            fits.extend(self.fit_all(&unfitted)?);
        }
        Ok(fits)
    }
}
