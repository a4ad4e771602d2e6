//! Documents to work on.

use dashpot::exchange::project::ProjectFile;
use dashpot::session::{Document, Session};
use std::path::Path;

pub(crate) const BEAM: &str = r#"
[project]
format = 1
title = "Beam"

[structure]
kind = "beam"
length = 0.56
breadth = 0.04
depth = 0.004
youngs_modulus = 69e9
density = 2700.0
elements = 4
supports = "clamped-free"

[[source]]
law = "viscous"
dofs = [3]
state = "known"
c = 0.2

[[run]]
file = "run-01.csv"
frequency = 10.0
"#;

pub(crate) fn file() -> ProjectFile {
    ProjectFile::parse(BEAM, "project.toml").unwrap().0
}

pub(crate) fn session() -> Session {
    Session::new(Document::new(file(), Path::new("")).unwrap())
}
