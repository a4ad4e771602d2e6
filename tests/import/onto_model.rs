//! Measurements laid onto the model of a project that is given as a template, and places that names and metadata say.

use super::{dashpot, imported, json};
use std::path::Path;

pub(super) const BEAM: &str = "[structure]\nkind = \"beam\"\nlength = 0.56\nbreadth = 0.04\ndepth = 0.004\nyoungs_modulus = 69e9\n\
                    density = 2700.0\nelements = 10\nsupports = \"clamped-free\"\n";
/// Hidden dashpot at node 5, N s/m.
pub(super) const C: f64 = 0.4;

/// Records of the beam under a force at node 10, named as `header` says in place of the names of the project.
pub(super) fn recorded(folder: &Path, header: &str) -> Vec<String> {
    let runs: String = [9.9, 10.5, 65.0, 66.5]
        .iter()
        .enumerate()
        .map(|(i, f)| format!("[[run]]\nfile = \"r{i}.csv\"\nfrequency = {f:?}\nforce_dof = 19\nforce_n = 1.0\n"))
        .collect();
    let hidden = format!("[[source]]\nlaw = \"viscous\"\ndofs = [\"5z\"]\nstate = \"known\"\nc = {C}\n");
    let channels = "channels = [\"force@19 [N]\", \"acc@7 [m/s^2]\", \"acc@15 [m/s^2]\", \"acc@19 [m/s^2]\"]";
    let truth = folder.join("truth.toml").display().to_string();
    std::fs::write(&truth, format!("[project]\nformat = 1\n{BEAM}{hidden}{runs}[simulate]\n{channels}\n")).unwrap();
    let out = folder.display().to_string();
    dashpot(&["simulate", "--noise", "0.001", "--seed", "3", "--out", &out, &truth]).unwrap();
    let named = |i: usize| {
        let path = folder.join(format!("r{i}.csv"));
        let text = std::fs::read_to_string(&path).unwrap();
        let (_, numbers) = text.split_once('\n').unwrap();
        std::fs::write(&path, format!("{header}\n{numbers}")).unwrap();
        path.display().to_string()
    };
    (0..4).map(named).collect()
}

/// Imports the files with a template; what was said, and the project.
pub(super) fn onto(folder: &Path, files: &[String], template: &str) -> Result<(String, String), String> {
    let [map, out] = ["model.toml", "p.toml"].map(|name| folder.join(name).display().to_string());
    std::fs::write(&map, template).unwrap();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let said = dashpot(&[&["import"][..], &files, &["--map", &map, "--out", &out]].concat())?;
    Ok((said, std::fs::read_to_string(out).unwrap()))
}

#[test]
fn numbers_of_points_are_nodes_of_a_beam_where_they_cannot_be_translations() {
    let folder = tempfile::tempdir().unwrap();
    let files =
        recorded(folder.path(), "Time [s],Kraft P10 [N],Beschl. P4 [m/s²],Beschl. P8 [m/s²],Beschl. P10 [m/s²]");
    let (said, project) = onto(folder.path(), &files, BEAM).unwrap();
    assert!(said.contains("assumed: acc@8z: 8 is taken for the node: 8z is its translation"), "{said}");
    assert!(said.contains("r0.csv to ") && said.contains("(4 runs): steady"), "{said}");
    assert!(project.contains("kind = \"beam\"") && project.contains("where = \"each-translation\""), "{project}");
    let out = folder.path().join("p.toml").display().to_string();
    let found = json(&["identify", "--json", &out]);
    let source = &found["sources"][0];
    assert_eq!((source["dofs"][0].as_str(), found["sources"].as_array().unwrap().len()), (Some("9"), 1), "{source}");
    assert!((source["parameters"]["c"].as_f64().unwrap() / C - 1.0).abs() < 0.01, "{source}");
}

