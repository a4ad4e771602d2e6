//! Laboratory files as runs: the mapping of a project against the project's own CSV, and what is refused.

use dashpot::control::Control;
use dashpot::exchange::mapping::propose;
use dashpot::exchange::project::{plan, template};
use dashpot::measurement::Record;
use std::path::Path;

const HEAD: &str = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0]\nground_stiffness = [1e4, 0.0]\ncoupling_stiffness = [1e4]\n";

/// Samples of three channels.
fn rows() -> impl Iterator<Item = (f64, f64, f64, f64)> {
    (0..64).map(|i| (f64::from(i) / 1024.0, f64::from(i % 7) / 8.0, f64::from(i % 5) / 16.0, f64::from(i % 3) / 4.0))
}

fn record(folder: &Path, tables: &str) -> Result<Record, String> {
    let path = folder.join("project.toml");
    let plan = plan(&format!("{HEAD}{tables}"), &path).map_err(|error| error.to_string())?;
    plan.record(0, &Control::unattended()).map_err(|error| error.to_string())
}

/// A German export: no unit in the names, a row of units, decimal commas, a reversed channel and one in g.
fn export(folder: &Path) {
    let mut text = "Versuch 7\n\nZeit;Kraft 1;Acc 1;Acc 2\ns;kN;g;m/s^2\n".to_owned();
    for (t, force, a, b) in rows() {
        text.push_str(&format!("{t};{};{};{}\n", force / 1000.0, a, -b).replace('.', ","));
    }
    std::fs::write(folder.join("lab.csv"), text).unwrap();
}

const MAP: &str = "
[[channel]]
name = \"Kraft 1\"
quantity = \"force\"
dof = 1
[[channel]]
name = \"Acc 1\"
quantity = \"acc\"
dof = 1
factor = 2.0
[[channel]]
name = \"Acc 2\"
quantity = \"acc\"
dof = 2
sign = -1
[[run]]
file = \"lab.csv\"
";

#[test]
fn a_mapped_file_is_the_record_that_a_csv_of_our_own_would_be() {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path());
    let mapped = record(folder.path(), MAP).unwrap();
    let mut text = "time [s],force@1 [kN],acc@1 [g],acc@2 [m/s^2]\n".to_owned();
    for (t, force, a, b) in rows() {
        text.push_str(&format!("{t},{},{},{b}\n", force / 1000.0, 2.0 * a));
    }
    std::fs::write(folder.path().join("own.csv"), text).unwrap();
    // The same project reads both: the names of the second are the project's own.
    let own = record(folder.path(), &MAP.replace("lab.csv", "own.csv")).unwrap();
    assert_eq!(mapped.channels(), own.channels());
    assert_eq!(mapped.time(), own.time());
    for channel in 0..3 {
        for (a, b) in mapped.samples(channel).iter().zip(own.samples(channel)) {
            assert!((a - b).abs() <= 1e-15 * b.abs(), "{a} {b}");
        }
    }
}

#[test]
fn what_cannot_be_mapped_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path());
    let fail = |from: &str, to: &str| {
        let error = record(folder.path(), &MAP.replace(from, to)).unwrap_err();
        assert!(!error.contains('\n'), "{error}");
        error
    };
    assert!(
        fail("\"Acc 2\"", "\"Acc 3\"").contains(
            "channel \"Acc 3\": the file has no channel of that name; it has \"Kraft 1\", \"Acc 1\", \"Acc 2\""
        )
    );
    assert!(fail("dof = 2\n", "dof = 5\n").contains("the structure has no DOF \"5\""));
    assert!(fail("sign = -1", "unit = \"mm\"").contains("`unit = \"mm\"` is not understood; use one of m/s^2"));
    assert!(fail("sign = -1", "sign = 2").contains("`sign = 2` is not a usable number; it must be 1 or -1"));
    assert!(fail("dof = 2\n", "dof = 1\n").contains("the channel acc@1 is given twice"));
    assert!(fail("quantity = \"force\"", "quantity = \"vel\"").contains("kN is not a unit of vel"));
    assert!(fail("file = \"lab.csv\"", "file = \"lab.csv\"\nset = \"B\"").contains("the file has no set \"B\""));
    assert!(
        fail("file = \"lab.csv\"", "file = \"lab.csv\"\nsampling_hz = 2000")
            .contains("is sampled at 1024 Hz and `sampling_hz` says 2000")
    );
    let written = |unit: &str| {
        let text = format!("Kraft 1 [N],Acc 1 [g],Acc 2 [{unit}]\n1,2,3\n2,3,4\n");
        std::fs::write(folder.path().join("lab.csv"), text).unwrap();
    };
    written("g");
    assert!(
        fail("x", "x").contains("the file does not say the time between samples; add `sampling_hz` to its [[run]]")
    );
    written("Volts");
    let volts = fail("file = \"lab.csv\"", "file = \"lab.csv\"\nsampling_hz = 2000");
    assert!(volts.contains("\"Volts\" is no known unit; add `unit` to its [[channel]]"), "{volts}");
    std::fs::write(
        folder.path().join("lab.csv"),
        "time [s],Acc 1 [g],Acc 1 [g],Acc 2 [g],Kraft 1 [N]\n1,2,3,4,5\n2,3,4,5,6\n",
    )
    .unwrap();
    // Names that stand twice are told apart, `Acc 1 (2)`: what is wrong here is something else.
    let twice = fail("x", "x");
    assert!(twice.contains("there are 2 samples; a record needs at least 5"), "{twice}");
}

