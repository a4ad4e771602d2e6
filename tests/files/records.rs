//! Time records and harmonics in CSV: what is understood, and what each fault is called.

use crate::common::models::cantilever;
use dashpot::control::Control;
use dashpot::exchange::records::{
    parse_harmonics, parse_record, read_harmonics, read_record, read_record_with, write_harmonics, write_record,
};
use dashpot::measurement::{Quantity, Record, fit};
use dashpot::structure::Structure;
use dashpot::structure::points::PointParameters;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Translations `1` and `3`, rotations `2` and `4`.
fn beam() -> Structure {
    cantilever(2)
}

fn points() -> Structure {
    PointParameters { dofs: vec!["tip".to_owned(), "1".to_owned()], positions: None }.build().unwrap()
}

const ROWS: &str = "0,1,2\n0.1,3,4\n0.2,5,6\n0.3,7,8\n0.4,9,10\n";

fn read(text: &str) -> Record {
    parse_record(text.as_bytes(), "run.csv", &beam(), &Control::unattended()).unwrap_or_else(|error| panic!("{error}"))
}

fn message(text: &[u8]) -> String {
    parse_record(text, "run.csv", &beam(), &Control::unattended()).unwrap_err().to_string()
}

#[test]
fn the_plain_form_is_read_in_si() {
    let record = read(&format!("time [s],force@1 [kN],acc@3 [g]\n{ROWS}"));
    assert_eq!(record.time(), [0.0, 0.1, 0.2, 0.3, 0.4]);
    assert_eq!(record.samples(0), [1000.0, 3000.0, 5000.0, 7000.0, 9000.0]);
    assert_eq!(record.samples(1)[1], 4.0 * 9.80665);
    let channel = &record.channels()[1];
    assert_eq!((channel.quantity, channel.dof, channel.label.as_str()), (Quantity::Acceleration, 2, "3"));
}

#[test]
fn odd_forms_say_the_same() {
    let plain = read(&format!("time [s],force@1 [N],vel@3 [mm/s]\n{ROWS}"));
    let forms = [
        format!("\u{feff}time [s],force@1 [N],vel@3 [mm/s]\n{ROWS}"),
        format!("time [s],force@1 [N],vel@3 [mm/s]\r\n{}", ROWS.replace('\n', "\r\n")),
        format!("time [s];force@1 [N];vel@3 [mm/s]\n{}", ROWS.replace(',', ";")),
        format!("time [s];force@1 [N];vel@3 [mm/s]\n{}", ROWS.replace(',', ";").replace('.', ",")),
        format!("time [s]\tforce@1 [N]\tvel@3 [mm/s]\n{}", ROWS.replace(',', "\t").replace('.', ",")),
        format!("\"time [s]\",\"force@1 [N]\",\"vel@3 [mm/s]\"\n{ROWS}"),
        format!("\n\n Time[s] , FORCE @ 1[N] , Vel@3  [ mm/s ] \n\n{}\n\n", ROWS.replace('\n', "\n\n")),
        format!("time [s],force@1 [N],vel@3 [mm/s],\n{}", ROWS.replace('\n', ",\n")),
        format!("time [s],force@1 [N],vel@3 [mm/s]\n{}", ROWS.replace('\n', ",,\n")),
        format!("time [s],force@1 [N],vel@3 [mm/s]\n{}", ROWS.trim_end()),
        format!("time [s],force@1 [N],vel@3 [mm/s]\n{}", ROWS.replace("0.1", " +1.0e-1 ").replace("10\n", "1E1\n")),
    ];
    for (k, form) in forms.iter().enumerate() {
        let record = read(form);
        assert_eq!((record.time(), record.channels()), (plain.time(), plain.channels()), "form {k}");
        assert_eq!([record.samples(0), record.samples(1)], [plain.samples(0), plain.samples(1)], "form {k}");
    }
}

#[test]
fn rotations_and_points_have_their_units() {
    let record = read(&format!("time [s],force@2 [N],acc@4 [rad/s^2]\n{ROWS}"));
    assert_eq!(record.channels()[1].dof, 3);
    let text = format!("time [s],force@tip [N],acc@1 [rad/s^2]\n{ROWS}");
    assert_eq!(
        parse_record(text.as_bytes(), "run.csv", &points(), &Control::unattended()).unwrap().channels()[0].dof,
        0
    );
}

