//! A project in another folder: the files it names are named from there.

use super::file::{ProjectFile, RunTable, Shape};
use std::io;
use std::path::{Component, Path, PathBuf};

impl ProjectFile {
    /// The same project for a file in folder `to`, where this one lies in folder `from`.
    ///
    /// # Errors
    /// What the system says where one of the folders does not exist.
    pub fn relocated(&self, from: &Path, to: &Path) -> io::Result<Self> {
        let mut file = self.clone();
        let (from, to) = (canonical(from)?, canonical(to)?);
        if from == to {
            return Ok(file);
        }
        let named = |run: &mut RunTable| {
            let base = run.excitation.as_mut().and_then(|excitation| excitation.file.as_mut());
            if let Some(name) = base {
                *name = renamed(name, &from, &to);
            }
        };
        file.run.iter_mut().for_each(named);
        let records = file.run.iter_mut().map(|run| &mut run.file);
        let names = records.chain(file.harmonics.iter_mut().map(|harmonics| &mut harmonics.file));
        let names = names
            .chain(file.frf.iter_mut().flat_map(|frf| std::iter::once(&mut frf.file).chain(&mut frf.further_files)));
        let names = names.chain(file.modes.iter_mut().map(|modes| &mut modes.file));
        let names = names.chain(&mut file.report.logo);
        names.for_each(|name| *name = renamed(name, &from, &to));
        if let Shape::Matrices(table) = &mut file.structure.shape {
            let optional = [&mut table.nodes, &mut table.dofs, &mut table.lines].into_iter().flatten();
            let names = [&mut table.mass, &mut table.stiffness].into_iter().chain(optional);
            names.for_each(|name| *name = renamed(name, &from, &to));
        }
        Ok(file)
    }
}

/// The folder without links; the empty path is where the program was started.
pub(crate) fn canonical(folder: &Path) -> io::Result<PathBuf> {
    if folder.as_os_str().is_empty() { Path::new(".").canonicalize() } else { folder.canonicalize() }
}

/// Name from folder `to` of a file that is named `name` from folder `from`; both folders absolute. Absolute names stay.
pub(crate) fn renamed(name: &str, from: &Path, to: &Path) -> String {
    if Path::new(name).is_absolute() {
        return name.to_owned();
    }
    let common = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let up = to.components().skip(common).map(|_| Component::ParentDir);
    let path: PathBuf = up.chain(from.components().skip(common)).collect::<PathBuf>().join(name);
    path.display().to_string()
}

#[cfg(test)]
mod tests {
    use super::renamed;
    use std::path::Path;

    #[test]
    fn names_lead_to_the_same_file() {
        let name = |name, from: &str, to: &str| renamed(name, Path::new(from), Path::new(to));
        assert_eq!(name("run.csv", "/a/b", "/a/b"), "run.csv");
        assert_eq!(name("run.csv", "/a/b", "/a"), "b/run.csv");
        assert_eq!(name("run.csv", "/a", "/a/b"), "../run.csv");
        assert_eq!(name("data/run.csv", "/a/b", "/a/c/d"), "../../b/data/run.csv");
        assert_eq!(name("/x/run.csv", "/a", "/b"), "/x/run.csv");
    }
}
