//! The localisation matrix of a source as a small grid: `sum L L^T` over its legs, where `L` takes the relative motion of
//! a leg out of the motions of all DOFs. Multiplied by a coefficient it is what the source adds to the damping matrix.

use crate::effects::place::Leg;
use crate::window::appearance::theme::{self, size};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{tf, tr};
use egui::{Align2, Rect, Role, Sense, Ui, Vec2, WidgetInfo, vec2};

/// Entry of a DOF with itself or with another: row, column, value.
pub(crate) type Entry = (usize, usize, i32);

/// The DOFs of a source in order, and the entries that are not zero, rows and columns counted in that order.
pub(crate) fn matrix(legs: &[Leg]) -> (Vec<usize>, Vec<Entry>) {
    let mut dofs: Vec<usize> = legs.iter().flat_map(|leg| [Some(leg.first), leg.second]).flatten().collect();
    dofs.sort_unstable();
    dofs.dedup();
    let row = |dof: usize| dofs.iter().position(|d| *d == dof).unwrap_or(0);
    let n = dofs.len();
    let mut values = vec![0; n * n];
    for leg in legs {
        let ends: Vec<(usize, i32)> =
            [Some((leg.first, 1)), leg.second.map(|d| (d, -1))].into_iter().flatten().collect();
        for &(a, sign_a) in &ends {
            for &(b, sign_b) in &ends {
                values[row(a) * n + row(b)] += sign_a * sign_b;
            }
        }
    }
    let entries = (0..n * n).filter(|&k| values[k] != 0).map(|k| (k / n, k % n, values[k])).collect();
    (dofs, entries)
}

/// Shows the grid; `label` names a DOF.
pub(crate) fn show(ui: &mut Ui, legs: &[Leg], label: impl Fn(usize) -> String) {
    const CELL: f32 = 26.0;
    const EDGE: f32 = 28.0;
    /// Rows beyond these are left out: the pattern repeats.
    const MOST: usize = 12;
    let palette = ui.palette();
    let (dofs, entries) = matrix(legs);
    let n = dofs.len().min(MOST);
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(EDGE + CELL * n as f32), Sense::hover());
    let words = |e: &Entry| format!("; {} {} {}", label(dofs[e.0]), label(dofs[e.1]), e.2);
    response.widget_info(|| {
        let text = entries.iter().map(words).collect::<String>();
        WidgetInfo::labeled(Role::Image, true, tf!("Localisation matrix{text}"))
    });
    let origin = rect.min + Vec2::splat(EDGE);
    let painter = ui.painter();
    let cell = |r: usize, c: usize| Rect::from_min_size(origin + vec2(c as f32, r as f32) * CELL, Vec2::splat(CELL));
    for (k, dof) in dofs.iter().take(n).enumerate() {
        let (text, font) = (label(*dof), theme::font(size::SMALL));
        let across = cell(0, k).center_top() - vec2(0.0, 4.0);
        painter.text(across, Align2::CENTER_BOTTOM, &text, font.clone(), palette.weak);
        painter.text(cell(k, 0).left_center() - vec2(5.0, 0.0), Align2::RIGHT_CENTER, text, font, palette.weak);
        for j in 0..n {
            painter.rect_filled(cell(k, j).shrink(0.7), 2.0, palette.raised);
        }
    }
    for &(r, c, value) in entries.iter().filter(|(r, c, _)| *r < n && *c < n) {
        let fill = palette.diverging(0.35 * value as f32);
        painter.rect_filled(cell(r, c).shrink(0.7), 2.0, fill);
        let text = value.to_string().replace('-', "−");
        painter.text(
            cell(r, c).center(),
            Align2::CENTER_CENTER,
            tr(text),
            theme::font(size::SMALL),
            palette.text_on(fill),
        );
    }
    if dofs.len() > MOST {
        ui.hint(format!("{} of {} DOFs", MOST, dofs.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::matrix;
    use crate::effects::place::Leg;

    #[test]
    fn a_source_to_the_ground_stands_on_the_diagonal() {
        assert_eq!(matrix(&[Leg { first: 6, second: None }]), (vec![6], vec![(0, 0, 1)]));
    }

    #[test]
    fn a_chain_couples_neighbours_and_every_row_adds_up_to_zero() {
        let (dofs, entries) = matrix(&[Leg { first: 2, second: Some(4) }, Leg { first: 4, second: Some(8) }]);
        assert_eq!(dofs, [2, 4, 8]);
        assert!(
            entries.contains(&(1, 1, 2))
                && entries.contains(&(0, 1, -1))
                && !entries.iter().any(|e| (e.0, e.1) == (0, 2))
        );
        for row in 0..3 {
            assert_eq!(entries.iter().filter(|e| e.0 == row).map(|e| e.2).sum::<i32>(), 0);
        }
    }
}