#[test]
#[expect(clippy::too_many_lines, reason = "one line for each bad file")]
fn bad_files_are_named_in_one_line() {
    let header = "time [s],force@1 [N],acc@3 [m/s^2]\n";
    let rows = |from: &str, to: &str| format!("{header}{}", ROWS.replace(from, to));
    let with_header = |header: &str| format!("{header}\n{ROWS}");
    let cases: Vec<(String, &str)> = vec![
        (String::new(), "run.csv: is empty; export the record again"),
        (" \n\r\n\n".to_owned(), "run.csv: is empty; export the record again"),
        (header.to_owned(), "run.csv: only the header is there; export the record with its samples"),
        (
            ROWS.to_owned(),
            "run.csv, line 1: there is no header row; write time [s] and one QUANTITY@DOF [UNIT] a channel above the numbers",
        ),
        (
            with_header("force@1 [N],acc@3 [g],time [s]"),
            "run.csv, line 1: the first column is \"force@1 [N]\"; it must be the time in seconds, named time [s]",
        ),
        (
            with_header("time [ms],force@1 [N],acc@3 [g]"),
            "run.csv, line 1: the time is in \"ms\"; give it in seconds and name it time [s]",
        ),
        (
            with_header("time,force@1 [N],acc@3 [g]"),
            "run.csv, line 1: the time has no unit; name it time [s] where it is in seconds, with the units of the other columns in their names too",
        ),
        (
            "time [s]\n0\n1\n".to_owned(),
            "run.csv, line 1: the only column is the time; separate the columns by commas and name one QUANTITY@DOF [UNIT] a channel",
        ),
        (
            "time [s],\"force@1 [N],acc@3 [g]\n0,1,2\n1,1,2\n2,1,2\n".to_owned(),
            "run.csv, line 1: the quotation mark of \"force@1 [N],acc@3 [g]\" is not closed on its line; close or remove it",
        ),
        (
            with_header("time [s],force@1,acc@3 [g]"),
            "run.csv, line 1, force@1: \"force@1\" has no unit; add one in brackets: N, kN, lbf, N m",
        ),
        (
            with_header("time [s],force@1 [lb],acc@3 [g]"),
            "run.csv, line 1, force@1 [lb]: \"lb\" is not a unit; those of force are N, kN, lbf, N m",
        ),
        (
            with_header("time [s],force@1 [g],acc@3 [g]"),
            "run.csv, line 1, force@1 [g]: g is not a unit of force; those are N, kN, lbf, N m",
        ),
        (
            with_header("time [s],strain@1 [g],acc@3 [g]"),
            "run.csv, line 1, strain@1 [g]: \"strain\" is not a quantity; use force, acc, vel, disp or base",
        ),
        (
            with_header("time [s],channel 1,acc@3 [g]"),
            "run.csv, line 1, channel 1: \"channel 1\" is not a channel; write QUANTITY@DOF [UNIT], such as acc@7 [m/s^2]",
        ),
        (
            with_header("time [s],,acc@3 [g]"),
            "run.csv, line 1: column 2 has no name; name it QUANTITY@DOF [UNIT], such as acc@7 [m/s^2]",
        ),
        (
            with_header("time [s],acc@ [g],acc@3 [g]"),
            "run.csv, line 1, acc@ [g]: \"acc@\" names no DOF; write its label after the @, such as acc@7",
        ),
        (
            with_header("time [s],force@1 [N],acc@9 [g]"),
            "run.csv, line 1, acc@9 [g]: the structure has no DOF \"9\"; it has 1, 2, 3, 4",
        ),
        (
            with_header("time [s],force@1 [N],acc@4 [g]"),
            "run.csv, line 1, acc@4 [g]: DOF 4 is a rotation and cannot be measured in g; use one of rad/s^2",
        ),
        (
            with_header("time [s],force@1 [N],disp@3 [rad]"),
            "run.csv, line 1, disp@3 [rad]: DOF 3 is a translation and cannot be measured in rad; use one of m, mm, um",
        ),
        (with_header("time [s],acc@3 [g],acc@3 [m/s^2]"), "run.csv, line 1: acc@3 stands twice; remove or rename one"),
        (
            rows("0.2,5,6", "0.2,5"),
            "run.csv, line 4: there are 2 cells and the header has 3; give each row one cell a column",
        ),
        (
            rows("0.2,5,6", "0.2,5,6,7"),
            "run.csv, line 4: there are 4 cells and the header has 3; give each row one cell a column; with a decimal comma, separate the columns by semicolons",
        ),
        (
            rows("0.2,5,6", "0.2,,6"),
            "run.csv, line 4, force@1 [N]: the cell is empty; write its number or remove the row",
        ),
        (
            rows("0.2,5,6", "0.2,5,"),
            "run.csv, line 4, acc@3 [m/s^2]: the cell is empty; write its number or remove the row",
        ),
        (
            rows("0.2,5,6", "0.2,five,6"),
            "run.csv, line 4, force@1 [N]: \"five\" is not a number; write one such as 1.25e-3",
        ),
        (
            rows("0.2,5,6", "0.2,NaN,6"),
            "run.csv, line 4, force@1 [N]: NaN is not a finite number; remove the row or mend the number",
        ),
        (
            rows("0.2,5,6", "0.2,5,-inf"),
            "run.csv, line 4, acc@3 [m/s^2]: -inf is not a finite number; remove the row or mend the number",
        ),
        (
            rows("0.2,5,6", "0.2,1e999,6"),
            "run.csv, line 4, force@1 [N]: 1e999 is not a finite number; remove the row or mend the number",
        ),
        (rows("0.2,5,6", "0.05,5,6"), "run.csv, line 4, time [s]: time 0.05 s follows 0.1 s; sort the rows by time"),
        (
            rows("0.4,9,10\n", "\n\nx,9,10\n"),
            "run.csv, line 8, time [s]: \"x\" is not a number; write one such as 1.25e-3",
        ),
        (rows("0.2,5,6", "0.1,5,6"), "run.csv: 1 of 4 times equal the one before; write the time with more digits"),
        (rows("0.4,9,10\n", ""), "run.csv: there are 4 samples; a record needs at least 5"),
        (
            format!("{header}{}", ROWS.replace("0.2,5,6", "0.2,\"5\n,6")),
            "run.csv, line 4: there are 2 cells and the header has 3; give each row one cell a column",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(message(text.as_bytes()), expected, "{text}");
    }
}

#[test]
fn what_is_no_text_is_named() {
    let text = format!("time [s],force@1 [N]\n{ROWS}");
    let wide: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let utf16 = "run.csv: is UTF-16 text; save it as CSV in UTF-8";
    assert_eq!(message(&wide), utf16);
    assert_eq!(message(&[&[0xFF, 0xFE], wide.as_slice()].concat()), utf16);
    assert_eq!(message(b"PK\x03\x04\x00\x00\x08\x00\x00\x12\x34"), "run.csv: is not text; export it as CSV in UTF-8");
    let latin = b"time [s],disp@1 [\xb5m]\n0,1\n";
    assert_eq!(message(latin), "run.csv, line 1: the header is not UTF-8; save the file as CSV in UTF-8");
    let missing = read_record(std::path::Path::new("no/such.csv"), &beam()).unwrap_err().to_string();
    assert!(missing.starts_with("no/such.csv: cannot be read: "), "{missing}");
}

#[test]
fn reading_reports_and_can_be_cancelled() {
    let mut text = "time [s],force@1 [N]\n".to_owned();
    for n in 0..20_000 {
        text.push_str(&format!("{n},{}\n", n % 7));
    }
    let path = tempfile::NamedTempFile::new().unwrap().into_temp_path();
    std::fs::write(&path, text).unwrap();
    let control = Control::unattended();
    assert_eq!(read_record_with(&path, &beam(), &control).unwrap().len(), 20_000);
    assert!(control.progress() > 0.5);
    control.cancel();
    let error = read_record_with(&path, &beam(), &control).unwrap_err().to_string();
    assert!(error.ends_with("reading was cancelled"), "{error}");
}

#[test]
fn what_is_written_reads_back_the_same() {
    let time: Vec<f64> = (0..300).map(|n| f64::from(n) / 7.0).collect();
    let text: String = time.iter().map(|t| format!("{t},{},{}\n", t.sin() * 1e-7, t.exp())).collect();
    let record = read(&format!("time [s],acc@3 [g],disp@4 [rad]\n{text}"));
    let path = tempfile::NamedTempFile::new().unwrap().into_temp_path();
    write_record(&path, &record, &beam(), None).unwrap();
    let again = read_record(&path, &beam()).unwrap();
    assert_eq!(again, record);
    write_record(&path, &record, &beam(), Some(6)).unwrap();
    let short = read_record(&path, &beam()).unwrap();
    assert_eq!(short.time(), record.time());
    for (a, b) in short.samples(0).iter().zip(record.samples(0)) {
        assert!((a - b).abs() <= 0.5e-5 * b.abs() * 1.000_001);
    }
    assert!(short.resolution(0) > 0.0 && record.resolution(0) == 0.0);
}

#[test]
fn the_step_of_written_numbers_is_found() {
    let rows = |digits: usize| {
        let values =
            (0..400).map(|n| f64::from(n) * 0.01).map(|t| format!("{t:.2},{:.digits$}\n", 3.0 * (20.0 * t).sin()));
        values.collect::<String>()
    };
    for digits in [2, 5, 8] {
        let record = read(&format!("time [s],vel@3 [mm/s]\n{}", rows(digits)));
        let expected = 1e-3 * 10.0_f64.powi(-(digits as i32));
        assert!((record.resolution(0) / expected - 1.0).abs() < 1e-9, "{digits}: {}", record.resolution(0));
    }
}

const HARMONICS: &str = "run,frequency_hz,channel,harmonic,cos,sin\n\
    a,10,force@1 [N],1,1,0.5\na,10,force@1 [N],2,0,0\na,10,acc@3 [g],2,0.1,0\na,10,acc@3 [g],1,2,-3\n\
    b,12,force@1 [N],1,1,0\n";

const TOO_LARGE: &str = "(SI units) is more than any sensor reads; mend the number or remove the row";

#[test]
fn harmonics_are_read_by_run() {
    let runs = parse_harmonics(HARMONICS.as_bytes(), "h.csv", &beam()).unwrap();
    assert_eq!(runs.iter().map(|run| run.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
    assert_eq!((runs[0].fit.harmonics(), runs[1].fit.harmonics()), (2, 1));
    let acceleration = &runs[0].fit.channels[1];
    assert_eq!((acceleration.amplitudes[0].re, acceleration.amplitudes[0].im), (2.0 * 9.80665, 3.0 * 9.80665));
    assert!(!acceleration.has_deviation());
    assert_eq!(runs[1].fit.omega, TAU * 12.0);
}

#[test]
fn bad_harmonics_are_named_in_one_line() {
    let change = |from: &str, to: &str| HARMONICS.replacen(from, to, 1);
    let columns = "the columns are run, frequency_hz, channel, harmonic, cos, sin and, if known, cos_std, sin_std";
    let cases = [
        (
            change("a,10,acc@3 [g],1,2,-3\n", ""),
            "h.csv, line 4, acc@3: run a has no harmonic 1 of this channel, but has 2; add the row".to_owned(),
        ),
        (
            change("a,10,force@1 [N],2,0,0\n", ""),
            "h.csv, line 2, force@1: run a has no harmonic 2 of this channel, but has 2; add the row".to_owned(),
        ),
        (
            change("force@1 [N],2", "force@1 [N],1"),
            "h.csv, line 3, harmonic: harmonic 1 of this channel in run a stands twice; remove one".to_owned(),
        ),
        (
            change("force@1 [N],2", "force@1 [N],0"),
            "h.csv, line 3, harmonic: \"0\" is not the number of a harmonic; write 1, 2, 3 and so on, at most 1000"
                .to_owned(),
        ),
        (
            change("force@1 [N],2", "force@1 [N],1.5"),
            "h.csv, line 3, harmonic: \"1.5\" is not the number of a harmonic; write 1, 2, 3 and so on, at most 1000"
                .to_owned(),
        ),
        (
            change("a,10,acc", "a,11,acc"),
            "h.csv, line 4, frequency_hz: run a is at 11 Hz here and at 10 Hz above; give a run one frequency"
                .to_owned(),
        ),
        (
            change("b,12", "b,-12"),
            "h.csv, line 6, frequency_hz: \"-12\" is not a frequency; write a positive number of hertz".to_owned(),
        ),
        (
            change("acc@3 [g],2", "acc@8 [g],2"),
            "h.csv, line 4, channel: the structure has no DOF \"8\"; it has 1, 2, 3, 4".to_owned(),
        ),
        (
            change(",1,1,0.5", ",1,one,0.5"),
            "h.csv, line 2, cos: \"one\" is not a number; write one such as 1.25e-3".to_owned(),
        ),
        (change("cos,sin", "cos"), format!("h.csv, line 1: there is no column \"sin\"; {columns}")),
        (change("cos,sin", "cos,sine"), format!("h.csv, line 1: column \"sine\" is unknown; {columns}")),
        (change("cos,sin", "cos,cos"), "h.csv, line 1: column \"cos\" stands twice; remove one".to_owned()),
        (
            change("cos,sin", "cos,sin,cos_std"),
            "h.csv, line 1: there is a cos_std or a sin_std alone; give both or none".to_owned(),
        ),
        (
            "run,frequency_hz,channel,harmonic,cos,sin\n".to_owned(),
            "h.csv: only the header is there; export the record with its samples".to_owned(),
        ),
        (
            "run,frequency_hz,channel,harmonic,cos,sin,cos_std,sin_std\na,1,acc@1 [g],1,1,1,-1,0\n".to_owned(),
            "h.csv, line 2, cos_std: \"-1\" is not a standard deviation; write zero or a positive number".to_owned(),
        ),
        // What no sensor reads, in SI units.
        (change("1,2,-3", "1,2,-1e30"), format!("h.csv, line 5, sin: -9.80665e30 {TOO_LARGE}")),
        (change("1,2,-3", "1,1.7e308,-3"), format!("h.csv, line 5, cos: inf {TOO_LARGE}")),
        (change("b,12", "b,1e200"), format!("h.csv, line 6, frequency_hz: 1e200 {TOO_LARGE}")),
    ];
    for (text, expected) in cases {
        let found = parse_harmonics(text.as_bytes(), "h.csv", &beam()).unwrap_err().to_string();
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn harmonics_are_written_with_their_deviations() {
    let text: String = (0..500)
        .map(|n| f64::from(n) * 1e-3)
        .map(|t| format!("{t},{},{}\n", (62.0 * t).sin() + 0.01 * (1e5 * t).sin(), (62.0 * t).cos()))
        .collect();
    let record = read(&format!("time [s],force@1 [N],acc@3 [g]\n{text}"));
    let fit = fit(&record, 62.0, 3).unwrap();
    let path = tempfile::NamedTempFile::new().unwrap().into_temp_path();
    write_harmonics(&path, &[("one, first", &fit)], &beam()).unwrap();
    let again = read_harmonics(&path, &beam()).unwrap();
    assert_eq!(again[0].name, "one, first");
    for (a, b) in again[0].fit.channels.iter().zip(&fit.channels) {
        assert_eq!((&a.channel, &a.amplitudes), (&b.channel, &b.amplitudes));
        assert!((a.deviation(2) / b.deviation(2) - 1.0).abs() < 1e-12);
    }
}

proptest! {
    #[test]
    fn bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = parse_record(&bytes, "x", &beam(), &Control::unattended());
        let _ = parse_harmonics(&bytes, "x", &beam());
    }

    #[test]
    fn tables_never_panic(text in "(time \\[s\\]|run,frequency_hz,channel)?[,;\t](force@1 \\[N\\]|harmonic,cos,sin)?\n([-+0-9.eE,;\"\t a-z]{0,12}\n){0,12}") {
        let error = parse_record(text.as_bytes(), "x", &beam(), &Control::unattended()).err().map(|e| e.to_string());
        prop_assert!(error.is_none_or(|e| !e.contains('\n')));
        let error = parse_harmonics(text.as_bytes(), "x", &beam()).err().map(|e| e.to_string());
        prop_assert!(error.is_none_or(|e| !e.contains('\n')));
    }

    #[test]
    fn numbers_survive_writing(values in proptest::collection::vec(-1e300f64..1e300, 5..40), small in 1e-300f64..1.0) {
        let mut text = "time [s],force@1 [N]\n".to_owned();
        for (n, value) in values.iter().enumerate() {
            text.push_str(&format!("{n},{:e}\n", value * small));
        }
        let record = parse_record(text.as_bytes(), "x", &beam(), &Control::unattended()).unwrap();
        let path = tempfile::NamedTempFile::new().unwrap().into_temp_path();
        write_record(&path, &record, &beam(), None).unwrap();
        let again = read_record(&path, &beam()).unwrap();
        prop_assert_eq!(again.samples(0), record.samples(0));
    }
}
