//! Tables in the dialects of laboratories, all of one test: 2 kg on a spring at 21 Hz with a dashpot of 8 N s/m, driven by 5 N
//! at 20 Hz, or its frequency response. Each ends in a project in which `identify` finds the dashpot: units, factors, times and
//! parts of complex numbers were understood.

use super::{dashpot, imported, json};
use std::f64::consts::TAU;
use std::path::Path;

const M: f64 = 2.0;
pub(super) const C: f64 = 8.0;
pub(super) const G: f64 = 9.806_65;

/// Receptance, m/N: real and imaginary part.
fn receptance(frequency_hz: f64) -> [f64; 2] {
    let omega = TAU * frequency_hz;
    let (re, im) = (M * (TAU * 21.0).powi(2) - M * omega * omega, omega * C);
    let size = re * re + im * im;
    [re / size, -im / size]
}

/// Time, force, displacement and acceleration of sample `i` at 1 kHz.
pub(super) fn sample(i: usize) -> [f64; 4] {
    let (t, [re, im]) = (i as f64 / 1000.0, receptance(20.0));
    let (omega, phase) = (TAU * 20.0, TAU * 20.0 * t);
    let x = 5.0 * (re * phase.cos() - im * phase.sin());
    [t, 5.0 * phase.cos(), x, -omega * omega * x]
}

/// Rows of a table.
pub(super) fn rows(row: impl Fn([f64; 4]) -> String) -> String {
    (0..700).map(|i| row(sample(i)) + "\n").collect()
}

/// Accelerance over frequency, row by row.
pub(super) fn lines(row: impl Fn(f64, [f64; 2]) -> String) -> String {
    let line = |i: i32| {
        let f = 5.0 + 0.25 * f64::from(i);
        row(f, receptance(f).map(|part| -part * (TAU * f).powi(2))) + "\n"
    };
    (0..160).map(line).collect()
}

/// The coefficient that `identify` finds in a project.
pub(super) fn coefficient(folder: &Path) -> f64 {
    let identified = json(&["identify", "--json", &folder.join("project.toml").display().to_string()]);
    assert_eq!(identified["sources"].as_array().unwrap().len(), 1, "{identified}");
    identified["sources"][0]["parameters"]["c"].as_f64().unwrap()
}

pub(super) fn right(text: &str, more: &[&str]) -> (String, String) {
    let folder = tempfile::tempdir().unwrap();
    let made = imported(folder.path(), "test.csv", text, more);
    let c = coefficient(folder.path());
    assert!((c / C - 1.0).abs() < 1e-3, "{c} of {}", &text[..text.len().min(200)]);
    made
}

fn comma(text: String) -> String {
    text.replace('.', ",")
}

#[test]
fn units_stand_where_laboratories_put_them() {
    right(&format!("time_s,force_N,acc_mg\n{}", rows(|[t, f, _, a]| format!("{t},{f},{}", a / G * 1e3))), &[]);
    right(&format!("t/s\tF/N\ts/µm\n{}", comma(rows(|[t, f, x, _]| format!("{t}\t{f}\t{}", x * 1e6)))), &[]);
    right(
        &format!(
            "Zeit in ms;Kraft in kN;Weg in mm\n{}",
            comma(rows(|[t, f, x, _]| format!("{};{};{}", t * 1e3, f / 1e3, x * 1e3)))
        ),
        &[],
    );
    let (said, project) =
        right(&format!("time_s,force_N,acceleration_m_s2\n{}", rows(|[t, f, _, a]| format!("{t},{f},{a}"))), &[]);
    assert!(
        project.contains("dof = 1") && !said.contains("unit: "),
        "the digit of the unit is no place: {project} {said}"
    );
}

#[test]
fn sensitivities_that_are_stated_calibrate() {
    let volts =
        |separator: &str| rows(|[t, f, _, a]| format!("{t}{separator}{}{separator}{}", f * 22.5, a / G * 100.0));
    let text = format!("Time [s];Force (22.5 mV/N) [mV];Acc 1 (100 mV/g) [mV]\n{}", volts(";"));
    let (said, project) = right(&text, &[]);
    assert!(said.contains("calibrated by the sensitivity that the file states, 100 mV/g"), "{said}");
    assert!(project.contains("unit = \"g\"\nfactor = 0.01"), "{project}");
    let text = format!(
        "Channel,Time,Force,Acc 1\nUnit,s,mV,mV\nSensitivity,,22.5 mV/N,100 mV/g\n{}",
        volts(",").replace('\n', "\n,")
    );
    right(&text.replacen("100 mV/g\n", "100 mV/g\n,", 1), &[]);
}

