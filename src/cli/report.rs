//! `dashpot report`: all results of a project with their plots in one HTML or PDF file.

use super::arguments::Report;
use crate::control::Control;
use crate::report;
use crate::session::workers::Threads;
use std::sync::Arc;

pub(super) fn run(arguments: &Report) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let written = report::report(&arguments.file, &arguments.out, &control).map_err(anyhow::Error::msg)?;
    eprintln!("{written}");
    Ok(String::new())
}
