//! Good and odd projects: what is read from them, and that writing them gives the same project.

use dashpot::balance::{Expansion, Weights};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, State};
use dashpot::exchange::project::file::Shape;
use dashpot::exchange::project::label::Label;
use dashpot::exchange::project::{Plan, ProjectFile, load, open, plan};
use dashpot::structure::Direction;
use faer::c64;
use std::path::Path;

pub(crate) const FULL: &str = r#"
[project]
format = 1
title = "All there is"
notes = "two\nlines"

[structure]
kind = "beam"
length = 0.56
breadth = 0.04
depth = 0.004
youngs_modulus = 69e9
density = 2700
elements = 10
supports = "clamped-free"
[[structure.lumped_mass]]
dof = 7
mass = 0.02

[[source]]
law = "viscous"
dofs = [3]
state = "known"
c = 0.2
[[source]]
law = "coulomb"
dofs = ["5", 7]
state = "forced"
[[source]]
law = "power"
dofs = [1, 3, 5]
state = "candidate"
exponent = 1.5
[[source]]
law = "loss_factor"
elements = [1, 4]
state = "off"
[[source]]
law = "viscous"
dofs = [17]
state = "reference"
c = 1

[[candidates]]
law = "viscous"
where = "each-translation"

[[sensor]]
channel = "acc@7"
delay = 1e-4
gain = 1.02

[[run]]
file = "run-01.csv"
frequency = 10
level = 2
[[run]]
file = "run-02.csv"
use = false
force_dof = 19
force_n = 2.5

[[harmonics]]
file = "fitted.csv"

[analysis]
harmonics = 9
expansion = "single-mode"
keep = 0
weights = "energy"
max_sources = 4
stop_angle_deg = 1

[simulate]
channels = ["force@19 [N]", "acc@7 [g]"]
samples = 500
periods = 7
"#;

fn read(text: &str) -> Plan {
    plan(text, Path::new("folder/p.toml")).unwrap()
}

#[test]
fn every_key_is_read() {
    let plan = read(FULL);
    assert_eq!((plan.file.project.title.as_str(), plan.file.project.notes.as_str()), ("All there is", "two\nlines"));
    assert_eq!(plan.structure.len(), 20);
    let plain = read(&FULL.replace("0.02", "1e-12"));
    let heavier = plan.structure.matrices().unwrap().mass[(6, 6)] - plain.structure.matrices().unwrap().mass[(6, 6)];
    assert!((heavier - 0.02).abs() < 1e-11, "the lumped mass sits at DOF 7");
    let places: Vec<&Place> = plan.sources.iter().take(5).map(|source| &source.place).collect();
    let dofs = |rows: &[usize]| Place::Dofs(rows.to_vec());
    assert_eq!(places, [&dofs(&[2]), &dofs(&[4, 6]), &dofs(&[0, 2, 4]), &Place::Whole(Some([0, 3])), &dofs(&[16])]);
    let states: Vec<State> = plan.sources.iter().take(5).map(|source| source.state).collect();
    assert_eq!(states, [State::Known, State::Forced, State::Candidate, State::Off, State::Reference]);
    assert_eq!(plan.sources[0].parameters, [0.2]);
    assert_eq!(plan.sources[2].parameters, [1.0, 1.5], "the sought coefficient is 1, the exponent is kept");
    assert_eq!(plan.sources.len(), 5 + 10, "one candidate a translation, beside what is known there");
    assert_eq!(plan.sensors.len(), 2);
    assert_eq!((plan.sensors[0].effect, plan.sensors[0].parameters[0]), (Effect::Delay, 1e-4));
    assert_eq!(plan.sensors[1].place, Place::Channel("acc@7".into()));
    assert_eq!((plan.runs[0].frequency_hz, plan.runs[0].level, plan.runs[0].enabled), (Some(10.0), Some(2), true));
    assert_eq!(plan.runs[0].path, Path::new("folder/run-01.csv"));
    assert!(!plan.runs[1].enabled);
    let force = plan.runs[1].force.unwrap();
    assert_eq!((force.dof, force.amplitude_n), (18, 2.5));
    let settings = plan.settings();
    assert_eq!((settings.harmonics, settings.keep, settings.max_sources), (9, 0, 4));
    assert_eq!((settings.expansion, settings.weights), (Expansion::SingleMode, Weights::Energy));
    assert_eq!(settings.stop_angle_deg, 1.0);
    let recipe = plan.simulate();
    assert_eq!((recipe.samples, recipe.periods, recipe.channels[1].as_str()), (500, 7, "acc@7 [g]"));
}

