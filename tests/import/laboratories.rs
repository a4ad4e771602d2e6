//! Files as the programs of laboratories write them, header and all, of the test of `dialects`.

use super::dialects::{C, G, coefficient, lines, right, rows, sample};
use super::{dashpot, imported, json};
use std::f64::consts::TAU;

/// A record over time as data set 58 in text, at node 1 in z; `quantity` 12 for an acceleration, 13 for a force.
fn record(quantity: u32, unit: &str, values: &[f64]) -> String {
    let ids = "NONE\n".repeat(5);
    let dofs = format!("{:5}{:10}{:5}{:10} {:10}{:10}{:4} {:10}{:10}{:4}", 1, 1, 1, 0, "NONE", 1, 3, "NONE", 0, 0);
    let form = format!("{:10}{:10}{:10}{:13.5e}{:13.5e}{:13.5e}", 4, values.len(), 1, 0.0, 1e-3, 0.0);
    let axis = |kind: u32, unit: &str| format!("{kind:10}{:5}{:5}{:5} {:20} {unit:20}\n", 0, 0, 0, "NONE");
    let axes = axis(17, "s") + &axis(quantity, unit) + &axis(0, "NONE") + &axis(0, "NONE");
    let numbers: String = values.iter().map(|value| format!("{value:20.12e}\n")).collect();
    format!("    -1\n    58\n{ids}{dofs}\n{form}\n{axes}{numbers}    -1\n")
}

