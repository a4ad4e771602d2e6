//! The same faults in hammers, decays and noise: simulated projects with one fault each, and sound ones beside models that are
//! wrong and effects that are hidden.

use super::{run, words};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// Time for a search behind the faults, s: what laws there are is not asked here.
const SECONDS: &str = "1";

/// A structure, its measured DOFs, where it is hit, and where it is let go.
struct Specimen {
    /// Its table with the stiffness times a factor.
    table: fn(f64) -> String,
    sensors: &'static [usize],
    hits: &'static [usize],
    /// Samples a second, and their time, s.
    rate: f64,
    seconds: f64,
    /// A dashpot that the model knows, and two effects that it may not know.
    known: &'static str,
    hidden: [&'static str; 2],
}

const CHAIN: Specimen = Specimen {
    table: |factor| {
        let k = 4e4 * factor;
        format!(
            "kind = \"chain\"\nmasses = [2.0, 1.5, 2.5, 1.0]\nground_stiffness = [{k:?}, 0.0, {:?}, 0.0]\n\
             coupling_stiffness = [{k:?}, {:?}, {k:?}]\n",
            0.5 * k,
            1.4 * k
        )
    },
    sensors: &[1, 2, 3, 4],
    hits: &[1, 4],
    rate: 512.0,
    seconds: 4.0,
    known: "law = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = 4.0\n[[source]]\nlaw = \"viscous\"\ndofs = [4]\nstate = \"known\"\nc = 3.0\n",
    hidden: [
        "law = \"coulomb\"\ndofs = [2]\nforce = 0.4\n",
        "law = \"cubic_stiffness\"\ndofs = [3]\nstiffness = 4e9\n",
    ],
};

const BEAM: Specimen = Specimen {
    table: |factor| {
        format!(
            "kind = \"beam\"\nlength = 0.4\nbreadth = 0.03\ndepth = 0.005\nyoungs_modulus = {:?}\ndensity = 2700.0\nelements = 8\n\
             supports = \"clamped-free\"\n",
            69e9 * factor
        )
    },
    sensors: &[3, 5, 7, 11, 15],
    hits: &[7, 15],
    rate: 4096.0,
    seconds: 2.0,
    known: "law = \"stiffness_proportional\"\nbeta = 6e-6\nstate = \"known\"\n[[source]]\nlaw = \"viscous\"\ndofs = [15]\nstate = \"known\"\nc = 0.3\n",
    hidden: ["law = \"coulomb\"\ndofs = [9]\nforce = 0.2\n", "law = \"viscous\"\ndofs = [5]\nc = 1.5\n"],
};

/// Tests of a project.
#[derive(Clone, Copy, PartialEq)]
enum Tests {
    Hammer,
    Decay,
    Both,
}

impl Specimen {
    fn runs(&self, tests: Tests, exciting: bool) -> String {
        let mut text = String::new();
        let hammer = |dof: &usize| {
            let width = 1.2 / self.rate * 4.0;
            format!(
                "{{ kind = \"impulse\", dof = {dof}, peak_n = 80.0, width_s = {width:?}, at_s = 0.05, duration_s = {:?} }}",
                self.seconds
            )
        };
        let release = |dof: &usize| {
            let seconds = self.seconds;
            format!("{{ kind = \"release\", dof = {dof}, displacement_m = 0.002, duration_s = {seconds:?} }}")
        };
        for (i, dof) in self.hits.iter().enumerate() {
            let run_table = |kind: &str, word: &str, excitation: String| {
                let excitation = if exciting { format!("excitation = {excitation}\n") } else { String::new() };
                format!("[[run]]\nfile = \"{word}-{i}.csv\"\nkind = \"{kind}\"\n{excitation}")
            };
            if tests != Tests::Decay {
                text += &run_table("transient", "hammer", hammer(dof));
            }
            if tests != Tests::Hammer {
                text += &run_table("decay", "decay", release(dof));
            }
        }
        text
    }