#[test]
fn what_is_written_reads_back_the_same() {
    let (file, _) = ProjectFile::parse(FULL, "p.toml").unwrap();
    let text = file.to_toml().unwrap();
    let (again, _) = ProjectFile::parse(&text, "again.toml").unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(again, file, "{text}");
    assert!(text.contains("dofs = [3]"), "labels that are numbers need no quotes: {text}");
}

#[test]
fn families_leave_out_what_is_sought_already() {
    let head = "[project]\nformat = 1\n[structure]\nkind = \"points\"\ndofs = [\"a\", \"b\", \"c\"]\n";
    let forced = "[[source]]\nlaw = \"viscous\"\ndofs = [\"b\", \"a\"]\nstate = \"forced\"\n";
    let family = "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-pair\"\n";
    let sources = read(&format!("{head}{forced}{family}{family}")).sources;
    let places: Vec<&Place> = sources.iter().map(|source| &source.place).collect();
    assert_eq!(places, [&Place::Dofs(vec![1, 0]), &Place::Dofs(vec![1, 2])]);
    let off = forced.replace("forced", "off");
    assert_eq!(read(&format!("{head}{off}{family}")).sources.len(), 3, "what is off is as if it were not there");
}

#[test]
fn odd_but_good() {
    let text = "\u{feff}[project]\r\nformat = 0x1\r\n[structure]\r\nkind = \"points\"\r\ndofs = [+1, 2]\r\n";
    let odd = read(text);
    assert_eq!(odd.structure.label(0), "1");
    assert!(odd.runs.is_empty() && odd.sources.is_empty());
    let inline = "project = {format = 1}\nstructure = {kind = \"points\", dofs = [1, 2]}\n\
        source = [{law = \"viscous\", dofs = [1, 2], state = \"candidate\"}]\n";
    assert_eq!(read(inline).sources.len(), 1);
}

#[test]
fn matrices_from_files() {
    let folder = tempfile::tempdir().unwrap();
    let save = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    save("m.csv", "2,0\n0,3\n");
    save("k.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 10\n2 1 -4\n2 2 5\n");
    save("nodes.csv", "node,x,y,z\nA,0,0,0\nB,0,1.5,0\n");
    save("dofs.csv", "dof,node,direction\ntip,B,z\nroot,A,rx\n");
    save("lines.csv", "node,node\nA,B\n");
    let head = "[project]\nformat = 1\n[structure]\nkind = \"matrices\"\nmass = \"m.csv\"\nstiffness = \"k.mtx\"\n";
    let tables = "nodes = \"nodes.csv\"\ndofs = \"dofs.csv\"\nlines = \"lines.csv\"\n";
    save("p.toml", &format!("{head}{tables}"));
    let plan = open(&folder.path().join("p.toml")).unwrap();
    let matrices = plan.structure.matrices().unwrap();
    assert_eq!((matrices.mass[(1, 1)], matrices.stiffness[(0, 1)]), (3.0, -4.0));
    assert_eq!(plan.structure.dofs()[1].direction, Direction::Rx);
    assert_eq!(plan.structure.nodes()[plan.structure.dofs()[0].node].position, [0.0, 1.5, 0.0]);
    assert_eq!(plan.structure.lines(), [[0, 1]]);
    let Shape::Matrices(files) = &plan.file.structure.shape else { panic!("not matrices") };
    assert_eq!(files.mass, "m.csv");

    save("k.mtx", "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 10\n3 1 -4\n2 2 5\n");
    let message = open(&folder.path().join("p.toml")).unwrap_err().to_string();
    assert!(
        message.ends_with("k.mtx:4: entry (3, 1) lies outside the 2 x 2 matrix; indices count from 1"),
        "{message}"
    );
}

