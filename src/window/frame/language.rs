//! The menu of languages: chosen once, for all words and the decimal sign on the screen; files and the command line stay English.

use crate::window::appearance::widgets::UiExt;
use crate::window::language::{self, Language};
use egui::Ui;

/// Shows the choices, each by its name in itself.
pub(crate) fn menu(ui: &mut Ui) {
    for language in Language::ALL {
        if ui.radio(language::now() == language, language.name()).clicked() {
            language::choose(language);
            ui.ctx().request_repaint();
            ui.close();
        }
    }
    ui.hint("Files, copied tables and the command line stay English, with the decimal point.");
}