#[test]
fn a_project_as_template_keeps_all_but_its_measurements() {
    let folder = tempfile::tempdir().unwrap();
    let files = recorded(folder.path(), "Time [s],F [N],A4 [m/s²],A8 [m/s²],A10 [m/s²]");
    let channel = |name: &str, quantity: &str, dof: &str| {
        format!("[[channel]]\nname = \"{name}\"\nquantity = \"{quantity}\"\ndof = {dof}\n")
    };
    let channels = [("F", "force", "19"), ("A4", "acc", "\"4z\""), ("A8", "acc", "\"8z\""), ("A10", "acc", "19")]
        .map(|(name, quantity, dof)| channel(name, quantity, dof))
        .concat();
    let old = format!(
        "# beam of hall 3\n[project]\nformat = 1\ntitle = \"May\"\n{BEAM}[[source]]\nlaw = \"viscous\"\ndofs = [9]\n\
         state = \"candidate\"\n[[run]]\nfile = \"gone.csv\"\n{channels}[analysis]\nharmonics = 5\n"
    );
    let (_, project) = onto(folder.path(), &files, &old).unwrap();
    for kept in ["# beam of hall 3", "title = \"May\"", "state = \"candidate\"", "harmonics = 5", "dof = \"4z\""] {
        assert!(project.contains(kept), "{kept}: {project}");
    }
    assert!(!project.contains("gone.csv") && !project.contains("[[candidates]]"), "{project}");
    // A sensor that is said to sit at a rotation is refused, not read as one.
    let error = onto(folder.path(), &files, &old.replace("\"8z\"", "8")).unwrap_err();
    assert!(error.contains("DOF 8 is a rotation of node 4 and is not measured in m/s²"), "{error}");
}

#[test]
fn a_table_without_a_force_is_the_base() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..400)
        .map(|i| {
            format!("{:.4},{:.6},{:.6}\n", 1e-3 * f64::from(i), (0.1 * f64::from(i)).sin(), (0.1 * f64::from(i)).cos())
        })
        .collect();
    let named = |name: &str, header: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("{header}\n{rows}")).unwrap();
        path.display().to_string()
    };
    let file = named("t.csv", "Time [s],Table Z [g],A3z [g]");
    let (said, project) = onto(folder.path(), &[file], BEAM).unwrap();
    assert!(project.contains("quantity = \"base\"\ndof = \"z\""), "{project}");
    assert!(said.contains("base@z: by its name the motion of the base"), "{said}");
    let file = named("f.csv", "Time [s],Table 2z [g],Force 3z [N]");
    let (_, project) = onto(folder.path(), &[file], BEAM).unwrap();
    assert!(!project.contains("\"base\""), "{project}");
    // Without a model it loads nothing, and the file is imported all the same.
    let (said, project) = imported(folder.path(), "t.csv", &format!("Time [s],Table Z [g],A3 [g]\n{rows}"), &[]);
    assert!(project.contains("quantity = \"acc\"\ndof = \"base\"") && said.contains("give one by --mass"), "{said}");
}

