//! One model in every format: the same frequency responses, to rounding.

use crate::{refused, said};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Chain of three masses to the ground: entries of the lower triangle, nodes 11, 12 and 13 moving in z.
const STIFFNESS: [(usize, usize, f64); 5] = [(0, 0, 3e4), (1, 0, -1e4), (1, 1, 2.5e4), (2, 1, -1.5e4), (2, 2, 1.5e4)];
const MASS: [(usize, usize, f64); 3] = [(0, 0, 1.0), (1, 1, 1.5), (2, 2, 0.75)];

fn project(structure: &str) -> String {
    format!(
        "[project]\nformat = 1\n[structure]\nkind = \"matrices\"\n{structure}\n[[source]]\nlaw = \"viscous\"\ndofs = [\"12z\"]\nstate = \"known\"\nc = 2.0\n\
         [[run]]\nfile = \"r.csv\"\nfrequency = 11.0\nforce_dof = \"13z\"\nforce_n = 2.0\n"
    )
}

/// The text of the harmonics that the model gives.
fn responses(folder: &Path, structure: &str) -> String {
    fs::write(folder.join("p.toml"), project(structure)).unwrap();
    said(&["simulate", "p.toml", "--out", "out", "--as", "harmonics"], folder);
    fs::read_to_string(folder.join("out/harmonics.csv")).unwrap()
}

fn market(entries: &[(usize, usize, f64)]) -> String {
    let rows: String = entries.iter().map(|(i, j, v)| format!("{} {} {v:e}\n", i + 1, j + 1)).collect();
    format!("%%MatrixMarket matrix coordinate real symmetric\n3 3 {}\n{rows}", entries.len())
}

fn dmig(name: &str, entries: &[(usize, usize, f64)]) -> String {
    let mut text = format!("DMIG,{name},0,6,2,0\n");
    for (i, j, v) in entries {
        let _ = writeln!(text, "{:<8}{name:<16}{:>16}{:>16}", "DMIG*", 11 + j, 3);
        let _ = writeln!(text, "{:<8}{:>16}{:>16}{:>16}", "*", 11 + i, 3, format!("{v:.6e}").replace('e', "D"));
    }
    text
}

fn abaqus(entries: &[(usize, usize, f64)]) -> String {
    entries.iter().map(|(i, j, v)| format!("{}, 3, {}, 3, {v:e}\n", 11 + i, 11 + j)).collect()
}

fn calculix(entries: &[(usize, usize, f64)]) -> String {
    entries.iter().map(|(i, j, v)| format!("{} {} {v:e}\n", j + 1, i + 1)).collect()
}

fn output4(name: &str, entries: &[(usize, usize, f64)]) -> String {
    let mut text = format!("{:>8}{:>8}{:>8}{:>8}{name:<8}1P,3E23.16\n", 3, 3, 6, 2);
    for column in 0..3 {
        let values: Vec<f64> = (0..3)
            .map(|row| {
                let at = (row.max(column), row.min(column));
                entries.iter().find(|(i, j, _)| (*i, *j) == at).map_or(0.0, |(_, _, v)| *v)
            })
            .collect();
        let _ = writeln!(text, "{:>8}{:>8}{:>8}", column + 1, 1, 6);
        let _ = writeln!(text, "{}", values.iter().map(|v| format!("{:>23}", format!("{v:.16E}"))).collect::<String>());
    }
    text + "       4       1       1\n 1.0E+00\n"
}