#[test]
fn clocks_of_every_country_are_times() {
    let seconds = |t: f64| format!("{:02}:{:06.3}", (t / 60.0) as u32, t % 60.0);
    let rows = |row: &dyn Fn(f64) -> String, separator: &str| {
        rows(|[t, f, _, a]| format!("{}{separator}{f}{separator}{a}", row(t)))
    };
    let iso = rows(&|t| format!("2024-03-01T12:{}", seconds(t)), ",");
    right(&format!("timestamp,Force [N],Acc [m/s^2]\n{iso}"), &[]);
    let american = rows(&|t| format!("02/28/2024 11:{} PM", seconds(3599.7 + t)).replace("11:60", "12:00"), ",");
    let american: String = american
        .lines()
        .map(|line| match line.split_once("12:00:") {
            // Midnight is in the record.
            Some((_, rest)) => format!("02/29/2024 12:00:{}\n", rest.replace("PM", "AM")),
            None => format!("{line}\n"),
        })
        .collect();
    right(&format!("Date Time,Force [N],Acc [m/s^2]\n{american}"), &[]);
    let german = comma(rows(&|t| format!("01_03_2024 12:{}", seconds(t)), ";")).replace('_', ".");
    right(&format!("Datum/Zeit;Kraft [N];Beschl. [m/s²]\n{german}"), &[]);
    let two = rows(&|t| format!("2024-03-01,12:{}", seconds(t)), ",");
    right(&format!("Date,Time,Force [N],Acc [m/s^2]\n{two}"), &[]);
}

#[test]
fn headers_of_measuring_programs_are_read_through() {
    let tabs = || rows(|[t, f, _, a]| format!("{t}\t{f}\t{a}"));
    let catman = "HBM_CATMAN\t5.4\nZeit 1 - Standardmessrate [s]\tKraft\tAcc_1\ns\tN\tm/s²\nKommentar\t\t\n\
                  Sample rate=1000.0 Hz\tSample rate=1000.0 Hz\tSample rate=1000.0 Hz\nSensorType=\tU9C/1kN\tB12\n";
    right(&format!("{catman}{}", comma(tabs())), &[]);
    let testlab = "Point\tRun 1:Shaker:+Z\tRun 1:Plate:1:+Z\nFunction class\tTime\tTime\nX axis unit\ts\ts\n\
                   Y axis unit\tN\tm/s^2\nLinear\tReal\tReal\ns\tN\tm/s^2\n";
    right(&format!("{testlab}{}", tabs()), &[]);
    right(&format!("% t(s) F(N) a(m/s^2)\n{}", tabs().replace('\t', "  ")), &[]);
    let pairs = rows(|[t, f, _, a]| format!("{t},{f},{t},{a}"));
    right(&format!("Force,,Acc,\nX [s],Y [N],X [s],Y [m/s^2]\n{pairs}"), &[]);
    // Inputs of the amplifier are no places.
    right(&format!("Sample rate: 1000\n\nTime (s)\tForce/AI 1 (N)\tAcc/AI 2 (m/s^2)\n{}", tabs()), &[]);
    let started = "Zeit\tKraft\tBeschl\ns\tN\tm/s²\nStart: 11:58\tStart: 11:58\tStart: 11:58\n";
    right(&format!("{started}{}", comma(tabs())), &[]);
    let remarks = tabs().replace('\t', ";").replacen('\n', ";start\n", 1);
    right(&format!("Time [s];Force [N];Acc [m/s^2];Comment\n{remarks}"), &[]);
}

#[test]
fn numbers_touch_and_have_signs_between_their_thousands() {
    let fixed = rows(|[t, f, _, a]| format!("{t:8.4}{f:13.6e}{a:13.6e}"));
    right(&format!("TIME[s] FORCE[N] ACC[m/s2]\n{fixed}"), &[]);
    let thousands = |value: f64| {
        let text = format!("{:.3}", value.abs());
        let (whole, fraction) = text.split_once('.').unwrap();
        let split = if whole.len() > 3 {
            format!("{}.{}", &whole[..whole.len() - 3], &whole[whole.len() - 3..])
        } else {
            whole.to_owned()
        };
        format!("{}{split},{fraction}", if value < 0.0 { "-" } else { "" })
    };
    let german = rows(|[t, f, _, a]| format!("{};{};{}", comma(t.to_string()), thousands(f * 1e3), thousands(a * 1e3)));
    right(&format!("Zeit [s];Kraft [mN];Beschleunigung [mm/s²]\n{german}"), &[]);
}

