//! Turning with the mouse and with keys: drag, wheel, double click; arrows, plus, minus and Home where it has the focus.

use super::camera::Camera;
use egui::{EventFilter, Key, Response, Ui, vec2};

/// Points of a drag that one press of an arrow stands for.
const KEY_STEP: f32 = 15.0;

/// Takes over what the mouse and the keys did to a picture; `home` is where a double click leads.
pub(crate) fn turn(ui: &Ui, response: &Response, camera: &mut Camera, home: Camera) {
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if response.dragged() {
        camera.turn(response.drag_delta());
    }
    if response.double_clicked() {
        *camera = home;
    }
    if response.hovered() {
        camera.zoom_by(ui.input(|i| i.smooth_scroll_delta().y));
    }
    if response.has_focus() {
        let filter = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|m| m.set_focus_lock_filter(response.id, filter));
        keys(ui, camera, home);
    }
}

fn keys(ui: &Ui, camera: &mut Camera, home: Camera) {
    let pressed = |key: Key| ui.input(|i| i.num_presses(key)) as f32;
    let x = pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
    let y = pressed(Key::ArrowDown) - pressed(Key::ArrowUp);
    camera.turn(KEY_STEP * vec2(x, y));
    let larger = pressed(Key::Plus) + pressed(Key::Equals) - pressed(Key::Minus);
    camera.zoom_by(60.0 * larger);
    if pressed(Key::Home) > 0.0 {
        *camera = home;
    }
}