#[test]
fn names_of_files_say_response_and_reference() {
    let folder = tempfile::tempdir().unwrap();
    let lines: String =
        (1..200).map(|i| format!("{},{:.3e},{:.1}\n", 0.5 * f64::from(i), 1e-3 * f64::from(i % 7 + 1), 20.0)).collect();
    let mut names = Vec::new();
    for name in ["H_2z_5z.csv", "H_5z_5z.csv"] {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("Frequency (Hz),Magnitude (g/N),Phase (deg)\n{lines}")).unwrap();
        names.push(path.display().to_string());
    }
    let out = folder.path().join("p.toml").display().to_string();
    let said = dashpot(&["import", &names[0], &names[1], "--out", &out]).unwrap();
    assert!(said.contains("by the names of the files the functions are 2z over 5z, 5z over 5z"), "{said}");
    let project = std::fs::read_to_string(&out).unwrap();
    // Responses to one reference are one test: a line is a run of both sensors.
    let test = "file = \"H_2z_5z.csv\"\nfurther_files = [\"H_5z_5z.csv\"]";
    let dofs = "responses = [\"2z\", \"5z\"]\nreferences = [\"5z\"]";
    assert!(project.contains(test) && project.contains(dofs), "{project}");
    let load = |path: &str| dashpot::exchange::project::load(path.as_ref(), &dashpot::control::Control::unattended());
    let runs = load(&out).unwrap().runs;
    assert!(runs.iter().all(|run| run.fit.channels.len() == 3) && runs[0].file.contains("H_2z_5z.csv and 1 with it"));
    for (from, to, problem) in [
        ("responses = [\"2z\", \"5z\"]", "responses = [\"2z\"]", "name fewer functions than there are"),
        (
            "responses = [\"2z\", \"5z\"]",
            "responses = [\"5z\", \"5z\"]",
            "acc@5z over force@5z is in a file before it already",
        ),
        ("[\"H_5z_5z.csv\"]", "[\"gone.csv\"]", "gone.csv"),
        ("further_files = [\"H_5z_5z.csv\"]", "", "responses` times `references` are 2"),
    ] {
        std::fs::write(&out, project.replacen(from, to, 1)).unwrap();
        let error = load(&out).unwrap_err().to_string();
        assert!(error.contains(problem) && !error.contains('\n'), "{error}");
    }
    std::fs::write(
        folder.path().join("H_5z_5z.csv"),
        format!("Frequency (Hz),Magnitude (g/N),Phase (deg)\n{}", &lines[lines.find('\n').unwrap() + 1..]),
    )
    .unwrap();
    std::fs::write(&out, &project).unwrap();
    let error = load(&out).unwrap_err().to_string();
    assert!(error.contains("its frequencies are not those of H_2z_5z.csv; give it an [[frf]] of its own"), "{error}");
}

#[test]
fn a_wav_is_a_motion_that_is_to_be_calibrated() {
    let folder = tempfile::tempdir().unwrap();
    let samples: Vec<u8> = (0..8000)
        .map(|i| f64::from(i) / 2000.0)
        .map(|t| (2e4 * (-1.5 * t).exp() * (200.0 * t).cos()) as i16)
        .flat_map(i16::to_le_bytes)
        .collect();
    let size = samples.len() as u32;
    let words = |list: &[u32]| list.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let format = [&words(&[16, 0x0001_0001, 2000, 4000])[..], &[2, 0, 16, 0]].concat();
    let bytes = [&b"RIFF"[..], &words(&[36 + size]), b"WAVEfmt ", &format, b"data", &words(&[size]), &samples].concat();
    let path = folder.path().join("ring.wav").display().to_string();
    std::fs::write(&path, bytes).unwrap();
    let out = folder.path().join("p.toml").display().to_string();
    let said = dashpot(&["import", &path, "--out", &out]).unwrap();
    assert!(said.contains("factor is 1 m a full scale, fill in its own") && said.contains("decay"), "{said}");
    let amplitude = json(&["amplitude", "--json", &out]);
    let curve = amplitude.to_string();
    assert!(curve.contains("damping"), "{curve}");
}

#[test]
fn a_force_and_a_displacement_at_one_point_may_be_a_component() {
    let folder = tempfile::tempdir().unwrap();
    let row = |i: u32| {
        let t = 1e-3 * f64::from(i);
        format!("{t},{},{}\n", 0.01 * (30.0 * t).sin(), 40.0 * (30.0 * t).cos())
    };
    let rows: String = (0..2000).map(row).collect();
    let (_, project) = imported(folder.path(), "c.csv", &format!("time [s],disp [m],force [N]\n{rows}"), &[]);
    assert!(project.contains("# If this is one component in a testing machine"), "{project}");
    // What the comment says is a project.
    let out = folder.path().join("p.toml");
    let component = project.replace("kind = \"points\"\ndofs = [\"1\"]", "kind = \"component\"");
    assert_ne!(component, project);
    std::fs::write(&out, component).unwrap();
    assert!(dashpot(&["compare", &out.display().to_string()]).is_ok());
}

