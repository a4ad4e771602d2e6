//! Exports of programs nobody here has: points named in ID lines alone, amplitudes and phases of stepped sines, columns that count
//! rows.

use super::onto_model::{BEAM, C, onto, recorded};
use super::{dashpot, imported, json};
use std::collections::BTreeMap;
use std::path::Path;
use uff::{Dof, Set};

fn identified(folder: &Path) -> (String, f64) {
    let found = json(&["identify", "--json", &folder.join("p.toml").display().to_string()]);
    let source = &found["sources"][0];
    (source["dofs"][0].as_str().unwrap().to_owned(), source["parameters"]["c"].as_f64().unwrap())
}

/// A roving hammer, one file a hit, whose functions name their points in the first ID line and have node 0 in all fields.
#[test]
fn points_in_id_lines_of_universal_files_place_a_roving_hammer() {
    let folder = tempfile::tempdir().unwrap();
    let hidden = format!("[[source]]\nlaw = \"viscous\"\ndofs = [\"5z\"]\nstate = \"known\"\nc = {C}\n");
    let channels =
        "channels = [\"force@7 [N]\", \"force@15 [N]\", \"force@19 [N]\", \"acc@11 [m/s^2]\", \"acc@19 [m/s^2]\"]";
    let truth = format!(
        "[project]\nformat = 1\n{BEAM}{hidden}[[frf]]\nfile = \"all.uff\"\naverages = 8\nband = [0, 250]\n[simulate]\nsamples = 1001\n{channels}\n"
    );
    let [truth_file, out] = ["truth.toml", ""].map(|name| folder.path().join(name).display().to_string());
    std::fs::write(&truth_file, truth).unwrap();
    dashpot(&["simulate", "--noise", "0.01", "--seed", "4", "--as", "frf", "--out", &out, &truth_file]).unwrap();
    let mut hits: BTreeMap<i64, Vec<Set>> = BTreeMap::new();
    for read in uff::File::open(folder.path().join("all.uff")).unwrap().read_all() {
        let Set::Function(mut function) = read.unwrap().set else { continue };
        let header = &mut function.header;
        let (response, reference) = (header.response.node, header.reference.node);
        header.id[0] = format!("H1 Acc_{response}:+Z / Ham_{reference}:+Z");
        header.id[2] = "21/03/24 10:11:12".to_owned();
        (header.response, header.reference) = (Dof::default(), Dof::default());
        hits.entry(reference).or_default().push(Set::Function(function));
    }
    assert_eq!(hits.keys().copied().collect::<Vec<_>>(), [4, 8, 10]);
    let write = |(hit, sets): (&i64, &Vec<Set>)| {
        let path = folder.path().join(format!("hit {hit}.uff"));
        std::fs::write(&path, uff::to_bytes(sets).unwrap()).unwrap();
        path.display().to_string()
    };
    let files: Vec<String> = hits.iter().map(write).collect();
    let (said, project) = onto(folder.path(), &files, BEAM).unwrap();
    assert!(said.starts_with("6 functions at 4 DOFs"), "{said}");
    assert_eq!(project.matches("[[frf]]").count(), 3, "{project}");
    let (dof, c) = identified(folder.path());
    assert!(dof == "9" && (c / C - 1.0).abs() < 0.02, "{dof} {c}");
}