#[test]
fn files_that_are_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.toml");
    assert!(open(&path).unwrap_err().to_string().contains("p.toml: cannot be read: "));
    std::fs::write(&path, b"[project]\nformat = 1\n\xff").unwrap();
    assert!(open(&path).unwrap_err().to_string().ends_with("byte 22 is not UTF-8; save the project as UTF-8 text"));
    std::fs::write(&path, FULL).unwrap();
    let plan = open(&path).unwrap();
    let control = Control::unattended();
    let message = |run| plan.record(run, &control).unwrap_err().to_string();
    assert!(
        message(0).ends_with("the record run-01.csv is not there; correct `file`, which is relative to the project")
    );
    assert!(message(1).ends_with(
        "the record run-02.csv is not there yet; run `dashpot simulate` on this project first, or correct `file`"
    ));
    assert!(plan.harmonics().unwrap_err().to_string().contains("fitted.csv is not there"));
}

#[test]
fn labels_keep_their_text() {
    let text = |label: &str| {
        let (mut file, _) = ProjectFile::parse(FULL, "p.toml").unwrap();
        file.source[0].dofs = vec![Label(label.into())];
        ProjectFile::parse(&file.to_toml().unwrap(), "p").unwrap().0.source[0].dofs[0].0.clone()
    };
    for label in ["3", "03", "+3", "-3", "a b", "\"", "99999999999999999999", "3.0", "ä"] {
        assert_eq!(text(label), label);
    }
}

/// A record of 100 samples a period over ten periods, so that the fit has something to hold on to.
fn record(frequency: f64, force: f64, acceleration: [f64; 2]) -> String {
    let mut text = "time [s],force@1 [kN],acc@b [m/s^2]\n".to_owned();
    for n in 0..1000 {
        let t = f64::from(n) / (100.0 * frequency);
        let (sin, cos) = (std::f64::consts::TAU * frequency * t).sin_cos();
        let y = acceleration[0] * cos + acceleration[1] * sin;
        text.push_str(&format!("{t:.15},{:.15},{y:.15}\n", 1e-3 * force * cos));
    }
    text
}

#[test]
fn records_are_fitted_and_corrected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.toml");
    let head = "[project]\nformat = 1\n[structure]\nkind = \"points\"\ndofs = [1, \"b\"]\n\
        [[sensor]]\nchannel = \"acc@b\"\ngain = 2\n[[run]]\nfile = \"one.csv\"\nfrequency = 5\nlevel = 1\n\
        [[run]]\nfile = \"two.csv\"\nuse = false\n[[harmonics]]\nfile = \"h.csv\"\n[analysis]\nharmonics = 3\n";
    std::fs::write(&path, head).unwrap();
    std::fs::write(folder.path().join("one.csv"), record(5.0, 3.0, [4.0, -6.0])).unwrap();
    std::fs::write(folder.path().join("two.csv"), record(8.0, 1.0, [2.0, 2.0])).unwrap();
    let harmonics = "run,frequency_hz,channel,harmonic,cos,sin\nh1,20,force@1 [N],1,1,0\nh1,20,acc@b [g],1,0,2\n";
    std::fs::write(folder.path().join("h.csv"), harmonics).unwrap();

    let project = load(&path, &Control::unattended()).unwrap();
    let found: Vec<_> = project.runs.iter().map(|run| (run.file.as_str(), run.level, run.enabled)).collect();
    assert_eq!(found, [("one.csv", Some(1), true), ("two.csv", None, false), ("h1", None, true)]);
    let amplitude = |run: usize, channel: usize| project.runs[run].fit.channels[channel].amplitudes[0];
    let near = |found: c64, re: f64, im: f64| assert!((found - c64::new(re, im)).norm() < 1e-9, "{found} {re} {im}");
    near(amplitude(0, 0), 3.0, 0.0);
    near(amplitude(0, 1), 2.0, 3.0);
    near(amplitude(1, 1), 1.0, -1.0);
    near(amplitude(2, 1), 0.0, -9.80665);
    assert_eq!(project.runs[0].fit.harmonics(), 3);
    let omega = project.runs[1].fit.omega;
    assert!((omega / std::f64::consts::TAU - 8.0).abs() < 1e-6, "found without being given: {omega}");
    assert!(project.runs[0].record.is_some() && project.runs[2].record.is_none());

    let refused = |old: &str, new: &str| {
        std::fs::write(&path, head.replace(old, new)).unwrap();
        load(&path, &Control::unattended()).map(|_| ()).unwrap_err().to_string()
    };
    let message = refused("acc@b", "vel@b");
    assert!(
        message
            .ends_with("p.toml:6: no record has the channel \"vel@b\"; correct its name or leave the [[sensor]] out")
    );
    let message = refused("frequency = 5", "frequency = 0.1");
    assert!(message.contains("p.toml:11: record one.csv: the record lasts "), "{message}");
    std::fs::write(folder.path().join("one.csv"), "time [s],acc@9 [m/s^2]\n0,1\n").unwrap();
    let message = refused("", "");
    assert!(message.contains("one.csv, line 1") && !message.contains("p.toml"), "{message}");
    let message = refused(&head[head.find("[[sensor]]").unwrap()..], "");
    assert!(
        message.ends_with("p.toml: there is nothing measured; add [[run]] with `file`, or [[harmonics]]"),
        "{message}"
    );
}

