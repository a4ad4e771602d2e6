//! Report and plots on the command line, without window and graphics: one file that holds everything, with the values of the
//! other commands, for every kind of project.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data").join(name).join("project.toml")
}

fn dashpot(arguments: &[&str], file: &Path, out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dashpot"));
    command.arg(arguments[0]).arg(file).args(&arguments[1..]).arg("--out").arg(out);
    command.output().unwrap()
}

fn written(arguments: &[&str], file: &Path, out: &Path) -> String {
    let done = dashpot(arguments, file, out);
    assert!(done.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&done.stderr));
    std::fs::read_to_string(out).unwrap()
}

#[test]
fn a_report_holds_values_and_plots_in_one_file() {
    let (file, folder) = (sample("cantilever-harmonics"), tempfile::tempdir().unwrap());
    let text = written(&["report"], &file, &folder.path().join("report.html"));
    let identified =
        Command::new(env!("CARGO_BIN_EXE_dashpot")).arg("identify").arg(&file).arg("--json").output().unwrap();
    let json: Value = serde_json::from_slice(&identified.stdout).unwrap();
    for source in json["sources"].as_array().unwrap() {
        let percent = source["energy_percent"].as_f64().unwrap();
        assert!(text.contains(&dashpot::display::format::percent(0.01 * percent)), "{source}");
    }
    for chapter in ["Structure", "Measurements", "Where the energy is lost", "Damping ratios", "Settings"] {
        assert!(text.contains(&format!("<h2>{chapter}</h2>")), "{chapter}");
    }
    assert!(text.matches("data:image/svg+xml,").count() >= 5, "energies, angle, matrix, Bode, Nyquist");
    assert!(!text.contains("src=\"http"), "nothing outside the file");
}

#[test]
fn a_report_of_a_hidden_effect_says_what_is_missing() {
    let (file, folder) = (sample("cantilever-friction"), tempfile::tempdir().unwrap());
    // As long as it takes, on a machine that is busy too.
    let text = written(&["report", "--limit", "600"], &file, &folder.path().join("report.html"));
    assert!(text.contains("No source was identified: the project states"), "the reason stands in the report");
    for wanted in ["Error map", "What is missing?", "Coulomb friction at DOF", "Ledger"] {
        assert!(text.contains(wanted), "{wanted}");
    }
    assert!(text.matches("data:image/svg+xml,").count() >= 5, "Bode, Nyquist, map, worst channel, missing force");
    assert!(text.contains("Missing force at DOF"), "the force over displacement and velocity");
}

#[test]
fn a_report_of_a_component_has_no_empty_figure_and_blames_no_test_for_its_kind() {
    let (file, folder) = (sample("damper-loops"), tempfile::tempdir().unwrap());
    let text =
        written(&["report", "--sections", "structure,measurements,energy"], &file, &folder.path().join("r.html"));
    assert!(text.contains("1 degree of freedom"));
    assert!(!text.contains("Energy per period and run"), "it is balanced over windows, there are no runs");
    assert!(!text.contains("it looks like kind"), "a testing machine may move it in any way");
}

#[test]
fn every_plot_is_drawn_without_a_window_and_its_values_are_csv() {
    let folder = tempfile::tempdir().unwrap();
    let file = sample("cantilever-case-1");
    let kinds =
        ["angle", "energy", "shares", "matrix", "bode", "nyquist", "hysteresis", "record", "spectrum", "period"];
    for kind in kinds {
        let svg = written(&["plot", "--what", kind], &file, &folder.path().join(format!("{kind}.svg")));
        assert!(svg.starts_with("<?xml") && svg.contains("<text"), "{kind}");
        let csv = written(&["plot", "--what", kind], &file, &folder.path().join(format!("{kind}.csv")));
        assert!(csv.lines().count() > 1 && csv.contains(','), "{kind}: {csv}");
    }
    let friction = sample("cantilever-friction");
    let svg = written(&["plot", "--what", "channel"], &friction, &folder.path().join("channel.svg"));
    assert!(svg.contains(">model<") && svg.contains(">measured<"), "keys to both");
    assert!(svg.matches(" N (peak)<").count() > 1, "a key to every level of force");
    let force = written(&["plot", "--what", "restoring-force"], &friction, &folder.path().join("force.svg"));
    assert!(force.contains("Displacement") && force.contains("Velocity"), "two plots side by side");
    let table = written(&["plot", "--what", "restoring-force"], &friction, &folder.path().join("force.csv"));
    assert!(
        table
            .starts_with("run,level,frequency (Hz),displacement (m),velocity (m/s),force (N),standard deviation (N)\n")
    );
    assert!(table.lines().count() > 60, "32 points a run");
    let map = written(&["plot", "--what", "error-map"], &friction, &folder.path().join("map.csv"));
    assert!(map.starts_with("channel,run 1"), "{map}");
}

