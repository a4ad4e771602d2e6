//! The lower left corner of a plot, where numbers of both axes may meet.

use egui::{Id, Ui};
use std::cell::Cell;
use std::ops::RangeInclusive;
use std::rc::Rc;

/// Share of the height of a square plot, above its lower left corner, that belongs to the labels of the axis of x: those of
/// both axes are as long there, and would touch.
const SQUARE: f64 = 0.04;
/// Half the breadth of a letter and half the height of a line, and distance of the numbers of the axis of y from the plot, points.
const HALF_LETTER: f64 = 3.3;
const HALF_LINE: f64 = 8.0;
const ASIDE: f64 = 4.0;

/// The corner of one plot: a number of the axis of x gives way there to one of the axis of y, of which there are fewer; in a square
/// plot that of y gives way.
#[derive(Debug, Clone)]
pub(super) struct AxesCorner {
    id: Id,
    /// Breadth and height of the plot within its axes, points.
    size: [f64; 2],
    /// Whether numbers of y give way.
    gives_way: bool,
    /// Whether one of y stood there when the plot was drawn last: the axis of x is drawn first.
    was_taken: bool,
    is_taken: Rc<Cell<bool>>,
}

impl AxesCorner {
    /// That of the plot of this name.
    pub(super) fn of(ui: &Ui, plot: &str, size: [f32; 2], gives_way: bool) -> Self {
        let id = Id::NULL.with(("corner", plot));
        let was_taken = ui.data(|d| d.get_temp::<bool>(id)).unwrap_or_default();
        Self { id, size: size.map(|v| f64::from(v.max(1.0))), gives_way, was_taken, is_taken: Rc::default() }
    }

    /// A number of the axis of x, if it has room.
    pub(super) fn across(&self, label: String, value: f64, range: &RangeInclusive<f64>) -> String {
        let reach = HALF_LETTER * label.chars().count() as f64 - ASIDE;
        if self.was_taken && share(value, range) * self.size[0] < reach { String::new() } else { label }
    }

    /// A number of the axis of y, if it has room.
    pub(super) fn upwards(&self, label: String, value: f64, range: &RangeInclusive<f64>) -> String {
        let above = share(value, range);
        if self.gives_way && above < SQUARE {
            return String::new();
        }
        let is_there = above * self.size[1] < HALF_LINE && !label.is_empty();
        self.is_taken.set(self.is_taken.get() || is_there);
        label
    }

    /// Remembers what stands there.
    pub(super) fn keep(&self, ui: &Ui) {
        ui.data_mut(|d| d.insert_temp(self.id, self.is_taken.get()));
    }
}

/// A number of an axis of x without a name, with the unit where it is the last that has room for it. Linear axes: `step` is the
/// distance of numbers.
pub(super) fn with_unit(
    label: String,
    unit: &str,
    value: f64,
    step: f64,
    range: &RangeInclusive<f64>,
    breadth: f64,
) -> String {
    if unit.is_empty() || label.is_empty() {
        return label;
    }
    let reach = HALF_LETTER * (label.chars().count() + 1 + unit.chars().count()) as f64;
    let fits = |at: f64| share(at, range) * breadth + reach <= breadth + ASIDE;
    if fits(value) && !fits(value + step) { format!("{label} {unit}") } else { label }
}

/// Place within a range, 0 to 1.
fn share(value: f64, range: &RangeInclusive<f64>) -> f64 {
    (value - range.start()) / (range.end() - range.start())
}

#[cfg(test)]
mod tests {
    use super::{AxesCorner, with_unit};
    use egui::Id;
    use std::rc::Rc;

    fn corner(gives_way: bool, was_taken: bool) -> AxesCorner {
        AxesCorner { id: Id::NULL, size: [500.0, 80.0], gives_way, was_taken, is_taken: Rc::default() }
    }

    #[test]
    fn numbers_of_both_axes_do_not_meet() {
        let (x, y) = (178.0..=189.0, 0.0..=160.0);
        let plain = corner(false, false);
        assert_eq!(plain.across("178".into(), 178.0, &x), "178");
        assert_eq!(plain.upwards("90".into(), 90.0, &y), "90");
        assert!(!plain.is_taken.get());
        assert_eq!(plain.upwards("0".into(), 0.0, &y), "0");
        assert!(plain.is_taken.get());
        let taken = corner(false, true);
        assert_eq!(taken.across("178".into(), 178.0, &x), "");
        assert_eq!(taken.across("179".into(), 179.0, &x), "179");
        // A single figure ends before the numbers of y do.
        assert_eq!(taken.across("0".into(), 178.0, &x), "0");
        let square = corner(true, false);
        assert_eq!(square.upwards("0".into(), 0.0, &y), "");
        assert!(!square.is_taken.get());
    }

    #[test]
    fn the_last_number_with_room_has_the_unit() {
        let range = 11.9..=14.4;
        let shown = |value: f64| with_unit(format!("{value:.1}"), "Hz", value, 0.5, &range, 320.0);
        assert_eq!([12.0, 13.5, 14.0].map(shown), ["12.0", "13.5", "14.0 Hz"]);
        // The last one would be cut: that before it has the unit.
        let range = 11.9..=14.05;
        let shown = |value: f64| with_unit(format!("{value:.1}"), "Hz", value, 0.5, &range, 320.0);
        assert_eq!([13.0, 13.5, 14.0].map(shown), ["13.0", "13.5 Hz", "14.0"]);
        assert_eq!(with_unit("14.0".into(), "", 14.0, 0.5, &range, 320.0), "14.0");
    }
}
