//! Units of display: chosen once, seen in tables, plots and fields; what is edited goes back into the file in SI units.

use crate::support::{beam, open, settle};
use dashpot::display::units::{self, Acceleration, Damping, Force, Frequency, Length, Units};
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui::accesskit::Role;
use egui::epaint::Shape;
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

/// All words that are drawn, axis titles that stand upright among them.
fn drawn(shape: &Shape, all: &mut Vec<String>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|s| drawn(s, all)),
        Shape::Text(text) => all.extend(text.galley.text().lines().map(str::to_owned)),
        _ => {}
    }
}

/// Whether a unit stands alone in words: `Hz` in `12 Hz` and `Frequency, Hz`; `N·s/m` not in `N·s/mm`.
fn says(words: &str, unit: &str) -> bool {
    let letter = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || "·/²³µ".contains(c));
    words.match_indices(unit).any(|(at, _)| {
        let (before, after) = (words[..at].chars().next_back(), words[at + unit.len()..].chars().next());
        !letter(before) && !letter(after)
    })
}

/// One after the other every pane of every stage: what is chosen is shown, and nothing else.
#[test]
fn no_pane_shows_a_unit_that_was_not_chosen() {
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    units::choose(Units {
        length: Length::Inch,
        acceleration: Acceleration::OfLength,
        force: Force::PoundForce,
        frequency: Frequency::RadianPerSecond,
        damping: Damping::Quality,
    });
    let (mut seen, mut wrong) = (0, Vec::new());
    for stage in Stage::ALL {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        let panes: Vec<Pane> = harness.state().desk.panes(stage).into_iter().map(|(pane, _)| pane).collect();
        for pane in panes {
            harness.state_mut().desk.set_open(stage, pane, true);
            settle(&mut harness);
            let mut all = Vec::new();
            harness.output().shapes.iter().for_each(|s| drawn(&s.shape, &mut all));
            seen += all.iter().filter(|w| ["rad/s", "lbf", "in/s²"].iter().any(|unit| says(w, unit))).count();
            for unit in ["Hz", "N·s/m", "N s/m", "m/s²", "mm", "N", "N/m", "ζ", "kN"] {
                let of = all.iter().filter(|words| says(words, unit));
                wrong.extend(of.map(|words| format!("{stage:?}, {pane:?}: {words}")));
            }
        }
    }
    units::choose(Units::default());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen > 50, "{seen} words with the units that were chosen");
}
