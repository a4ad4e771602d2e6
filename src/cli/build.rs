//! `dashpot build`: a structure of a known kind, written as the files of a `matrices` project.

use super::arguments::{Build, Buildable};
use crate::exchange::matrices::write_tables;
use crate::structure::wing::WingParameters;
use anyhow::Context;
use std::fs;

pub(super) fn run(arguments: &Build) -> anyhow::Result<String> {
    let tables = match arguments.kind {
        Buildable::Wing => WingParameters::goland().tables()?,
    };
    let folder = &arguments.out;
    let context = || folder.display().to_string();
    fs::create_dir_all(folder).with_context(context)?;
    let files = write_tables(&tables, folder).with_context(context)?;
    let names: Vec<String> = files.iter().map(|name| folder.join(name).display().to_string()).collect();
    Ok(format!(
        "{} DOFs, {} lines\n{}\n\n[structure]\nkind = \"matrices\"\nmass = \"mass.mtx\"\nstiffness = \"stiffness.mtx\"\n\
         nodes = \"nodes.csv\"\ndofs = \"dofs.csv\"\nlines = \"lines.csv\"\n",
        tables.mass.nrows(),
        tables.lines.len(),
        names.join("\n")
    ))
}