/// Decays and components have plots of their own; what shows periodic motion says that they have none.
#[test]
fn records_that_are_not_steady_are_drawn_too() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let decay = sample("decay-friction");
    for kind in ["record", "spectrum", "spectrogram", "amplitude", "error-map", "angle", "shares", "matrix"] {
        let svg = written(&["plot", "--what", kind], &decay, &out("plot.svg"));
        assert!(svg.starts_with("<?xml") && svg.contains("<text"), "{kind}");
    }
    let samples =
        written(&["plot", "--what", "record", "--run", "2", "--channel", "acc@19"], &decay, &out("record.csv"));
    assert!(samples.starts_with("Time (s)") || samples.contains("Time"), "{}", samples.lines().next().unwrap());
    assert!(samples.lines().count() > 500, "{}", samples.lines().count());
    let amplitude = written(&["plot", "--what", "amplitude"], &decay, &out("amplitude.svg"));
    assert!(amplitude.contains("Damping ratio") && amplitude.contains(">model<"), "measured and modelled");
    for kind in ["energy", "channel", "period", "nyquist", "hysteresis", "overview"] {
        let refused = dashpot(&["plot", "--what", kind], &decay, &out("x.svg"));
        let said = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(1), "{kind}: {said}");
        assert!(
            said.contains(&format!("{kind} is a plot of steady runs")) && said.trim().lines().count() == 1,
            "{said}"
        );
    }
    let loops = sample("damper-loops");
    for kind in ["hysteresis", "error-map"] {
        let svg = written(&["plot", "--what", kind], &loops, &out("loop.svg"));
        assert!(svg.starts_with("<?xml"), "{kind}");
    }
    let runs = written(&["plot", "--what", "overview"], &sample("cantilever-friction"), &out("overview.svg"));
    assert!(runs.contains("Magnitude") && runs.matches(">level ").count() > 1, "a key to every level");
}

/// A model whose damping is still to be identified is off by far more than any force that is missing: what is identified acts in it
/// first, as in `compare` and `diagnose`.
#[test]
fn the_missing_force_of_an_undamped_model_is_that_beside_what_is_identified() {
    let folder = tempfile::tempdir().unwrap();
    let wing = dashpot(&["plot", "--what", "restoring-force"], &sample("goland-wing"), &folder.path().join("x.svg"));
    let said = String::from_utf8(wing.stderr).unwrap();
    assert_eq!(wing.status.code(), Some(1), "{said}");
    assert!(said.contains("the model has no damping yet") && said.contains("no force is missing"), "{said}");
}

#[test]
fn what_cannot_be_drawn_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |arguments: &[&str], file: &Path, out: &str, says: &str| {
        let failed = dashpot(arguments, file, &folder.path().join(out));
        let message = String::from_utf8(failed.stderr).unwrap();
        assert_eq!(failed.status.code(), Some(1), "{message}");
        assert!(message.contains(says) && message.trim().lines().count() == 1, "{message}");
    };
    let file = sample("cantilever-case-1");
    refused(&["report"], Path::new("no.toml"), "r.html", "no.toml");
    refused(&["plot", "--what", "bode"], &file, "x.png", ".svg");
    let friction = sample("cantilever-friction");
    refused(&["plot", "--what", "restoring-force", "--dof", "1"], &friction, "x.svg", "no suggestion is there");
    refused(&["plot", "--what", "record", "--run", "99"], &file, "x.svg", "--run 99");
    refused(&["plot", "--what", "bode", "--dof", "zz"], &file, "x.svg", "zz");
    refused(&["plot", "--what", "record", "--channel", "acc@99"], &file, "x.svg", "has no such channel");
}

/// Samples of hammers, decays and sweeps: the search of a decay takes minutes where the program is not optimised.
const RECORDS: [&str; 3] = ["decay-friction", "hammer-maxwell", "sweep-cubic"];