    /// Records of the truth, and a project whose stiffness is wrong by a factor.
    fn recorded(&self, tests: Tests, factor: f64, hidden: Option<usize>) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let head = |factor: f64| {
            format!(
                "[project]\nformat = 1\ntitle = \"test\"\n[structure]\n{}[[source]]\n{}",
                (self.table)(factor),
                self.known
            )
        };
        let hidden = hidden.map_or_else(String::new, |k| format!("[[source]]\nstate = \"known\"\n{}", self.hidden[k]));
        let mut channels = String::new();
        if tests != Tests::Decay {
            self.hits.iter().for_each(|dof| write!(channels, "\"force@{dof} [N]\", ").unwrap());
        }
        self.sensors.iter().for_each(|dof| write!(channels, "\"acc@{dof} [m/s^2]\", ").unwrap());
        let simulate = format!("[simulate]\nrate_hz = {:?}\nchannels = [{channels}]\n", self.rate);
        let truth = folder.path().join("truth.toml");
        std::fs::write(&truth, [&head(1.0), &hidden, &self.runs(tests, true), &simulate].map(String::as_str).concat())
            .unwrap();
        run(&["simulate", "--noise", "0.003", "--seed", "4", "--out"], &[folder.path(), &truth]);
        std::fs::write(folder.path().join("project.toml"), head(factor) + &self.runs(tests, false)).unwrap();
        folder
    }
}

/// Changes the header of every record, and the values of one column that its name in the file says.
fn spoiled(folder: &Path, header: impl Fn(&str) -> String, column: &str, factor: f64) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "csv") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let mut lines = text.lines();
        let names = lines.next().unwrap();
        let at = names.split(',').position(|name| name.starts_with(column));
        let mut out = header(names) + "\n";
        for line in lines {
            let mut row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            at.into_iter().for_each(|k| row[k] *= factor);
            out += &(row.iter().map(ToString::to_string).collect::<Vec<_>>().join(",") + "\n");
        }
        std::fs::write(&path, out).unwrap();
    }
}

/// Exchanges two names of a header.
fn exchanged(header: &str, a: &str, b: &str) -> String {
    header.replace(a, "other").replace(b, a).replace("other", b)
}

fn diagnosed(more: &[&str], paths: &[&Path]) -> Value {
    let text = run(&[&["diagnose", "--json", "--seconds", SECONDS], more].concat(), paths);
    serde_json::from_str(&text).unwrap()
}

/// What `diagnose` says of the channels, and what it says of the project that it mended.
fn said(folder: &Path) -> (Value, Vec<String>) {
    let mended = folder.join("mended.toml");
    let document = diagnosed(&["--apply"], &[&mended, &folder.join("project.toml")]);
    let again = diagnosed(&[], &[&mended]);
    (document, words(&again).into_iter().map(str::to_owned).collect())
}

/// One fault in records of a specimen, and the words that are to be said of it.
#[track_caller]
fn named(
    specimen: &Specimen,
    tests: Tests,
    header: impl Fn(&str) -> String,
    (column, factor): (&str, f64),
    said_is: &str,
) {
    let folder = specimen.recorded(tests, 1.015, Some(0));
    spoiled(folder.path(), header, column, factor);
    let (document, again) = said(folder.path());
    assert_eq!(words(&document), [said_is]);
    let fault = &document["channel_faults"][0];
    assert!(fault["error_after"].as_f64().unwrap() < 0.6 * fault["error_before"].as_f64().unwrap(), "{fault}");
    assert!(again.is_empty(), "{again:?}");
}

fn as_is(header: &str) -> String {
    header.to_owned()
}

#[test]
fn a_reversed_sensor_of_a_chain() {
    named(&CHAIN, Tests::Hammer, as_is, ("acc@3", -1.0), "acc@3 looks reversed");
}

#[test]
fn a_reversed_sensor_of_a_beam() {
    named(&BEAM, Tests::Decay, as_is, ("acc@7", -1.0), "acc@7 looks reversed");
}

const G: f64 = 1.0 / 9.806_65;

#[test]
fn g_on_a_beam() {
    named(&BEAM, Tests::Hammer, as_is, ("acc@11", G), "acc@11 reads 9.81 times too small: g read as m/s^2?");
}