#[test]
fn records_that_a_universal_file_repeats_are_further_runs() {
    let folder = tempfile::tempdir().unwrap();
    let column = |which: usize, size: f64| (0..700).map(|i| size * sample(i)[which]).collect::<Vec<f64>>();
    let run = |size| record(13, "N", &column(1, size)) + &record(12, "m/s^2", &column(3, size));
    let text = [1.0, 2.0, 3.0].map(run).concat();
    let (said, project) = imported(folder.path(), "runs.uff", &text, &[]);
    assert!(said.contains("3 runs of 2 channels"), "{said}");
    assert!(project.contains("sets = [\"3 (58) time response\", \"4 (58) time response\"]"), "{project}");
    assert!((coefficient(folder.path()) / C - 1.0).abs() < 1e-3);
    let out = folder.path().join("project.toml").display().to_string();
    let energies: Vec<f64> = json(&["identify", "--json", &out])["runs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|run| run["input_energy_j"].as_f64().unwrap())
        .collect();
    assert!((energies[1] / energies[0] - 4.0).abs() < 1e-3 && (energies[2] / energies[0] - 9.0).abs() < 1e-3);
    // Denominators that are filled in where a record has none.
    let none = format!("{:10}{:5}{:5}{:5} {:20} {:20}", 0, 0, 0, 0, "NONE", "NONE");
    let filled = text.replace(&none, &none.replace("NONE                 NONE", "NONE                 N   "));
    assert_ne!(filled, text);
    let (_, project) = imported(folder.path(), "filled.uff", &filled, &[]);
    assert!(!project.contains("factor") && !project.contains("unit"), "{project}");
    let (_, project) = imported(folder.path(), "runs.uff", &text, &[]);
    // A set too few, and both ways of saying it.
    for (from, to, problem) in [
        (", \"4 (58) time response\"]", "]", "names 1 sets, one for each of the 2 [[channel]] is needed"),
        ("sets = [\"3", "set = \"x\"\nsets = [\"3", "`set` and `sets` both say where the channels are"),
        ("[\"3 (58)", "[\"9 (58)", "the file has no set \"9 (58) time response\""),
    ] {
        std::fs::write(&out, project.replacen(from, to, 1)).unwrap();
        let error = dashpot(&["identify", &out]).unwrap_err();
        assert!(error.contains(problem) && !error.contains('\n'), "{error}");
    }
}

#[test]
fn headers_that_label_their_lines_are_read_through() {
    let mobility = |f: f64, [re, im]: [f64; 2]| [im / (TAU * f), -re / (TAU * f)];
    let polytec = "Source File Name:\tScan.svd\nPoint Index:\t1\nComponent:\tRoot\n\
                   Signal:\tFFT - H1 Vib Velocity / Ref1 Force - Real & Imaginary\n\n";
    let parts = lines(|f, h| {
        let [re, im] = mobility(f, h);
        format!("{f}\t{re}\t{im}")
    });
    right(&format!("{polytec}Frequency\tReal\tImaginary\n[ Hz ]\t[ m/s/N ]\t[ m/s/N ]\n{parts}"), &[]);
    let polar = lines(|f, h| {
        let [re, im] = mobility(f, h);
        format!("{f}\t{}\t{}", 1e3 * re.hypot(im), im.atan2(re).to_degrees())
    });
    right(&format!("{polytec}Frequency\tMagnitude\tPhase\n[ Hz ]\t[ mm/s / N ]\t[ ° ]\n{polar}"), &[]);
    let numbered = lines(|f, [re, im]| format!("{}\t{f}\t{re:.9e}\t{im:.9e}", 4.0 * (f - 5.0) + 1.0));
    let pulse =
        "Title1:\tFrequency Response H1(Acc,Force)\nX-Axis:\tFrequency\tHz\t\nY-Axis:\t[(m/s²)/N]\nHeader Size:\t7\n";
    right(&format!("{pulse}{}", numbered.replace('.', ",")), &[]);
    let listed =
        "Filename: beam\nAbscissa: Time [s]\nDelta Time: 0.001\n1. Channel: Force [N]\n2. Channel: Acc 1 [m/s²]\n\n";
    right(&format!("{listed}{}", rows(|[t, f, _, a]| format!("{t}\t{f}\t{a}"))), &[]);
    let analyser = lines(|f, [re, im]| format!("{f},{},{},0.999", re.hypot(im) / G, im.atan2(re).to_degrees()));
    let names = "\"Frequency (Hz)\",\"H1,1(f) Magnitude (g/N)\",\"H1,1(f) Phase (deg)\",\"C1,1(f)\"";
    let (_, project) = right(&format!("{names}\n{analyser}"), &["--averages", "8"]);
    assert!(project.contains("averages = 8"), "{project}");
}

#[test]
fn times_since_1970_are_in_the_unit_of_their_size() {
    let stamped =
        |scale: f64| rows(|[t, f, _, a]| format!("{},{f},{a}", (1_709_294_400.0 * scale + (t * scale).round()) as i64));
    right(&format!("timestamp_ms,force_N,acc_m_s2\n{}", stamped(1e3)), &[]);
    right(&format!("timestamp_ns,force_N,acc_m_s2\n{}", stamped(1e9)), &[]);
    right(&format!("timestamp,force_N,acc_m_s2\n{}", stamped(1e6)), &[]);
}

#[test]
fn rows_without_numbers_at_the_ends_are_left_out_and_said() {
    let good = || rows(|[t, f, _, a]| format!("{t},{f},{a}"));
    let front = "-0.002,NaN,NaN\n-0.001,NaN,NaN\n";
    let text = format!("Time [s],Force [N],Acc [m/s^2]\n{front}{}0.7,#N/A,#N/A\n", good());
    let folder = tempfile::tempdir().unwrap();
    imported(folder.path(), "a.csv", &text, &[]);
    assert!((coefficient(folder.path()) / C - 1.0).abs() < 1e-3);
    let listed = dashpot(&["contents", &folder.path().join("a.csv").display().to_string()]).unwrap();
    assert!(listed.contains("2 rows at the start and 1 at the end have no numbers (NaN)"), "{listed}");
    // Within the record, or of one channel alone, it is an error as before.
    let one = text.replacen("-0.002,NaN,NaN", "-0.002,1.0,NaN", 1);
    std::fs::write(folder.path().join("a.csv"), one).unwrap();
    let file = folder.path().join("a.csv").display().to_string();
    let error = dashpot(&["import", &file, "--propose"]).and_then(|_| dashpot(&["import", &file])).unwrap_err();
    assert!(error.contains("is NaN") && !error.contains('\n'), "{error}");
}

#[test]
fn channels_of_one_name_are_told_apart() {
    let text = format!(
        "Time [s],Force [N],Acc [g],Acc [g]\n{}",
        rows(|[t, f, _, a]| format!("{t},{f},{},{}", a / G, a / G / 2.0))
    );
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "a.csv", &text, &[]);
    assert!(said.contains("1 run of 3 channels"), "{said}");
    assert!(project.contains("name = \"Acc\"") && project.contains("name = \"Acc (2)\""), "{project}");
}

#[test]
fn a_reference_without_a_place_acts_at_the_first_response() {
    let header = "    -1\n    58\nFRF\nNONE\nNONE\nNONE\nNONE\n    4         1    1         0 Vib                1   3 Ref1               0   0\n";
    let axis = |kind: u32, unit: &str| format!("{kind:10}    0    0    0 {:20} {unit:20}\n", "NONE");
    let axes = axis(18, "Hz") + &axis(12, "m/s^2") + &axis(13, "N") + &axis(0, "NONE");
    let form = format!("{:10}{:10}{:10}{:13.5e}{:13.5e}{:13.5e}\n", 6, 160, 1, 5.0, 0.25, 0.0);
    let values = lines(|_, [re, im]| format!("{re:20.12e}{im:20.12e}"));
    let folder = tempfile::tempdir().unwrap();
    let (said, project) = imported(folder.path(), "scan.uff", &format!("{header}{form}{axes}{values}    -1\n"), &[]);
    assert!(said.contains("the file says no place of its reference"), "{said}");
    assert!(project.contains("= \"1z\""), "{project}");
    assert!((coefficient(folder.path()) / C - 1.0).abs() < 1e-3);
}