/// A report holds what can be said, and is never refused for what cannot.
fn says_where_its_model_stands(sample: &Path) {
    let (file, folder) = (sample.join("project.toml"), tempfile::tempdir().unwrap());
    let out = folder.path().join("report.html");
    let control = dashpot::control::Control::unattended();
    // A search that takes long answers with the best so far, and the report says so.
    dashpot::session::time_limit::hurry_after(&control, std::time::Duration::from_secs(4));
    dashpot::report::report(&file, &dashpot::report::Request::default(), &out, &control).unwrap();
    let text = std::fs::read_to_string(&out).unwrap();
    let name = file.display();
    for chapter in ["Measurements", "What is missing?", "Ledger", "Settings"] {
        assert!(text.contains(&format!("<h2>{chapter}</h2>")), "{name}: {chapter}");
    }
    assert!(text.contains("noise alone would leave"), "{name}: the model is compared with the measurement");
    assert!(!text.contains("takes hardly any energy out"), "{name}: damping that was identified is taken over");
    assert!(text.contains("data:image/svg+xml,"), "{name}: a plot");
}

fn samples(records: bool) -> Vec<PathBuf> {
    let all = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("sample-data")).unwrap();
    let is_record = |path: &PathBuf| RECORDS.iter().any(|name| path.ends_with(name));
    all.map(|entry| entry.unwrap().path()).filter(|path| is_record(path) == records).collect()
}

#[test]
#[ignore = "the search on points alone takes minutes where the program is not optimised and does not end with its time limit"]
fn every_sample_has_a_report_that_says_where_its_model_stands() {
    let samples = samples(false);
    assert!(samples.len() >= 16, "{} samples", samples.len());
    for sample in samples {
        let start = std::time::Instant::now();
        says_where_its_model_stands(&sample);
        println!("{}: {:.1} s", sample.display(), start.elapsed().as_secs_f64());
    }
}

#[test]
#[ignore = "the search of a decay takes minutes where the program is not optimised"]
fn samples_of_other_tests_have_one_too() {
    let samples = samples(true);
    assert_eq!(samples.len(), RECORDS.len());
    samples.iter().for_each(|sample| says_where_its_model_stands(sample));
}

#[test]
fn a_report_is_a_pdf_where_its_name_says_so() {
    let (file, folder) = (sample("cantilever-harmonics"), tempfile::tempdir().unwrap());
    let out = folder.path().join("report.pdf");
    let done = dashpot(&["report"], &file, &out);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let pdf = std::fs::read(&out).unwrap();
    assert!(pdf.starts_with(b"%PDF-1.") && pdf.len() > 100_000, "{} bytes, the face among them", pdf.len());
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.contains("/FontFile2") && text.contains("/ToUnicode") && text.matches("/Type /Page\n").count() >= 2);
}

/// All files of a ZIP file by name.
fn unpacked(path: &Path) -> Vec<(String, String)> {
    let mut archive = zip::ZipArchive::new(std::fs::File::open(path).unwrap()).unwrap();
    let count = archive.len();
    let read = |k: usize| {
        let mut file = archive.by_index(k).unwrap();
        (file.name().unwrap().into_owned(), std::io::read_to_string(&mut file).unwrap())
    };
    (0..count).map(read).collect()
}

/// A picture of one red point.
const RED: &[u8] = &[
    0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a, 0, 0, 0, 0x0d, b'I', b'H', b'D', b'R', 0, 0, 0, 1, 0, 0, 0, 1, 8,
    2, 0, 0, 0, 0x90, 0x77, 0x53, 0xde, 0, 0, 0, 0x0c, b'I', b'D', b'A', b'T', 0x08, 0xd7, 0x63, 0xf8, 0xcf, 0xc0, 0,
    0, 0x03, 0x01, 0x01, 0, 0x18, 0xdd, 0x8d, 0xb0, 0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82,
];

