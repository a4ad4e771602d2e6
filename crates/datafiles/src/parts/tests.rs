#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

use super::*;
use crate::{DataFile, open, open_paired};

/// Opens a text as a file.
fn file(text: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frf.csv");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn opened(text: &str) -> DataFile {
    let (_folder, path) = file(text);
    open(&path).unwrap()
}

fn values(file: &DataFile, channel: usize) -> Vec<[f64; 2]> {
    let Values::Complex(values) = file.read(0, channel).unwrap() else { panic!("not complex") };
    values
}

fn near(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9, "{found:?} {expected:?}");
    }
}

const EXPECTED: [[f64; 2]; 4] = [[0.0, 2.0], [-3.0, 0.0], [0.0, -1.0], [4.0, 0.0]];

#[test]
fn every_way_to_write_two_columns_gives_the_same_numbers() {
    let cartesian = ["0,2", "-3,0", "0,-1", "4,0"];
    let degrees = ["2,90", "3,180", "1,-90", "4,0"];
    let half = std::f64::consts::FRAC_PI_2;
    let radians = [format!("2,{half}"), format!("3,{}", 2.0 * half), format!("1,-{half}"), "4,0".to_owned()];
    let level = |size: f64, phase: f64| format!("{},{phase}", 20.0 * size.log10());
    let levels = [level(2.0, 90.0), level(3.0, 180.0), level(1.0, -90.0), level(4.0, 0.0)];
    let table = |header: &str, rows: &[String]| {
        let rows = rows.iter().enumerate().map(|(i, row)| format!("{},{row}\n", 10 + i)).collect::<String>();
        opened(&format!("{header}\n{rows}"))
    };
    let owned = |rows: [&str; 4]| rows.map(str::to_owned).to_vec();
    for (header, rows, unit) in [
        ("Frequency [Hz],H_7_1 Real [m/s^2/N],H_7_1 Imag [m/s^2/N]", owned(cartesian), "m/s^2/N"),
        ("f,re,im", owned(cartesian), ""),
        ("Freq (Hz),Magnitude (g/N),Phase (deg)", owned(degrees), "g/N"),
        ("Freq (Hz),|H|,arg(H)", owned(degrees), ""),
        ("Freq (Hz),|H| [mm/N],arg(H) [rad]", radians.to_vec(), "mm/N"),
        ("Freq (Hz),Mag,Phase", radians.to_vec(), ""),
        ("Frequenz in Hz,Betrag in (m/s²)/N,Phase in °", owned(degrees), "(m/s²)/N"),
        ("Freq (Hz),Mag [dB re 1 (m/s²)/N],Phase [deg]", levels.to_vec(), "(m/s²)/N"),
        ("Freq (Hz),Accelerance (dB),Phase (deg)", levels.to_vec(), ""),
        ("Freq (Hz),H 7/1 [g/N],Phase H 7/1 [deg]", owned(degrees), "g/N"),
    ] {
        let file = table(header, &rows);
        let set = &file.contents().sets[0];
        assert_eq!((set.kind, set.channels.len(), set.channels[0].unit.as_str()), (Kind::Frf, 1, unit), "{header}");
        near(&values(&file, 0), &EXPECTED);
        assert_eq!(file.axis(0, 0).unwrap().unwrap(), [10.0, 11.0, 12.0, 13.0]);
    }
}

#[test]
fn many_columns_are_paired_by_name_and_order_and_coherences_stay() {
    let file = opened(
        "Freq;Re(H 3/1);Re(H 5/1);Im(H 3/1);Im(H 5/1);Coherence 3/1\n1;1;2;3;4;0.9\n2;1;2;3;4;0.9\n3;1;2;3;4;0.9\n",
    );
    let set = &file.contents().sets[0];
    assert_eq!(set.channels.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["H 3/1", "H 5/1", "Coherence 3/1"]);
    near(&values(&file, 1), &[[2.0, 4.0]; 3]);
    let file = opened("Freq;Re;Im;Re;Im\n1;1;3;2;4\n2;1;3;2;4\n");
    near(&values(&file, 1), &[[2.0, 4.0]; 2]);
    assert_eq!(file.contents().sets[0].channels[1].name, "FRF 2");
}

#[test]
fn what_is_no_response_is_left_as_it_is() {
    for text in [
        "Frequency [Hz],Force [N],Acceleration [g],Phase [deg]\n1,1,2,3\n2,1,2,3\n3,1,2,3\n",
        "Frequency [Hz],force@1 [N],acc@1 [g],phase_deg acc@1\n1,1,2,3\n2,1,2,3\n3,1,2,3\n",
        "time [s],Real,Phase\n1,1,2\n2,1,2\n3,1,2\n",
        "Frequency [Hz],PSD [g^2/Hz],Coherence\n1,1,1\n2,1,1\n",
    ] {
        let file = opened(text);
        assert!(file.contents().sets[0].channels.iter().all(|channel| !channel.complex), "{text}");
    }
}

#[test]
fn columns_without_names_are_paired_where_the_user_says_so() {
    let (_folder, path) = file("10 2 90 3 180\n11 1 -90 4 0\n12 1 -90 4 0\n");
    let file = open_paired(&path, Pairing::MagnitudeDegrees).unwrap();
    assert_eq!((file.contents().sets[0].kind, file.contents().sets[0].axis_unit.as_str()), (Kind::Frf, "Hz"));
    near(&values(&file, 0)[..2], &[[0.0, 2.0], [0.0, -1.0]]);
    near(&values(&file, 1)[..2], &[[-3.0, 0.0], [4.0, 0.0]]);
    assert_eq!(file.axis(0, 1).unwrap().unwrap(), [10.0, 11.0, 12.0]);
    let words: Vec<_> = Pairing::WORDS.iter().map(|word| Pairing::from_word(word).unwrap().word()).collect();
    assert_eq!(words, Pairing::WORDS);
}

#[test]
fn one_unit_for_all_functions_is_that_of_levels_and_parts() {
    let unit_of = |name: &str, unit: &str| unit_of_part(name, &[unit.to_owned()]);
    assert_eq!(unit_of("H1_dB", "(m/s²)/N").as_deref(), Some("dB re (m/s²)/N"));
    assert_eq!(unit_of("H1_phase_deg", "(m/s²)/N").as_deref(), Some(""));
    assert_eq!(unit_of("Coherence", "(m/s²)/N").as_deref(), Some(""));
    assert_eq!(unit_of("Re(H)", "g/N").as_deref(), Some("g/N"));
    assert_eq!((unit_of("H1_dB", "m"), unit_of("temperature", "g/N"), unit_of_part("H1_dB", &[])), (None, None, None));
}