#[test]
fn responses_in_columns_of_every_wording() {
    let polar = |[re, im]: [f64; 2]| (re.hypot(im), im.atan2(re));
    let parts = || lines(|f, [re, im]| format!("{f};{re};{im}"));
    right(&format!("Frequenz [Hz];H11 Real [m/s²/N];H11 Imag [m/s²/N]\n{}", comma(parts())), &[]);
    right(&format!("Frequency;Point 1/Point 1;\nHz;Real;Imag\n;m/s²/N;m/s²/N\n{}", parts()), &[]);
    right(&format!("f;Re;Im\n{}", parts()), &["--form", "accelerance"]);
    right(&parts(), &["--columns", "real-imag", "--form", "accelerance"]);
    let degrees = lines(|f, h| format!("{f};{};{}", polar(h).0 / G, polar(h).1.to_degrees()));
    right(&format!("Freq (Hz);Magnitude (g/N);Phase (deg)\n{degrees}"), &[]);
    right(&format!("f [Hz];Accelerance [g/N];phi [°]\n{degrees}"), &[]);
    let levels = lines(|f, h| format!("{f};{};{};99.9", 20.0 * polar(h).0.log10(), polar(h).1.to_degrees()));
    let (_, project) =
        right(&format!("Frequenz;Betrag;Phase;Kohärenz\nHz;dB re 1 (m/s²)/N;°;%\n{levels}"), &["--averages", "16"]);
    assert!(project.contains("averages = 16"), "{project}");
    let complex = lines(|f, [re, im]| format!("{f};{re:.9e}{im:+.9e}i"));
    right(&format!("Frequenz;Inertance\n{}", comma(complex)), &[]);
    let omega = lines(|f, [re, im]| format!("{};{re};{im}", TAU * f));
    right(&format!("omega [rad/s];Re(H) [1/kg];Im(H) [1/kg]\n{omega}"), &[]);
}

#[test]
fn a_template_says_of_responses_what_the_files_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let template = folder.path().join("template.toml");
    std::fs::write(&template, "[[frf]]\ncolumns = \"magnitude-rad\"\nform = \"accelerance\"\nscale = 9.80665\nband = [6, 40]\nlines = 40\nresponses = [\"7z\"]\nreferences = [\"7z\"]\n").unwrap();
    let rows = lines(|f, [re, im]| format!("{f} {} {}", re.hypot(im) / G, im.atan2(re)));
    let map = template.display().to_string();
    let (said, project) = imported(folder.path(), "a.txt", &rows, &["--map", &map]);
    assert!(
        said.contains("40 runs")
            && project.contains("columns = \"magnitude-rad\"")
            && project.contains("band = [6.0, 40.0]"),
        "{said} {project}"
    );
    assert!((coefficient(folder.path()) / C - 1.0).abs() < 1e-3);
    std::fs::write(&template, "[[frf]]\ncolumns = \"real\"\n").unwrap();
    let file = folder.path().join("a.txt").display().to_string();
    let error = dashpot(&["import", &file, "--map", &map, "--propose"]).unwrap_err();
    assert!(error.contains("template.toml:2") && error.contains("real-imag") && !error.contains('\n'), "{error}");
}

#[test]
fn what_is_said_is_of_files_that_are_there_and_of_channels_that_are_used() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: String| {
        std::fs::write(folder.path().join(name), text).unwrap();
        folder.path().join(name).display().to_string()
    };
    let bare =
        file("point_1.csv", format!("Frequency [Hz],Real,Imag\n{}", lines(|f, [re, im]| format!("{f},{re},{im}"))));
    let error = dashpot(&["import", &bare, "--out", &folder.path().join("p.toml").display().to_string()]).unwrap_err();
    let said = "point_1.csv: channel \"FRF\": the file says no unit";
    assert!(error.contains(said) && !error.contains("p.toml"), "{error}");
    let volts = rows(|[t, f, _, a]| format!("{t},{f},{a}"));
    let volts = file("volts.csv", format!("Time [s],Force [N],out [V]\n{volts}"));
    let said = dashpot(&["import", &volts, "--out", &folder.path().join("q.toml").display().to_string()]).unwrap();
    assert!(said.contains("assumed: force@1") && !said.contains("assumed: disp@1"), "{said}");
}

#[test]
fn files_of_one_point_each_are_placed_by_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, scale: f64| {
        let text = format!(
            "Frequency [Hz],Real [m/s^2/N],Imag [m/s^2/N]\n{}",
            lines(|f, [re, im]| format!("{f},{},{}", scale * re, scale * im))
        );
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let (a, b) = (write("point_4.csv", 1.0), write("point_9.csv", 1e-3));
    let out = folder.path().join("project.toml").display().to_string();
    let said = dashpot(&["import", &a, &b, "--out", &out]).unwrap();
    assert!(said.contains("the responses are at 4, 9 by the numbers in their files, all driven at 4"), "{said}");
    let project = std::fs::read_to_string(&out).unwrap();
    assert!(project.contains("further_files = [\"point_9.csv\"]"), "{project}");
    assert!(project.contains("responses = [\"4\", \"9\"]") && project.contains("references = [\"4\"]"), "{project}");
}
