//! Units of display: chosen once, seen in tables, plots and fields; what is edited goes back into the file in SI units.

use crate::support::{beam, open, settle};
use dashpot::display::units::{self, Acceleration, Damping, Force, Frequency, Length, Units};
use dashpot::window::frame::panes::Pane;
use dashpot::window::view::Stage;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

#[test]
fn other_units_everywhere() {
    let sample = beam();
    let before = std::fs::read_to_string(&sample.path).unwrap();
    let mut harness = open(&sample, Theme::Light);
    // A menu of the bar, then one of its own entries.
    harness.get_by_role_and_label(Role::Button, "View").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, "Units").click();
    harness.run_steps(3);
    harness.get_by_label("in").click();
    harness.run_steps(3);
    assert_eq!(units::now().length, Length::Inch);
    units::choose(Units {
        length: Length::Millimetre,
        acceleration: Acceleration::FreeFall,
        force: Force::Newton,
        frequency: Frequency::Hertz,
        damping: Damping::Quality,
    });
    harness.key_press(egui::Key::Escape);
    harness.key_press(egui::Key::Escape);
    harness.state_mut().view.stage = Stage::Result;
    harness.state_mut().desk.set_open(Stage::Result, Pane::Damping, true);
    settle(&mut harness);
    harness.get_by_label("Quality factor Q");
    harness.state_mut().desk.set_open(Stage::Result, Pane::Values, true);
    harness.state_mut().desk.set_open(Stage::Result, Pane::Bode, true);
    settle(&mut harness);
    // 0.3 N s/m are 0.0003 N s/mm.
    assert!(harness.query_all_by_label_contains("e−4 N·s/mm").count() >= 2);
    harness.remove_cursor();
    settle(&mut harness);
    harness.snapshot("units");
    units::choose(Units::default());
    assert_eq!(std::fs::read_to_string(&sample.path).unwrap(), before);
}
