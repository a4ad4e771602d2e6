//! Matrix Market, symmetric coordinate: lower triangle, one-based, the shortest numbers that read back the same.

use super::files::{Export, beside};
use super::identified::Identified;
use faer::Mat;
use std::path::Path;

pub(super) fn export(identified: &Identified, path: &Path) -> Export {
    let mut export = Export::default();
    export.add(path.to_owned(), matrix(identified.viscous, "viscous damping matrix, N s/m", identified));
    let equivalent = "viscous matrix of equal energy over all runs, N s/m";
    export.add(beside(path, "equivalent"), matrix(identified.equivalent, equivalent, identified));
    for (effect, values) in identified.others {
        let what = format!("coefficients of {}, {}", effect.title(), super::dashpots::coefficient_unit(*effect));
        export.add(beside(path, effect.name()), matrix(values, &what, identified));
    }
    export
}

fn matrix(values: &Mat<f64>, what: &str, identified: &Identified) -> String {
    let n = values.nrows();
    let labels: Vec<&str> = identified.structure.dofs().iter().map(|dof| dof.label.as_str()).collect();
    let entries: Vec<String> = (0..n)
        .flat_map(|j| (j..n).map(move |i| (i, j)))
        .filter(|&(i, j)| values[(i, j)] != 0.0)
        .map(|(i, j)| format!("{} {} {}\n", i + 1, j + 1, values[(i, j)]))
        .collect();
    let title = identified.title.replace(['\n', '\r'], " ");
    format!(
        "%%MatrixMarket matrix coordinate real symmetric\n% {title}: {what}\n% rows are the DOFs {}\n{n} {n} {}\n{}",
        labels.join(" ").replace(['\n', '\r'], " "),
        entries.len(),
        entries.concat()
    )
}
