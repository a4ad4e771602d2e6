//! Frequency responses from a simulated hammer test to identified dashpots, and what is refused.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, missing_docs, reason = "tests")]

#[path = "frf/modes.rs"]
mod modes;
#[path = "frf/whole.rs"]
mod whole;

use dashpot::cli::answer;
use dashpot::control::Control;
use dashpot::exchange::Project;
use dashpot::exchange::project::load;
use dashpot::identify::{Outcome, identify};
use std::path::{Path, PathBuf};

const BEAM: &str = "[structure]\nkind = \"beam\"\nlength = 0.56\nbreadth = 0.04\ndepth = 0.004\nyoungs_modulus = 69e9\n\
                    density = 2700.0\nelements = 10\nsupports = \"clamped-free\"\n";
const CANDIDATES: &str = "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n";
const TRUTH: &str = "[[source]]\nlaw = \"viscous\"\ndofs = [5]\nstate = \"known\"\nc = 0.5\n[[source]]\nlaw = \"viscous\"\n\
                     dofs = [13]\nstate = \"known\"\nc = 0.2\n[[frf]]\nfile = \"hammer.uff\"\naverages = 8\nband = [0, 400]\n";
const CHANNELS: &str = "[simulate]\nsamples = 1601\nchannels = [\"force@7 [N]\", \"force@19 [N]\", \"acc@7 [m/s^2]\", \
                        \"acc@11 [m/s^2]\", \"acc@15 [m/s^2]\", \"acc@19 [m/s^2]\"]\n";

fn file(folder: &Path, name: &str, parts: &[&str]) -> PathBuf {
    let path = folder.join(name);
    let text = format!("[project]\nformat = 1\ntitle = \"test\"\n{}", parts.concat());
    std::fs::write(&path, text).unwrap();
    path
}

/// A folder with `hammer.uff` of a simulated test.
fn hammered(noise: &str, channels: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let truth = file(folder.path(), "truth.toml", &[BEAM, TRUTH, channels]);
    let arguments = ["dashpot", "simulate", "--noise", noise, "--seed", "12", "--as", "frf", "--out"];
    let all = arguments.iter().map(Into::into).chain([folder.path().into(), truth.into()]);
    answer(all).unwrap();
    folder
}

fn opened(folder: &Path, frf: &str, more: &str) -> Result<Project, String> {
    let path = file(folder, "project.toml", &[BEAM, CANDIDATES, more, "[[frf]]\nfile = \"hammer.uff\"\n", frf]);
    load(&path, &Control::unattended()).map_err(|error| error.to_string())
}

fn identified(project: &Project) -> Outcome {
    identify(&project.structure, &project.sources, &project.runs, &project.settings, &Control::unattended()).unwrap()
}

/// What was found: label of the DOF, coefficient, deviation.
fn found(project: &Project, outcome: &Outcome) -> Vec<(String, f64, f64)> {
    let with_label = |e: &dashpot::identify::Estimate| {
        let dashpot::effects::Place::Dofs(dofs) = &project.sources[e.source].place else { panic!() };
        (project.structure.label(dofs[0]).to_string(), e.coefficient, e.deviation)
    };
    outcome.sources.iter().map(with_label).collect()
}

fn right(found: &[(String, f64, f64)]) {
    assert_eq!(found.iter().map(|(label, ..)| label.as_str()).collect::<Vec<_>>(), ["5", "13"], "{found:?}");
    for ((_, c, deviation), truth) in found.iter().zip([0.5, 0.2]) {
        assert!((c - truth).abs() < 4.0 * deviation + 1e-3 * truth && *deviation < 0.05 * truth, "{found:?}");
    }
}

#[test]
fn a_hammer_test_gives_its_dashpots_back_with_their_deviations() {
    let folder = hammered("0.02", CHANNELS);
    let project = opened(folder.path(), "averages = 8\n", "").unwrap();
    assert_eq!(project.runs.len(), 48);
    assert!(project.runs.iter().all(|run| run.per_unit_force && run.fit.channels.len() == 5));
    assert!(project.remarks[0].starts_with("hammer.uff: 48 of 3200 lines are used"), "{:?}", project.remarks);
    right(&found(&project, &identified(&project)));
    // Without averages the deviations come from the scatter about a smooth curve.
    let scattered = opened(folder.path(), "", "").unwrap();
    assert!(scattered.remarks[1].contains("averages is not known"), "{:?}", scattered.remarks);
    right(&found(&scattered, &identified(&scattered)));
}

#[test]
fn a_roving_hammer_gives_columns_by_reciprocity() {
    let roving = CHANNELS.replace("\"force@19 [N]\"", "\"force@11 [N]\", \"force@15 [N]\", \"force@19 [N]\"");
    let roving = roving.replace("\"acc@7 [m/s^2]\", \"acc@11 [m/s^2]\", \"acc@15 [m/s^2]\", ", "");
    let folder = hammered("0.01", &roving);
    let project = opened(folder.path(), "averages = 8\nreciprocity = true\n", "").unwrap();
    assert!(project.runs.iter().all(|run| run.fit.force_channels().len() == 1 && run.response_channels().len() == 4));
    right(&found(&project, &identified(&project)));
}