#[test]
fn a_hammer_that_is_named_by_its_place_may_move_from_file_to_file() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..600)
        .map(|i| f64::from(i) * 1e-3)
        .map(|t| format!("{t:.4},{:.6},{:.6}\n", (190.0 * t).sin(), (190.0 * t).cos()))
        .collect();
    let write = |name: &str, hammer: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("Time [s],Hammer {hammer} [N],Acc 8z [m/s^2]\n{rows}")).unwrap();
        path.display().to_string()
    };
    let files = [write("a.csv", "4z"), write("b.csv", "10z"), write("c.csv", "4z")];
    let (said, project) = onto(folder.path(), &files, BEAM).unwrap();
    assert!(said.contains("3 runs of 3 channels"), "{said}");
    assert_eq!(project.matches("optional = true").count(), 2, "{project}");
    let out = folder.path().join("p.toml");
    let loaded = dashpot::exchange::project::load(&out, &dashpot::control::Control::unattended()).unwrap();
    let names = |run: &dashpot::measurement::Run| {
        let all = run.fit.channels.iter().map(|channel| channel.channel.to_string());
        all.filter(|name| name.starts_with("force")).collect::<Vec<_>>().join(" ")
    };
    let forces: Vec<String> = loaded.runs.iter().map(names).collect();
    assert_eq!(forces, ["force@4z", "force@10z", "force@4z"]);
    // A channel that is not optional is missed.
    std::fs::write(&out, project.replacen("optional = true", "optional = false", 1)).unwrap();
    let error = dashpot(&["identify", &out.display().to_string()]).unwrap_err();
    assert!(error.contains("the file has no channel of that name"), "{error}");
}

/// A chain of five masses with a dashpot of 6 N s/m at the third, and what a sensor at each shows for a force at the fifth, m/s^2/N.
fn chain_accelerance(frequency_hz: f64) -> Vec<[f64; 2]> {
    use faer::linalg::solvers::Solve;
    let omega = std::f64::consts::TAU * frequency_hz;
    let dynamic = faer::Mat::from_fn(5, 5, |i, j| {
        let spring = 4e4
            * if i == j {
                if i == 4 { 1.0 } else { 2.0 }
            } else if i.abs_diff(j) == 1 {
                -1.0
            } else {
                0.0
            };
        let inertia = if i == j { omega * omega } else { 0.0 };
        faer::c64::new(spring - inertia, if i == 2 && j == 2 { 6.0 * omega } else { 0.0 })
    });
    let force = faer::Mat::from_fn(5, 1, |i, _| faer::c64::new(f64::from(u8::from(i == 4)), 0.0));
    let motion = dynamic.partial_piv_lu().solve(&force);
    (0..5).map(|i| [-omega * omega * motion[(i, 0)].re, -omega * omega * motion[(i, 0)].im]).collect()
}

const CHAIN: &str = "[structure]\nkind = \"chain\"\nmasses = [1, 1, 1, 1, 1]\nground_stiffness = [4e4, 0, 0, 0, 0]\n\
                     coupling_stiffness = [4e4, 4e4, 4e4, 4e4]\n";

/// The chain's functions over 3 to 70 Hz, a column named by `name` for each of the responses.
fn chain_functions(name: impl Fn(usize) -> String) -> String {
    let mut text = String::from("Frequency [Hz]");
    (1..=5).for_each(|i| text.push_str(&format!(",{0} Real [m/s^2/N],{0} Imag [m/s^2/N]", name(i))));
    for line in 0..540 {
        let frequency = 3.0 + 0.125 * f64::from(line);
        text.push_str(&format!("\n{frequency}"));
        chain_accelerance(frequency).iter().for_each(|[re, im]| text.push_str(&format!(",{re:.9e},{im:.9e}")));
    }
    text
}

