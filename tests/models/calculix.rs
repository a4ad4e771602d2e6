//! Against CalculiX itself, where `ccx` and `python3` are installed; elsewhere a line says that nothing was tested.

use dashpot::effects::{Effect, Place, Source};
use dashpot::exchange::export::{Format, Identified, IdentifiedSource, write};
use dashpot::exchange::project::plan;
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use faer::Mat;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/finite-elements/cantilever.py");

/// Runs a program in a folder; whether it is there and ended well.
fn ran(program: &str, arguments: &[&str], folder: &Path) -> bool {
    let output = Command::new(program).args(arguments).current_dir(folder).env("OMP_NUM_THREADS", "1").output();
    output.is_ok_and(|output| output.status.success())
}

fn is_installed() -> bool {
    let here = Path::new(".");
    ran("python3", &["--version"], here) && Command::new("ccx").arg("-v").current_dir(here).output().is_ok()
}

/// Frequency (Hz) and complex z displacement of the one printed node, from the `.dat` file of a steady-state step.
fn printed(text: &str) -> Vec<(f64, [f64; 2])> {
    let mut lines = text.lines();
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    while let Some(line) = lines.next() {
        let Some(at) = line.split("set TIP and time").nth(1) else { continue };
        let value = lines.nth(1).unwrap().split_whitespace().nth(3).unwrap().parse().unwrap();
        let frequency: f64 = at.trim().parse().unwrap();
        match found.last_mut().filter(|(_, parts)| parts.len() == 1) {
            Some((_, parts)) => parts.push(value),
            None => found.push((frequency, vec![value])),
        }
    }
    found.into_iter().map(|(f, parts)| (f, [parts[0], parts[1]])).collect()
}

/// The steady-state response of a cantilever of solid elements with our dashpots, by CalculiX and by us.
#[test]
fn exported_dashpots_give_the_same_response() {
    if !is_installed() {
        println!("skipped: ccx or python3 is not installed");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mesh = ["--elements", "20", "2", "1"];
    assert!(ran("python3", &[&[SCRIPT, "."], &mesh[..]].concat(), folder.path()));
    assert!(ran("ccx", &["-i", "matrices"], folder.path()));
    let text = "[project]\nformat = 1\n[structure]\nkind = \"matrices\"\nmass = \"matrices.mas\"\nstiffness = \"matrices.sti\"\n\
        [structure.reduce]\nup_to_hz = 20000.0\nband_hz = 400.0\ndofs = [\"63z\", \"99z\", \"123z\"]\n";
    let plan = plan(text, &folder.path().join("p.toml")).unwrap();
    let structure = &plan.structure;
    let reduction = structure.origin().reduction.as_ref().unwrap();
    println!("{}", reduction.sentence());
    assert!(reduction.worst().unwrap().frequency_error().abs() < 1e-3);
    let row = |label: &str| structure.dof(label).unwrap();
    let viscous = |label: &str, c: f64| Source::known(Effect::Viscous, Place::Dofs(vec![row(label)]), &[c]);
    let sources = [viscous("63z", 2.0), viscous("99z", 0.5)];
    let identified: Vec<IdentifiedSource> = sources
        .iter()
        .map(|source| IdentifiedSource { source: source.clone(), deviation: vec![0.0], energy_percent: 50.0 })
        .collect();
    let zero = Mat::zeros(structure.len(), structure.len());
    let identified = Identified {
        title: "cantilever",
        structure,
        sources: &identified,
        viscous: &zero,
        others: &[],
        equivalent: &zero,
        energy_percent: &[],
        modes: &[],
    };
    let written = write(&identified, Format::Calculix, &folder.path().join("dashpots.inp")).unwrap();
    assert!(written.warnings.is_empty(), "{:?}", written.warnings);
    let more = ["--response", "dashpots.inp", "--frequencies", "5", "250", "3"];
    assert!(ran("python3", &[&[SCRIPT, "."], &mesh[..], &more[..]].concat(), folder.path()));
    assert!(ran("ccx", &["-i", "response"], folder.path()));
    let theirs = printed(&fs::read_to_string(folder.path().join("response.dat")).unwrap());
    assert!(theirs.len() > 10, "{}", theirs.len());
    let tip = row("123z");
    let stiffness = DynamicStiffness::new(structure, &sources).unwrap();
    let mut worst = 0.0_f64;
    for (frequency, [re, im]) in theirs {
        let ours = stiffness.factorise(TAU * frequency).receptance_column(tip).unwrap()[tip];
        let error = (ours.re - re).hypot(ours.im - im) / ours.re.hypot(ours.im);
        println!(
            "{frequency:10.3} Hz  CalculiX {re:12.4e} {im:12.4e}  here {:12.4e} {:12.4e}  {:.3} %",
            ours.re,
            ours.im,
            100.0 * error
        );
        worst = worst.max(error);
    }
    assert!(worst < 0.01, "{worst}");
}