/// Runs carry their session and level, from their table or from their file; `use = true` is told from no word at all.
#[test]
fn runs_have_sessions_levels_and_a_use_that_insists() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.toml");
    let text = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1]\nground_stiffness = [1e4]\n\
        coupling_stiffness = []\n[[run]]\nfile = \"one.csv\"\nfrequency = 5\nsession = \"monday\"\nuse = true\n\
        [[harmonics]]\nfile = \"h.csv\"\nlevel = 4\nsession = \"tuesday\"\nuse = false\n\
        [[harmonics]]\nfile = \"stepped.csv\"\nforce = \"force@1 [N]\"\nresponse = \"acc@1 [m/s^2]\"\nphase_of = \"disp\"\n";
    std::fs::write(&path, text).unwrap();
    std::fs::write(folder.path().join("one.csv"), record(5.0, 3.0, [4.0, -6.0]).replace("@b", "@1")).unwrap();
    let harmonics = "run,frequency_hz,channel,harmonic,cos,sin\nh1,20,force@1 [N],1,1,0\nh1,20,acc@1 [g],1,0,2\n";
    std::fs::write(folder.path().join("h.csv"), harmonics).unwrap();
    let stepped = "level,frequency_hz,force,amplitude,phase_deg\n1,15,2,0.5,-90\n2,16,4,0.9,-80\n";
    std::fs::write(folder.path().join("stepped.csv"), stepped).unwrap();

    let project = load(&path, &Control::unattended()).unwrap();
    let found: Vec<_> =
        project.runs.iter().map(|run| (run.level, run.session.as_deref(), run.enabled, run.insisted)).collect();
    let expected = [
        (None, Some("monday"), true, true),
        (Some(4), Some("tuesday"), false, false),
        (Some(1), None, true, false),
        (Some(2), None, true, false),
    ];
    assert_eq!(found, expected);
    let acceleration = project.runs[2].fit.channels[1].amplitudes[0];
    assert!((acceleration - c64::new(0.0, 0.5)).norm() < 1e-12, "{acceleration}");

    std::fs::write(&path, text.replace("phase_of = \"disp\"", "phase_of = \"force\"")).unwrap();
    let said = load(&path, &Control::unattended()).unwrap_err().to_string();
    assert!(said.contains("`phase_of = \"force\"` is not understood"), "{said}");
    let (file, _) = ProjectFile::parse(text, "p.toml").unwrap();
    let (again, _) = ProjectFile::parse(&file.to_toml().unwrap(), "again.toml").unwrap();
    assert_eq!(again, file);
}