#[test]
fn every_format_gives_the_same_response() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let dofs = "dof,node,direction\n11z,11,z\n12z,12,z\n13z,13,z\n";
    put("dofs.csv", dofs);
    put("m.mtx", &market(&MASS));
    put("k.mtx", &market(&STIFFNESS));
    let expected = responses(folder.path(), "mass = \"m.mtx\"\nstiffness = \"k.mtx\"\ndofs = \"dofs.csv\"");
    let grids: String = (0..3).map(|k| format!("GRID,{},,{k}.,0.,0.\n", 11 + k)).collect();
    put("model.pch", &format!("{grids}CBAR,1,1,11,12\n{}{}", dmig("MAAX", &MASS), dmig("KAAX", &STIFFNESS)));
    put("job_MASS1.mtx", &abaqus(&MASS));
    put("job_STIF1.mtx", &format!("** stiffness\n*MATRIX INPUT, NAME=K\n{}", abaqus(&STIFFNESS)));
    put("job.mas", &calculix(&MASS));
    put("job.sti", &calculix(&STIFFNESS));
    put("job.dof", "11.3\n12.3\n13.3\n");
    put("job.inp", "*NODE\n11,0,0,0\n12,1,0,0\n13,2,0,0\n*ELEMENT, TYPE=B31\n1,11,12\n2,12,13\n");
    put("model.op4", &(output4("MAA", &MASS) + &output4("KAA", &STIFFNESS)));
    for structure in [
        "mass = \"model.pch\"\nstiffness = \"model.pch\"",
        "mass = \"model.pch\"\nstiffness = \"model.pch\"\nmass_name = \"maax\"\nstiffness_name = \"kaax\"",
        "mass = \"job_MASS1.mtx\"\nstiffness = \"job_STIF1.mtx\"\nnodes = \"job.inp\"",
        "mass = \"job.mas\"\nstiffness = \"job.sti\"",
        "mass = \"model.op4\"\nstiffness = \"model.op4\"\ndofs = \"dofs.csv\"",
    ] {
        assert_eq!(responses(folder.path(), structure), expected, "{structure}");
    }
}

/// The same chain with its grid points moving in a system whose x is the basic z: component 1 of the matrices is z. A component that
/// cannot be turned alone is refused by the name of its grid point.
#[test]
fn grid_points_that_move_in_systems_of_their_own_are_turned() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let along = |name: &str, entries| dmig(name, entries).replace(&format!("{:>16}", 3), &format!("{:>16}", 1));
    let deck = |system: &str| {
        let grids: String = (11..14).map(|id| format!("GRID,{id},,{}.,0.,0.,5\n", id - 10)).collect();
        format!("{system}{grids}{}{}", along("KAAX", &STIFFNESS), along("MAAX", &MASS))
    };
    let own: String = (11..14).map(|id| format!("GRID,{id},,{}.,0.,0.\n", id - 10)).collect();
    let basic = format!("{own}{}{}", dmig("KAAX", &STIFFNESS), dmig("MAAX", &MASS));
    fs::write(at.join("basic.bdf"), basic).unwrap();
    fs::write(at.join("own.bdf"), deck("CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,0.,1.\n")).unwrap();
    let truth = responses(at, "mass = \"basic.bdf\"\nstiffness = \"basic.bdf\"");
    assert_eq!(responses(at, "mass = \"own.bdf\"\nstiffness = \"own.bdf\""), truth);
    // Matrices alone in the punch file, the systems in the model beside it.
    fs::write(at.join("own.pch"), format!("{}{}", along("KAAX", &STIFFNESS), along("MAAX", &MASS))).unwrap();
    let beside = "mass = \"own.pch\"\nstiffness = \"own.pch\"\nnodes = \"own.bdf\"";
    assert_eq!(responses(at, beside), truth);
    fs::write(at.join("askew.bdf"), deck("CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,1.\n")).unwrap();
    fs::write(at.join("p.toml"), project("mass = \"askew.bdf\"\nstiffness = \"askew.bdf\"")).unwrap();
    let line = refused(&["identify", "p.toml"], at);
    assert!(
        line.contains("grid point 1") && line.contains("moves in coordinate system 5, and its components 1 alone"),
        "{line}"
    );
}