#[test]
fn proposals_read_back_as_a_template() {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path());
    let file = dashpot_datafiles::open(&folder.path().join("lab.csv")).unwrap();
    let proposal = propose(file.contents());
    let names: Vec<String> = proposal.channels.iter().map(dashpot::exchange::mapping::ChannelTable::channel).collect();
    assert_eq!(names, ["force@1", "acc@1", "acc@2"]);
    let text = toml::to_string(&Tables { channel: &proposal.channels }).unwrap();
    assert_eq!(template(&text, "template.toml").unwrap(), proposal.channels);
}

#[derive(serde::Serialize)]
struct Tables<'a> {
    channel: &'a [dashpot::exchange::mapping::ChannelTable],
}

/// A file of two blocks, sets "1" and "2", with a channel `Acc` each; the sensor is reversed in the second.
fn two_sets(folder: &Path) {
    let block = |name: &str, sign: f64| {
        let lines = rows().map(|(t, force, a, _)| format!("{t},{force},{}\n", sign * a));
        format!("{name}\nTime [s],Force [N],Acc [m/s^2]\n{}\n", lines.collect::<String>())
    };
    std::fs::write(folder.join("two.csv"), block("Run 1", 1.0) + &block("Run 2", -1.0)).unwrap();
}

#[test]
fn one_name_in_two_sets_is_two_channels_each_for_its_runs() {
    let folder = tempfile::tempdir().unwrap();
    two_sets(folder.path());
    let force = "[[channel]]\nname = \"Force\"\nquantity = \"force\"\ndof = 1\n";
    let acc = |set: &str, dof: usize, more: &str| {
        format!("[[channel]]\nname = \"Acc\"\nset = \"{set}\"\nquantity = \"acc\"\ndof = {dof}\n{more}")
    };
    let run = |set: &str| format!("[[run]]\nfile = \"two.csv\"\nset = \"{set}\"\n");
    // One sensor at one DOF, whose sign is that of its set; then the sensor elsewhere in the second set.
    for (dof, sign) in [(1, "sign = -1\n"), (2, "sign = -1\n")] {
        for (set, at) in [("1", 1), ("2", dof)] {
            let tables = [force, &acc("1", 1, ""), &acc("2", dof, sign), &run(set)].concat();
            let found = record(folder.path(), &tables).unwrap();
            let names: Vec<String> = found.channels().iter().map(ToString::to_string).collect();
            assert_eq!(names, ["force@1".to_owned(), format!("acc@{at}")], "{set}");
            let same = rows().zip(found.samples(1)).all(|((_, _, a, _), read)| (a - read).abs() < 1e-15);
            assert!(same, "{set}: {:?}", &found.samples(1)[..8]);
        }
    }
    // Both at once, in a run that names no set.
    let forces = force.replace("\"Force\"", "\"Force\"\nset = \"1\"");
    let tables = [forces, acc("1", 1, ""), acc("2", 2, "sign = -1\n"), "[[run]]\nfile = \"two.csv\"\n".to_owned()];
    let found = record(folder.path(), &tables.concat()).unwrap();
    assert_eq!(found.channels().len(), 3);
    assert_eq!(found.samples(1), found.samples(2));
    // The same channel in the same set twice is refused as before.
    let twice = [force, &acc("1", 1, ""), &acc("1", 1, ""), &run("1")].concat();
    assert!(record(folder.path(), &twice).unwrap_err().contains("the channel acc@1"));
}

#[test]
fn a_sensitivity_is_read_however_its_attribute_is_spelt() {
    use dashpot_datafiles::{Axis, Channel, Contents, Format, Kind, Set};
    let factor = |word: &str, value: &str| {
        let channel = Channel {
            name: "Acc 3".to_owned(),
            unit: "V".to_owned(),
            count: 8,
            complex: false,
            axis: Axis::Even { start: 0.0, step: 1e-3 },
            first: Vec::new(),
            attributes: vec![(word.to_owned(), value.to_owned())],
        };
        let (name, axis_unit) = ("Run".to_owned(), "s".to_owned());
        let set = Set { name, kind: Kind::Time, axis_unit, channels: vec![channel], notes: Vec::new() };
        let proposal = propose(&Contents { format: Format::Tdms, sets: vec![set], notes: Vec::new() });
        let table = proposal.channels.into_iter().next().unwrap();
        (table.unit.unwrap(), table.factor.unwrap())
    };
    let expected = ("g".to_owned(), 10.0);
    for (word, value) in [
        ("sensitivity", "100 mV/g"),
        ("Sensitivity", "100 mV/g"),
        ("SENSITIVITY", "0.1 V/g"),
        ("Sensitivity (mV/g)", "100"),
        ("Sensor Sensitivity [mV/g]", "100.0"),
    ] {
        assert_eq!(factor(word, value), expected, "{word} = {value}");
    }
}