/// Sensors along z and hits along -z on a model that moves along x, and elements of a matrix: either way the dashpot is found.
#[test]
fn functions_lie_on_a_chain_whatever_their_axis_is_called() {
    let folder = tempfile::tempdir().unwrap();
    for (file, text, words) in [
        (
            "axis.csv",
            chain_functions(|i| format!("{i}:+Z/5:+Z")),
            "assumed: the model moves in one direction only: 1:+Z is taken for its DOF 1, and 4 more likewise",
        ),
        ("matrix.csv", chain_functions(|i| format!("H{i}5")), "the functions are 1, 2, 3, 4, 5 over 5"),
        ("points.csv", chain_functions(|i| format!("Point {i}")), "signs of a driving point, all driven at 5"),
    ] {
        let file = folder.path().join(file).display().to_string();
        std::fs::write(&file, text).unwrap();
        let (said, project) = onto(folder.path(), &[file], CHAIN).unwrap();
        assert!(said.contains(words), "{said}");
        let found = json(&["identify", "--json", &folder.path().join("p.toml").display().to_string()]);
        let sources = found["sources"].as_array().unwrap();
        assert_eq!((sources.len(), sources[0]["dofs"][0].as_str()), (1, Some("3")), "{project}");
        assert!((sources[0]["parameters"]["c"].as_f64().unwrap() / 6.0 - 1.0).abs() < 0.01, "{found}");
    }
}

/// Hits of one session in one file, on a model that moves along x: each run has a name of its own in every result.
#[test]
fn hits_of_one_file_lie_on_a_chain_and_have_names_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::new();
    for frequency in [4.5, 13.0] {
        let motion = chain_accelerance(frequency);
        text.push_str(&format!("Step {frequency}\nTime [s],Force 5z [N],Acc 3z [m/s^2],Acc 5z [m/s^2]\n"));
        for i in 0..2000 {
            let (time, turn) = (f64::from(i) / 1000.0, std::f64::consts::TAU * frequency * f64::from(i) / 1000.0);
            let [a, b] = [2, 4].map(|k: usize| motion[k][0] * turn.cos() - motion[k][1] * turn.sin());
            text.push_str(&format!("{time},{:.9},{a:.9},{b:.9}\n", turn.cos()));
        }
        text.push('\n');
    }
    let file = folder.path().join("steps.csv").display().to_string();
    std::fs::write(&file, text).unwrap();
    let (said, project) = onto(folder.path(), &[file], CHAIN).unwrap();
    assert!(said.contains("the model moves in one direction only: 3z is taken for its DOF 3"), "{said}");
    assert_eq!(project.matches("dof = 5\n").count(), 2, "{project}");
    let found = json(&["identify", "--json", &folder.path().join("p.toml").display().to_string()]);
    let names: Vec<&str> = found["runs"].as_array().unwrap().iter().map(|run| run["file"].as_str().unwrap()).collect();
    assert_eq!(names, ["steps.csv 1", "steps.csv 2"]);
    assert!((found["sources"][0]["parameters"]["c"].as_f64().unwrap() / 6.0 - 1.0).abs() < 0.01, "{found}");
}

/// The numbers in the names of points are nodes of a beam in frequency responses as in records, leading zeros or not.
#[test]
fn numbers_of_functions_are_nodes_of_a_beam_where_they_cannot_be_translations() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("points.csv").display().to_string();
    std::fs::write(&file, chain_functions(|i| format!("Punkt {:02}", i + 3))).unwrap();
    let (said, project) = onto(folder.path(), &[file], BEAM).unwrap();
    assert!(project.contains("responses = [\"4z\", \"5z\", \"6z\", \"7z\", \"8z\"]"), "{project}");
    assert!(project.contains("references = [\"8z\"]"), "{project}");
    assert!(said.contains("4 is taken for the node: 4z is its translation, and 4 more likewise"), "{said}");
}

