//! Figures on the pages of the report.

use super::page::Page;
use crate::plots::figure::Figure;
use crate::plots::sheet::Sheet;
use crate::plots::style::Palette;

/// Natural frequencies that are listed.
pub(super) const MOST_MODES: usize = 12;

pub(super) fn figure(page: &mut Page, figure: Figure) {
    let title = figure.title.clone();
    sheet(page, &title, vec![figure]);
}

pub(super) fn sheet(page: &mut Page, title: &str, figures: Vec<Figure>) {
    let sheet = Sheet::of(title, figures);
    page.drawing(&sheet.drawing(sheet.paper(), Palette::light()), &sheet.table());
}
