//! `dashpot report`: all results of a project with their plots in one HTML or PDF file.

use super::arguments_report::Report;
use crate::control::Control;
use crate::exchange::project::file::ReportTable;
use crate::report::{self, Request, Tables};
use crate::session::workers::Threads;
use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

pub(super) fn run(arguments: &Report) -> anyhow::Result<String> {
    let control = Control::unattended().with_workers(Arc::new(Threads));
    let written = report::report(&arguments.file, &request(arguments), &arguments.out, &control);
    eprintln!("{}", written.map_err(anyhow::Error::msg)?);
    Ok(String::new())
}

fn request(arguments: &Report) -> Request {
    let tables = match &arguments.tables {
        Some(path) => Tables::In(path.clone()),
        None if arguments.no_tables => Tables::None,
        None => Tables::Beside,
    };
    Request {
        heading: ReportTable {
            title: arguments.title.clone(),
            object: arguments.object.clone(),
            tester: arguments.tester.clone(),
            organisation: arguments.organisation.clone(),
            logo: arguments.logo.as_ref().map(|path| path.display().to_string()),
        },
        sections: arguments.sections.clone(),
        limit: Some(Duration::from_secs_f64(arguments.limit)),
        tables,
        origin: None,
        made_s: now_s(),
    }
}

/// Seconds since the beginning of 1970 (UTC).
#[expect(clippy::disallowed_methods, reason = "a report bears the date on which it is made; no result depends on it")]
fn now_s() -> Option<f64> {
    SystemTime::now().duration_since(UNIX_EPOCH).ok().map(|since| since.as_secs_f64())
}
