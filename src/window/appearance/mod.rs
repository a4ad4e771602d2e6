//! How the window looks: colours and sizes of every widget, the widgets that all panes are made of, whether anything moves.

pub(crate) mod motion;
pub mod theme;
pub(crate) mod widgets;
