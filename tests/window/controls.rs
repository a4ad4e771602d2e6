//! Every control of every stage has a name for screen readers.

use crate::friction::friction;
use crate::support::{open, settle, start};
use dashpot::window::App;
use dashpot::window::view::Stage;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};

/// Controls without a name, each with its place on the screen.
fn nameless(harness: &Harness<'_, App>) -> Vec<String> {
    const CONTROLS: [Role; 11] = [
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
        Role::Image,
    ];
    let control = |node: &egui_kittest::Node<'_>| CONTROLS.contains(&node.accesskit_node().role());
    let named = |node: &egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        node.label().is_some_and(|l| !l.trim().is_empty()) || node.labelled_by().next().is_some()
    };
    let all = harness.root().children_recursive().filter(|n| control(n) && !named(n));
    all.map(|n| format!("{:?} at {:?}", n.accesskit_node().role(), n.rect())).collect()
}

#[test]
fn no_control_is_without_a_name() {
    let mut found = nameless(&start());
    let sample = friction();
    let mut harness = open(&sample, Theme::Light);
    for stage in Stage::ALL {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        found.extend(nameless(&harness).into_iter().map(|n| format!("{}: {n}", stage.label())));
    }
    let count = harness.get_all_by_role(Role::Button).count();
    assert!(count > 10, "the tree was walked: {count} buttons");
    assert!(found.is_empty(), "controls without a name:\n{}", found.join("\n"));
}