/// The sample in a folder of its own, with a table `[report]`.
fn with_title_page(folder: &Path) -> PathBuf {
    let from = sample("cantilever-harmonics");
    for entry in std::fs::read_dir(from.parent().unwrap()).unwrap() {
        let path = entry.unwrap().path();
        std::fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
    }
    std::fs::write(folder.join("red.png"), RED).unwrap();
    let file = folder.join("project.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let table = "\n[report]\nobject = \"Beam 7 <spare>\"\ntester = \"A. Tester\"\norganisation = \"Works\"\nlogo = \"red.png\"\n";
    std::fs::write(&file, text + table).unwrap();
    file
}

#[test]
fn a_report_can_be_signed_and_computed_again() {
    let folder = tempfile::tempdir().unwrap();
    let file = with_title_page(folder.path());
    let arguments = ["report", "--tester", "B. Other", "--limit", "5"];
    let text = written(&arguments, &file, &folder.path().join("report.html"));
    for wanted in ["Beam 7 &lt;spare&gt;", "B. Other", "Works", "data:image/png,", "Signature", "Contents", "Summary"] {
        assert!(text.contains(wanted), "{wanted}");
    }
    assert!(!text.contains("A. Tester"), "the command line goes before the project");
    for reference in ["Lawson", "Prandina", "Methods and references", "ChaCha8", "SHA-256", "Time limit of the search"]
    {
        assert!(text.contains(reference), "{reference}");
    }
    let bytes = std::fs::metadata(&file).unwrap().len();
    assert!(text.contains(&format!("<td>project.toml</td><td class=\"n\">{bytes}</td>")), "the project file itself");
    let (tables, figures) = (text.matches("<caption>Table ").count(), text.matches("<figcaption>Figure ").count());
    let all = unpacked(&folder.path().join("report-tables.zip"));
    let count = |kind: &str| all.iter().filter(|(name, _)| name.starts_with(kind)).count();
    assert_eq!(
        [count("table-"), count("figure-")],
        [tables, figures],
        "every table and figure of {tables} and {figures}"
    );
    assert!(all.iter().all(|(name, text)| text.lines().count() > 1
        && text.contains(',')
        && Path::new(name).extension().is_some_and(|e| e == "csv")));
    assert!(all.iter().any(|(name, _)| name == "values-identified.csv"));
}

#[test]
fn only_the_chosen_sections_are_written() {
    let (file, folder) = (sample("cantilever-harmonics"), tempfile::tempdir().unwrap());
    let out = folder.path().join("report.html");
    let text = written(&["report", "--sections", "ratios,measurements", "--no-tables"], &file, &out);
    let chapters: Vec<&str> = text.split("<h2>").skip(1).filter_map(|rest| rest.split("</h2>").next()).collect();
    assert_eq!(chapters, ["Measurements", "Damping ratios"], "in the order of the report");
    assert!(!folder.path().join("report-tables.zip").exists());
    let refused = dashpot(&["report", "--sections", "ratios,colours"], &file, &out);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("colours") && said.contains("next-test"), "{said}");
    let refused = dashpot(&["report", "--logo", "no.png"], &file, &out);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(refused.status.code() == Some(1) && said.starts_with("no.png: the logo cannot be read"), "{said}");
}

#[test]
fn a_search_that_is_cut_short_is_said_to_be() {
    let (file, folder) = (sample("cantilever-friction"), tempfile::tempdir().unwrap());
    let text = written(&["report", "--limit", "0.01"], &file, &folder.path().join("report.html"));
    assert!(text.contains("The search was ended at its time limit."), "on the title page");
    assert!(text.contains("The search was ended before its time"), "and where its result is");
}

/// Words of a plot: axes, keys and numbers.
fn words_of(svg: &str) -> Vec<String> {
    let pieces = svg.split("<text").skip(1).filter_map(|piece| piece.split_once('>')?.1.split_once("</text>"));
    pieces.map(|(words, _)| words.to_owned()).collect()
}

/// Amplitudes of sines say that they are peak values, on every axis and key; values at an instant do not.
#[test]
fn every_axis_of_amplitudes_says_peak() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("plot.svg");
    let names = ["Amplitude", "Force", "Moment", "Acceleration", "Velocity", "Displacement", "Rotation"];
    let instants = ["record", "hysteresis", "period", "loop"];
    let mut told = 0;
    for (project, kinds) in [
        (
            "cantilever-case-1",
            &["angle", "energy", "bode", "nyquist", "spectrum", "record", "hysteresis", "period"][..],
        ),
        ("cantilever-friction", &["overview", "channel", "level", "loop"]),
        ("decay-friction", &["spectrum", "amplitude", "record"]),
    ] {
        for kind in kinds {
            let svg = written(&["plot", "--what", kind], &sample(project), &out);
            for words in words_of(&svg) {
                let axis = words.contains(", ") && names.iter().any(|name| words.starts_with(name));
                let level = words.strip_suffix(" N").is_some_and(|number| number.parse::<f64>().is_ok());
                assert!(!level, "{project}, {kind}: {words}");
                told += usize::from(words.contains("(peak)"));
                if axis {
                    assert_eq!(words.contains("(peak)"), !instants.contains(kind), "{project}, {kind}: {words}");
                }
            }
        }
    }
    assert!(told >= 6, "{told} axes and keys");
}