#[test]
fn g_on_a_chain() {
    named(&CHAIN, Tests::Decay, as_is, ("acc@2", G), "acc@2 reads 9.81 times too small: g read as m/s^2?");
}

#[test]
fn millimetres() {
    let large = "acc@4 reads 1000 times too large: mm/s^2 read as m/s^2, or mg as g?";
    named(&CHAIN, Tests::Both, as_is, ("acc@4", 1e3), large);
}

fn exchanged_cables_of_the_beam(tests: Tests) {
    let cables = |header: &str| exchanged(header, "acc@5", "acc@11");
    named(&BEAM, tests, cables, ("none", 1.0), "acc@11 and acc@5 look exchanged");
}

#[test]
fn exchanged_cables_of_a_beam() {
    exchanged_cables_of_the_beam(Tests::Decay);
}

#[test]
#[ignore = "half a minute: decays and hammers together; the test above has decays alone"]
fn exchanged_cables_of_a_beam_in_decays_and_hammers() {
    exchanged_cables_of_the_beam(Tests::Both);
}

#[test]
fn exchanged_cables_of_a_chain() {
    let cables = |header: &str| exchanged(header, "acc@1", "acc@4");
    named(&CHAIN, Tests::Decay, cables, ("none", 1.0), "acc@4 and acc@1 look exchanged");
}

#[test]
fn a_sensor_elsewhere() {
    let sensor = |header: &str| header.replace("acc@11", "acc@9");
    let place = "acc@9 fits the motion of the model at DOF 11: is the sensor there?";
    named(&BEAM, Tests::Hammer, sensor, ("none", 1.0), place);
}

#[test]
fn a_force_elsewhere() {
    let force = |header: &str| header.replace("force@15", "force@11");
    named(
        &BEAM,
        Tests::Hammer,
        force,
        ("none", 1.0),
        "force@11 fits the motion of the model at DOF 15: was the force there?",
    );
}

#[test]
fn a_gain() {
    named(&BEAM, Tests::Hammer, as_is, ("acc@15", 1.6), "acc@15 reads 1.6 times too large");
}

/// What all motions have in common, no decay tells: nothing is said of it there. One channel is never enough.
#[test]
fn what_cannot_be_told_is_not_said() {
    let folder = CHAIN.recorded(Tests::Decay, 1.01, None);
    for column in ["acc@1", "acc@2", "acc@3", "acc@4"] {
        spoiled(folder.path(), as_is, column, 1e3);
    }
    assert!(words(&said(folder.path()).0).is_empty());
    let alone = Specimen { sensors: &[3], ..CHAIN };
    let folder = alone.recorded(Tests::Both, 1.01, None);
    spoiled(folder.path(), as_is, "acc@3", -9.8);
    assert!(words(&said(folder.path()).0).is_empty());
}

/// A sound project raises no alarm.
fn is_sound(specimen: &Specimen, (tests, factor): (Tests, f64), hidden: Option<usize>) {
    let folder = specimen.recorded(tests, factor, hidden);
    let document = diagnosed(&[], &[&folder.path().join("project.toml")]);
    assert!(words(&document).is_empty(), "{factor} {hidden:?}: {:?}", words(&document));
}

#[test]
fn a_sound_chain_raises_no_alarm() {
    is_sound(&CHAIN, (Tests::Both, 1.01), Some(1));
}

#[test]
fn sound_hammers_on_a_beam_raise_no_alarm() {
    is_sound(&BEAM, (Tests::Hammer, 0.98), None);
}

#[test]
fn sound_decays_of_a_beam_raise_no_alarm() {
    is_sound(&BEAM, (Tests::Decay, 1.02), Some(1));
}

#[test]
#[ignore = "a minute: all kinds of tests of both structures, with an effect hidden and without"]
fn no_sound_channel_raises_an_alarm() {
    for test in [(Tests::Hammer, 0.98), (Tests::Decay, 1.02), (Tests::Both, 1.01)] {
        for (specimen, hidden) in [(&CHAIN, Some(1)), (&BEAM, None), (&CHAIN, None), (&BEAM, Some(1))] {
            is_sound(specimen, test, hidden);
        }
    }
}