/// What the export writes for a grid point that moves askew to x, y and z is read back with the deck as the dashpot that it is.
#[test]
fn damping_is_exported_in_the_directions_of_the_grid_points() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let half = 0.5_f64.sqrt();
    // Directions 1, 2 and 3 of grid point 12: its third is x, its first between y and z.
    let along_z = [half, half, 0.0];
    let mut deck = "CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,1.\nGRID,11,,0.,0.,0.\nGRID,12,,1.,0.,0.,5\n".to_owned();
    for (name, own, coupling) in [("KAAX", 3e4, -1e4), ("MAAX", 1.0, 0.0)] {
        let _ = writeln!(deck, "DMIG,{name},0,6,2,0\nDMIG,{name},11,3,,11,3,{own:.1}");
        for (c, z) in (1..).zip(along_z) {
            let _ = writeln!(deck, "DMIG,{name},12,{c},,12,{c},{own:.1}");
            if coupling * z != 0.0 {
                let _ = writeln!(deck, "DMIG*,{name},11,3,,+\n*+,12,{c},{:.12E}", coupling * z);
            }
        }
    }
    fs::write(at.join("model.bdf"), &deck).unwrap();
    let text = project("mass = \"model.bdf\"\nstiffness = \"model.bdf\"").replace("13z", "11z");
    fs::write(at.join("p.toml"), &text).unwrap();
    said(&["simulate", "p.toml", "--out", "."], at);
    let asked = text.split("force_dof").next().unwrap().replace("state = \"known\"\nc = 2.0", "state = \"forced\"");
    fs::write(at.join("m.toml"), asked).unwrap();
    said(&["export", "m.toml", "--to", "nastran", "--out", "c.bdf"], at);
    let cards = fs::read_to_string(at.join("c.bdf")).unwrap();
    assert!(cards.contains("CBUSH*") && !cards.contains("CDAMP2*"), "{cards}");
    let both = deck + &fs::read_to_string(at.join("c-dmig.bdf")).unwrap();
    let bulk = dashpot_fe_files::nastran::read(&both, "both.bdf").unwrap();
    let damping = bulk.matrices.iter().find(|matrix| matrix.name == "CDAMP").unwrap().clone();
    assert_eq!(damping.dofs.as_ref().map(|dofs| dofs.iter().all(|dof| dof.node == 12)), Some(true));
    let basic = damping.in_basic("both.bdf", &bulk.geometry.turned).unwrap();
    let basic_dof = |i: usize| basic.dofs.as_ref().unwrap()[i];
    for &(i, j, value) in &basic.entries {
        let expected = if i == j && basic_dof(i).component == 3 { 2.0 } else { 0.0 };
        assert!((value - expected).abs() < 1e-5, "{:?} {:?} {value}", basic_dof(i), basic_dof(j));
    }
}

#[test]
fn errors_name_file_line_and_cure() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let message = |structure: &str| {
        put("p.toml", &project(structure));
        refused(&["simulate", "p.toml", "--out", "out"], folder.path())
    };
    put("a.pch", &format!("{}{}", dmig("KAA", &STIFFNESS), dmig("KBB", &STIFFNESS)));
    let one = "mass = \"a.pch\"\nstiffness = \"a.pch\"";
    assert_eq!(
        message(one),
        "a.pch: it is not clear which matrix is meant of: KAA, KBB; name it as `mass_name` of [structure]"
    );
    put("a.pch", "DMIG,K,0,6,4,0\n");
    assert_eq!(message(one), "a.pch:1: matrix K is complex; export the real mass or stiffness matrix");
    put("job.mas", "1 1 2.0\n");
    put("job.sti", "1 1 2.0\n");
    let two = "mass = \"job.mas\"\nstiffness = \"job.sti\"";
    assert!(message(two).starts_with("job.dof: cannot be read: "), "{}", message(two));
    put("job.dof", "11.3\n12.3\n");
    assert!(
        message(two).contains("there is no DOF \"13z\"") || message(two).contains("mass matrix is not positive"),
        "{}",
        message(two)
    );
    let reduced = format!("{two}\n[structure.reduce]\nup_to_hz = 0.0");
    assert!(message(&reduced).contains("`up_to_hz = 0` is not a usable number"), "{}", message(&reduced));
}
