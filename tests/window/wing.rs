//! A swept wing of 3 x 9 nodes, clamped at its root, as imported matrices with nodes and lines: the structure in space.

use crate::support::{Sample, write};
use dashpot::effects::{Effect, Place, Source};
use dashpot::structure::imported::{ImportedDof, ImportedParameters};
use dashpot::structure::{Direction, Node};
use faer::Mat;
use std::fmt::Write as _;

const SPAN: usize = 9;
const CHORD: usize = 3;

/// Row of a node's DOF; the root has none.
fn row(i: usize, j: usize) -> Option<usize> {
    (i > 0).then(|| (i - 1) * CHORD + j)
}

fn label(i: usize, j: usize) -> String {
    (i * CHORD + j + 1).to_string()
}

/// Adds `k (sum c u)^2 / 2` to the strain energy.
fn add(stiffness: &mut Mat<f64>, k: f64, terms: &[((usize, usize), f64)]) {
    for &((i, j), a) in terms {
        for &((m, n), b) in terms {
            if let (Some(r), Some(s)) = (row(i, j), row(m, n)) {
                stiffness[(r, s)] += k * a * b;
            }
        }
    }
}

fn parameters() -> ImportedParameters {
    let n = (SPAN - 1) * CHORD;
    let mut stiffness = Mat::<f64>::zeros(n, n);
    for j in 0..CHORD {
        add(&mut stiffness, 4e4, &[((1, j), 1.0)]);
        for i in 1..SPAN - 1 {
            let k = 2e4 * (1.0 - 0.07 * i as f64);
            add(&mut stiffness, k, &[((i - 1, j), 1.0), ((i, j), -2.0), ((i + 1, j), 1.0)]);
        }
    }
    for i in 1..SPAN {
        add(&mut stiffness, 5e4, &[((i, 0), 1.0), ((i, 1), -2.0), ((i, 2), 1.0)]);
        if i + 1 < SPAN {
            add(&mut stiffness, 3e3, &[((i, 0), 1.0), ((i, 2), -1.0), ((i + 1, 0), -1.0), ((i + 1, 2), 1.0)]);
        }
    }
    let mass = Mat::from_fn(n, n, |r, s| if r == s { 0.9 * (1.0 - 0.08 * (r / CHORD + 1) as f64) } else { 0.0 });
    let every = || (0..SPAN).flat_map(|i| (0..CHORD).map(move |j| (i, j)));
    let place = |(i, j): (usize, usize)| {
        let (y, c) = (i as f64, j as f64);
        Node { label: label(i, j), position: [0.35 * c * (1.0 - 0.05 * y) + 0.18 * y, 0.30 * y, 0.04 * c * (2.0 - c)] }
    };
    let dof = |(i, j): (usize, usize)| ImportedDof {
        label: format!("{}z", label(i, j)),
        node: label(i, j),
        direction: Direction::Z,
    };
    let mut lines = Vec::new();
    for (i, j) in every() {
        if j + 1 < CHORD {
            lines.push([label(i, j), label(i, j + 1)]);
        }
        if i + 1 < SPAN {
            lines.push([label(i, j), label(i + 1, j)]);
        }
    }
    ImportedParameters {
        mass,
        stiffness,
        nodes: Some(every().map(place).collect()),
        dofs: Some(every().filter(|(i, _)| *i > 0).map(dof).collect()),
        lines,
    }
}

fn table(matrix: &Mat<f64>) -> String {
    let line = |r: usize| (0..matrix.ncols()).map(|c| format!("{:?}", matrix[(r, c)])).collect::<Vec<_>>().join(",");
    (0..matrix.nrows()).map(|r| line(r) + "\n").collect()
}

/// The wing with dashpots at the tip, at an engine and across the chord, excited at the tip.
pub(crate) fn wing() -> Sample {
    let p = parameters();
    let structure = p.build(&[]).unwrap();
    let dof = |i: usize, j: usize| row(i, j).unwrap();
    let dashpot = |dofs: Vec<usize>, c: f64| Source::known(Effect::Viscous, Place::Dofs(dofs), &[c]);
    let truth =
        [dashpot(vec![dof(8, 2)], 3.0), dashpot(vec![dof(4, 0)], 8.0), dashpot(vec![dof(6, 0), dof(6, 2)], 5.0)];
    let across = [dof(6, 0), dof(6, 2)].map(|d| structure.label(d).to_owned());
    let head = format!(
        "[project]\nformat = 1\ntitle = \"Test wing\"\n[structure]\nkind = \"matrices\"\nmass = \"m.csv\"\n\
         stiffness = \"k.csv\"\nnodes = \"nodes.csv\"\ndofs = \"dofs.csv\"\nlines = \"lines.csv\"\n\
         [[source]]\nlaw = \"viscous\"\ndofs = [\"{}\", \"{}\"]\nstate = \"candidate\"\n\
         [[source]]\nlaw = \"viscous\"\ndofs = [\"{}\"]\nstate = \"candidate\"\n\
         [[source]]\nlaw = \"viscous\"\ndofs = [\"{}\"]\nstate = \"candidate\"\n",
        across[0],
        across[1],
        structure.label(dof(8, 2)),
        structure.label(dof(4, 0))
    );
    let sensors = [dof(8, 2), dof(8, 0), dof(5, 1), dof(6, 0), dof(6, 2), dof(4, 0)];
    let sample = write(&head, &structure, &truth, dof(8, 2), &sensors);
    let mut nodes = "node,x,y,z\n".to_owned();
    for node in p.nodes.iter().flatten() {
        let [x, y, z] = node.position;
        writeln!(nodes, "{},{x},{y},{z}", node.label).unwrap();
    }
    let mut dofs = "dof,node,direction\n".to_owned();
    for dof in p.dofs.iter().flatten() {
        writeln!(dofs, "{},{},z", dof.label, dof.node).unwrap();
    }
    let mut lines = "node,node\n".to_owned();
    for [a, b] in &p.lines {
        writeln!(lines, "{a},{b}").unwrap();
    }
    let folder = sample.path.parent().unwrap();
    for (name, text) in [
        ("m.csv", table(&p.mass)),
        ("k.csv", table(&p.stiffness)),
        ("nodes.csv", nodes),
        ("dofs.csv", dofs),
        ("lines.csv", lines),
    ] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    sample
}