/// Amplitudes and phases of several responses, a file a level, as a controller exports them below lines of its own.
#[test]
fn amplitudes_and_phases_of_several_responses_are_a_stepped_sine() {
    let folder = tempfile::tempdir().unwrap();
    recorded(folder.path(), "time [s],force@19 [N],acc@7 [m/s^2],acc@15 [m/s^2],acc@19 [m/s^2]");
    let mut rows = Vec::new();
    for i in 0..4 {
        let [from, to] = [format!("r{i}.csv"), format!("h{i}.csv")].map(|name| folder.path().join(name));
        let [from, to] = [&from, &to].map(|path| path.display().to_string());
        let project = folder.path().join("truth.toml");
        let frequency = ["9.9", "10.5", "65", "66.5"][i];
        dashpot(&["convert", &from, &to, "--as", "harmonics", "--frequency", frequency, "--harmonics", "1"]).unwrap();
        let text = std::fs::read_to_string(&to).unwrap();
        let mut parts: BTreeMap<String, [f64; 2]> = BTreeMap::new();
        for line in text.lines().skip(1) {
            let cells: Vec<&str> = line.split(',').map(|cell| cell.trim_matches('"')).collect();
            parts.insert(cells[2].to_owned(), [cells[4].parse().unwrap(), cells[5].parse().unwrap()]);
        }
        let polar = |name: &str| {
            let [cos, sin] = parts.iter().find(|(own, _)| own.starts_with(name)).unwrap().1;
            (cos.hypot(*sin), (-sin).atan2(*cos).to_degrees())
        };
        let (force, zero) = polar("force@19");
        // Amplitudes in g, phases over the force, the first column of the phases behind all amplitudes.
        let motions = ["acc@7", "acc@15", "acc@19"].map(polar);
        let cells: Vec<String> = motions.iter().map(|(size, _)| format!("{:.9}", size / 9.80665)).collect();
        let phases: Vec<String> = motions.iter().map(|(_, phase)| format!("{:.7}", phase - zero)).collect();
        rows.push((
            force,
            format!("{frequency};{force:.9};{};{}", cells.join(";"), phases.join(";")).replace('.', ","),
        ));
        assert!(project.exists());
    }
    let head = "Step sine result;;\nOperator;XY;\n\nFreq (Hz);Force 10 (N);Acc 4 (g);Acc 8 (g);Acc 10 (g);Phase 4 (deg);Phase 8 (deg);Phase 10 (deg)\n";
    let file = |name: &str, rows: &[(f64, String)]| {
        let text: Vec<&str> = rows.iter().map(|(_, row)| row.as_str()).collect();
        let path = folder.path().join(name);
        std::fs::write(&path, format!("{head}{}\n", text.join("\n"))).unwrap();
        path.display().to_string()
    };
    let files = [file("low.csv", &rows[..2]), file("high.csv", &rows[2..])];
    let (said, project) = onto(folder.path(), &files, BEAM).unwrap();
    assert!(said.contains("amplitudes and phases of 4 runs in 2 tables at 1 level"), "{said}");
    assert!(project.contains("[harmonics.phases]\n\"Acc 10\" = \"Phase 10\""), "{project}");
    let (dof, c) = identified(folder.path());
    assert!(dof == "9" && (c / C - 1.0).abs() < 0.02, "{dof} {c}");
    // Each fault is one line that says how to mend it.
    let p = folder.path().join("p.toml");
    let refused = |from: &str, to: &str| {
        std::fs::write(&p, project.replace(from, to)).unwrap();
        dashpot(&["identify", &p.display().to_string()]).unwrap_err()
    };
    let gone = refused("= \"Phase 10\"", "= \"Phase 11\"");
    assert!(gone.contains("low.csv") && gone.contains("Phase 11") && !gone.trim().contains('\n'), "{gone}");
    let unphased = refused("\"Acc 10\" = \"Phase 10\"\n", "");
    assert!(unphased.contains("\"Acc 10\"") && unphased.contains("has no phase"), "{unphased}");
    let set = refused("level = 1\n", "level = 1\nset = \"Sheet 9\"\n");
    assert!(set.contains("no set \"Sheet 9\""), "{set}");
}

/// The first column of an export without times counts its rows; the interval stands above.
#[test]
fn a_column_that_counts_rows_is_no_time() {
    let folder = tempfile::tempdir().unwrap();
    let row = |i: usize| {
        let t = i as f64 * 0.002;
        format!("{};{:.6};{:.6}\n", i + 1, (125.0 * t).cos(), 0.3 * (125.0 * t).sin()).replace('.', ",")
    };
    let rows: String = (0..500).map(row).collect();
    let head = "FAMOS;;\nAbtastintervall [ms];2,0;\nKanal;Kraft_P2;Acc_P2\nEinheit;N;m/s²\n";
    let (_, project) = imported(folder.path(), "s.csv", &format!("{head}{rows}"), &[]);
    assert!(project.contains("name = \"Kraft_P2\""), "{project}");
    let file = folder.path().join("s.csv").display().to_string();
    let set = &json(&["contents", "--json", &file])["sets"][0];
    assert_eq!(
        (set["channels"].as_array().unwrap().len(), set["channels"][0]["step"].as_f64()),
        (2, Some(0.002)),
        "{set}"
    );
    // Without the interval the rate is asked for: one sample a second is not assumed.
    std::fs::write(&file, format!("{}{rows}", head.replace("Abtastintervall [ms];2,0;\n", ""))).unwrap();
    let asked = dashpot(&["import", &file, "--out", &folder.path().join("q.toml").display().to_string()]).unwrap_err();
    assert!(asked.contains("--sampling-hz"), "{asked}");
    // The same in front of frequencies.
    let lines: String = (0..50)
        .map(|i| format!("{}\t{:.3}\t{:.5}\t0.1\n", i + 1, 1.0 + 0.5 * f64::from(i), 0.01 * f64::from(i)))
        .collect();
    let head =
        "Function: Frequency Response H1(Response 1,Force)\nLine\tX-axis [Hz]\tReal [(m/s²)/N]\tImaginary [(m/s²)/N]\n";
    std::fs::write(&file, format!("{head}{lines}")).unwrap();
    let set = &json(&["contents", "--json", &file])["sets"][0];
    assert_eq!((set["kind"].as_str(), set["channels"].as_array().unwrap().len()), (Some("frf"), 1), "{set}");
    // A unit that stands above for all functions.
    let lines: String = (0..50)
        .map(|i| format!("{:.3}\t{:.5}\t{:.2}\n", 1.0 + 0.5 * f64::from(i), -40.0 + f64::from(i), 3.0 * f64::from(i)))
        .collect();
    let head = "Amplitude unit: (m/s²)/N   dB reference: 1\n\nFrequency\tFRF 2:+Z/1:+Z (dB)\tFRF 2:+Z/1:+Z (Phase)\nHz\tdB\t°\n";
    std::fs::write(&file, format!("{head}{lines}")).unwrap();
    let set = &json(&["contents", "--json", &file])["sets"][0];
    assert_eq!(set["channels"][0]["unit"], "(m/s²)/N", "{set}");
}
