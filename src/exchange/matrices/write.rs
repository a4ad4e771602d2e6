//! Writes a structure as the files that `kind = "matrices"` reads: `mass.mtx`, `stiffness.mtx`, `nodes.csv`, `dofs.csv`,
//! `lines.csv`.

use crate::exchange::atomic::write_atomically;
use crate::math::numerals::rounded;
use crate::structure::imported::ImportedParameters;
use faer::Mat;
use std::io;
use std::path::Path;

/// Part of the largest entry below which an entry is rounding and is left out.
const ROUNDING: f64 = 1e-14;
/// Significant digits of an entry or a coordinate: beyond what any structure is known to, and the same on every machine.
const DIGITS: usize = 12;

/// Writes the files into `folder`, which must exist; gives their names.
///
/// # Errors
/// Whatever the file system says.
pub fn write_tables(structure: &ImportedParameters, folder: &Path) -> io::Result<Vec<&'static str>> {
    let mut files = vec![
        ("mass.mtx", market(&structure.mass, "mass matrix, kg")),
        ("stiffness.mtx", market(&structure.stiffness, "stiffness matrix, N/m")),
    ];
    if let Some(nodes) = &structure.nodes {
        let row = |n: &crate::structure::Node| {
            let [x, y, z] = n.position.map(|x| rounded(x, DIGITS));
            format!("{},{x},{y},{z}\n", n.label)
        };
        files.push(("nodes.csv", format!("node,x,y,z\n{}", nodes.iter().map(row).collect::<String>())));
    }
    if let Some(dofs) = &structure.dofs {
        let rows =
            dofs.iter().map(|d| format!("{},{},{}\n", d.label, d.node, format!("{:?}", d.direction).to_lowercase()));
        files.push(("dofs.csv", format!("dof,node,direction\n{}", rows.collect::<String>())));
    }
    let lines = structure.lines.iter().map(|[a, b]| format!("{a},{b}\n"));
    files.push(("lines.csv", format!("node,node\n{}", lines.collect::<String>())));
    for (name, text) in &files {
        write_atomically(&folder.join(name), text.as_bytes())?;
    }
    Ok(files.into_iter().map(|(name, _)| name).collect())
}

/// Matrix Market, symmetric coordinate.
fn market(matrix: &Mat<f64>, what: &str) -> String {
    let n = matrix.nrows();
    let least = ROUNDING * matrix.norm_max();
    let entries: Vec<String> = (0..n)
        .flat_map(|j| (j..n).map(move |i| (i, j)))
        .filter(|&(i, j)| matrix[(i, j)].abs() > least)
        .map(|(i, j)| format!("{} {} {}\n", i + 1, j + 1, rounded(matrix[(i, j)], DIGITS)))
        .collect();
    let head = format!("%%MatrixMarket matrix coordinate real symmetric\n% {what}\n{n} {n} {}\n", entries.len());
    head + &entries.concat()
}