#[test]
fn laws_that_depend_on_the_amplitude_are_left_out_and_that_is_said() {
    let folder = hammered("0.01", CHANNELS);
    let friction = "[[source]]\nlaw = \"coulomb\"\ndofs = [9]\nstate = \"candidate\"\n";
    let project = opened(folder.path(), "averages = 8\nlines = 24\n", friction).unwrap();
    let outcome = identified(&project);
    assert!(outcome.warnings.iter().any(|w| w.starts_with("coulomb: left out")), "{:?}", outcome.warnings);
    right(&found(&project, &outcome));
}

#[test]
fn the_mapping_names_and_turns_channels() {
    let folder = hammered("0.01", CHANNELS);
    let plain = opened(folder.path(), "averages = 8\nlines = 8\n", "").unwrap();
    // The file's node 4 is the beam's DOF 7, which is now said to be DOF 9, reversed.
    let mapped = "averages = 8\nlines = 8\nscale = 2.0\n[frf.dofs]\n\"4:+Y\" = \"-9\"\n";
    let direction = plain.structure.dofs()[plain.structure.dof("7").unwrap()].direction;
    let mapped = mapped.replace('Y', &format!("{direction:?}"));
    let mapped = opened(folder.path(), &mapped, "").unwrap();
    let value = |project: &Project, label: &str| {
        let drive = |run: &&dashpot::measurement::Run| run.fit.channels[0].channel.label == "19";
        let run = project.runs.iter().find(drive).unwrap();
        let channel = run.fit.channels.iter().find(|c| c.channel.to_string() == format!("acc@{label}")).unwrap();
        (run.frequency_hz(), channel.amplitudes[0])
    };
    let ((f, there), (g, here)) = (value(&plain, "7"), value(&mapped, "9"));
    assert_eq!(f, g);
    assert!((there * -2.0 - here).norm() < 1e-12 * here.norm(), "{there} {here}");
}

#[test]
fn faults_are_one_line_with_file_set_and_remedy() {
    let folder = hammered("0.01", CHANNELS);
    let error = |frf: &str| opened(folder.path(), frf, "").unwrap_err();
    for (frf, expected) in [
        ("form = \"mobility\"\n", "correct `form` (of import: --form), or give `scale` (--scale) too"),
        ("form = \"stiffness\"\n", "`form = \"stiffness\"` is not understood"),
        ("scale = 0\n", "other than zero"),
        ("band = [400, 5]\n", "two ascending frequencies"),
        ("band = [1000, 2000]\n", "no usable line in the band"),
        ("lines = 0\n", "between 1 and 100000"),
        ("averages = -3\n", "between 1 and 1000000"),
        ("sign = -1\n", "no key `sign`"),
        ("form = \"dynamic-stiffness\"\nscale = 1.0\n", "force over motion between different DOFs is not the inverse"),
        ("[frf.dofs]\n\"4:+Z\" = 77\n\"4:+Y\" = 77\n", "the structure has no such DOF"),
    ] {
        let said = error(frf);
        assert!(said.contains(expected) && !said.contains('\n'), "{frf}: {said}");
        assert!(said.contains("project.toml:"), "{said}");
    }
    let path = folder.path().join("hammer.uff");
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, [&bytes[..], &bytes[..]].concat()).unwrap();
    assert!(error("").contains("keep one of them"), "{}", error(""));
    std::fs::write(&path, b"nothing").unwrap();
    assert!(error("").contains("is this a Universal File?"));
    std::fs::remove_file(&path).unwrap();
    assert!(error("").contains("hammer.uff is not there"));
}

#[test]
fn the_sample_is_what_its_recipe_makes_and_shows_its_dashpots() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data/hammer-frf");
    let project = load(&folder.join("project.toml"), &Control::unattended()).unwrap();
    let found = found(&project, &identified(&project));
    right(&found);
    let made = tempfile::tempdir().unwrap();
    let arguments = ["dashpot", "simulate", "--noise", "0.02", "--seed", "12", "--as", "frf", "--out"];
    let all = arguments.iter().map(Into::into).chain([made.path().into(), folder.join("truth.toml").into()]);
    answer(all).unwrap();
    let again = std::fs::read(made.path().join("hammer.uff")).unwrap();
    let kept = std::fs::read(folder.join("hammer.uff")).unwrap();
    assert_eq!(again.len(), kept.len());
}

/// A model 1 % off in its frequencies and functions with hardly any noise: what the expansion leaves stands out of the noise, but
/// a source that carries nowhere half a per cent of the energy is not taken for it, and that is said.
#[test]
fn errors_of_the_model_are_no_sources() {
    let folder = hammered("0.005", CHANNELS);
    let stiffer = BEAM.replace("69e9", "70.4e9");
    let path =
        file(folder.path(), "stiffer.toml", &[&stiffer, CANDIDATES, "[[frf]]\nfile = \"hammer.uff\"\naverages = 8\n"]);
    let project = load(&path, &Control::unattended()).unwrap();
    let outcome = identified(&project);
    let found = found(&project, &outcome);
    assert_eq!(found.iter().map(|(label, ..)| label.as_str()).collect::<Vec<_>>(), ["5", "13"], "{found:?}");
    for ((_, c, deviation), truth) in found.iter().zip([0.5, 0.2]) {
        assert!((c / truth - 1.0).abs() < 0.01 && (c - truth).abs() < 2.0 * deviation, "{found:?}");
    }
    assert!(outcome.reason.contains("carries less than 0.5 % of the energy in every run"), "{}", outcome.reason);
}
