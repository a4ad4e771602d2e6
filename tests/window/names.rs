//! Every control has a name: what a screen reader says, and what a test clicks.

use crate::friction::friction;
use crate::support::{beam, open, settle, start};
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

/// Roles of what can be clicked, dragged or typed into.
pub(crate) const CONTROLS: [Role; 12] = [
    Role::Button,
    Role::CheckBox,
    Role::RadioButton,
    Role::ComboBox,
    Role::Slider,
    Role::SpinButton,
    Role::TextInput,
    Role::MultilineTextInput,
    Role::Tab,
    Role::Link,
    Role::MenuItem,
    Role::ColorWell,
];

/// Controls in sight without a name, each with what is known of it.
fn nameless(harness: &Harness<'_, App>) -> Vec<String> {
    let all = harness.root().children_recursive();
    let without = all.filter_map(|node| {
        let node = node.accesskit_node();
        let named = node.label().is_some_and(|l| !l.trim().is_empty()) || node.labelled_by().next().is_some();
        (CONTROLS.contains(&node.role()) && !named)
            .then(|| format!("{:?} at {:?}, value {:?}", node.role(), node.bounding_box(), node.value()))
    });
    without.collect()
}

fn all_are_named(harness: &Harness<'_, App>, place: &str) {
    let controls =
        harness.root().children_recursive().filter(|n| CONTROLS.contains(&n.accesskit_node().role())).count();
    assert!(controls > 3, "{place}: the walk sees {controls} controls");
    let without = nameless(harness);
    assert!(without.is_empty(), "{place}: {} controls without a name: {without:#?}", without.len());
}

#[test]
fn every_control_of_every_pane_has_a_name() {
    all_are_named(&start(), "start screen");
    let sample = beam();
    let mut harness = open(&sample, Theme::Light);
    for stage in Stage::ALL.into_iter().filter(|s| *s != Stage::Explain) {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        let panes: Vec<Pane> = harness.state().desk.panes(stage).into_iter().map(|(pane, _)| pane).collect();
        for pane in panes {
            harness.state_mut().desk.set_open(stage, pane, true);
            settle(&mut harness);
            all_are_named(&harness, &format!("{stage:?}, {pane:?}"));
        }
    }
    harness.state_mut().view.dof = Some(4);
    harness.run_steps(3);
    all_are_named(&harness, "inspector of a degree of freedom");
}

#[test]
fn every_control_of_explain_has_a_name() {
    let sample = friction();
    let mut harness = open(&sample, Theme::Light);
    harness.get_by_role_and_label(Role::Tab, "Explain").click();
    settle(&mut harness);
    all_are_named(&harness, "Explain");
    harness.state_mut().desk.set_open(Stage::Explain, Pane::Corrections, true);
    settle(&mut harness);
    all_are_named(&harness, "Corrections");
}