/// Accelerances of the beam with its dashpot at nodes 4, 6, 8 and 9 for a force at node `driven`, by simulation, as a table
/// of points.
fn beam_functions(folder: &Path, driven: usize) -> String {
    let truth = folder.join("truth.toml");
    let force = 2 * driven - 1;
    let text = format!(
        "[project]\nformat = 1\n{BEAM}[[source]]\nlaw = \"viscous\"\ndofs = [9]\nstate = \"known\"\nc = {C}\n[[frf]]\n\
         file = \"h.uff\"\naverages = 8\nband = [0, 400]\n[simulate]\nsamples = 1601\n\
         channels = [\"force@{force} [N]\", \"acc@7 [m/s^2]\", \"acc@11 [m/s^2]\", \"acc@15 [m/s^2]\", \"acc@17 [m/s^2]\"]\n"
    );
    std::fs::write(&truth, text).unwrap();
    let [truth, out] = [truth, folder.to_owned()].map(|path| path.display().to_string());
    dashpot(&["simulate", "--noise", "0.01", "--seed", "2", "--as", "frf", "--out", &out, &truth]).unwrap();
    let file = dashpot_datafiles::open(&folder.join("h.uff")).unwrap();
    let mut columns = Vec::new();
    let mut frequencies = Vec::new();
    for (s, set) in file.contents().sets.iter().enumerate().filter(|(_, set)| set.kind == dashpot_datafiles::Kind::Frf)
    {
        for c in (0..set.channels.len()).filter(|&c| set.channels[c].complex) {
            frequencies = file.axis(s, c).unwrap().unwrap();
            let dashpot_datafiles::Values::Complex(values) = file.read(s, c).unwrap() else { unreachable!() };
            columns.push(values);
        }
    }
    let mut text = String::from("Frequency [Hz]");
    ["4", "6", "8", "9"].iter().for_each(|p| text.push_str(&format!(",P {p} Real [m/s^2/N],P {p} Imag [m/s^2/N]")));
    for (line, frequency) in frequencies.iter().enumerate() {
        text.push_str(&format!("\n{frequency}"));
        columns.iter().for_each(|column| text.push_str(&format!(",{},{}", column[line][0], column[line][1])));
    }
    text
}

/// Which of the points is hit is told under noise; where the force acts at none of them, by the modes of the model.
#[test]
fn the_hit_point_of_functions_is_told_under_noise_by_signs_or_by_the_modes_of_the_model() {
    let folder = tempfile::tempdir().unwrap();
    for (driven, reference, words) in [
        (9, "references = [\"9z\"]", "signs of a driving point"),
        (10, "references = [\"10z\"]", "by the modes of the model the force acts at DOF 10z"),
    ] {
        let file = folder.path().join("points.csv").display().to_string();
        std::fs::write(&file, beam_functions(folder.path(), driven)).unwrap();
        let (said, project) = onto(folder.path(), &[file], BEAM).unwrap();
        assert!(project.contains(reference) && said.contains(words), "{said}{project}");
    }
}

/// A hammer that is always the same channel: where it hit is the number by which the names of the files differ.
#[test]
fn a_roving_hammer_hits_at_the_numbers_in_the_names_of_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let header = "Time [s],Hammer [N],Acc P8 [m/s^2]";
    let rows: String = (0..400)
        .map(|i| {
            let time = f64::from(i) / 2000.0;
            let turn = std::f64::consts::TAU * 60.0 * time;
            format!("{time},{},{}\n", turn.cos(), 2.0 * turn.sin())
        })
        .collect();
    let write = |name: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("{header}\n{rows}")).unwrap();
        path.display().to_string()
    };
    let files = [write("hit 1 P4.csv"), write("hit 2 P4.csv"), write("hit 3 P10.csv")];
    let (said, project) = onto(folder.path(), &files, BEAM).unwrap();
    assert!(said.contains("by the numbers in the names of the runs it acts at 4z, 4z, 10z"), "{said}");
    assert_eq!(project.matches("dofs = { \"Hammer\" = \"4z\" }").count(), 2, "{project}");
    let out = folder.path().join("p.toml");
    let loaded = dashpot::exchange::project::load(&out, &dashpot::control::Control::unattended()).unwrap();
    let force = |run: &dashpot::measurement::Run| {
        run.fit.channels.iter().map(|fit| fit.channel.to_string()).find(|name| name.starts_with("force")).unwrap()
    };
    assert_eq!(loaded.runs.iter().map(force).collect::<Vec<_>>(), ["force@4z", "force@4z", "force@10z"]);
    std::fs::write(&out, project.replacen("{ \"Hammer\"", "{ \"Hamer\"", 1)).unwrap();
    let error = dashpot(&["identify", &out.display().to_string()]).unwrap_err();
    assert!(error.contains("Hamer") && error.contains("\"Hammer\""), "{error}");
}
