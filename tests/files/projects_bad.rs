//! Bad projects, each with its message.

use dashpot::exchange::project::plan;
use std::path::Path;

const BEAM: &str = r#"[project]
format = 1
[structure]
kind = "beam"
length = 0.56
breadth = 0.04
depth = 0.004
youngs_modulus = 69e9
density = 2700
elements = 10
supports = "clamped-free"
"#;

const CHAIN: &str = "[project]\nformat = 1\n[structure]\nkind = \"chain\"\nmasses = [1, 2.5, 3]\n\
    ground_stiffness = [100, 0, 0]\ncoupling_stiffness = [50, 60]\n";

const POINTS: &str = "[project]\nformat = 1\n[structure]\nkind = \"points\"\ndofs = [1, \"b\"]\n";

fn refused(text: &str, expected: &str) {
    let message = plan(text, Path::new("p.toml")).map(|_| ()).unwrap_err().to_string();
    assert_eq!(message, expected, "for\n{text}");
    assert!(!message.contains('\n'), "{message}");
}

/// The beam followed by more lines, the first of which is line 12.
fn beam(more: &str, expected: &str) {
    refused(&format!("{BEAM}{more}"), expected);
}

/// The chain followed by more lines, the first of which is line 8.
fn chain(more: &str, expected: &str) {
    refused(&format!("{CHAIN}{more}"), expected);
}

#[test]
fn documents() {
    refused("", "p.toml:1: the project lacks `project`; add `[project]`");
    refused("[project]\ntitle = \"a\"\n", "p.toml:1: [project] lacks `format`; add `format = 1`");
    refused(
        "[project]\nformat = 2\nwings = 3\n",
        "p.toml:2: format 2 was written by a newer version of dashpot; this one reads format 1, so update dashpot",
    );
    refused("[project]\nformat = 0\n", "p.toml:2: `format = 0` is not a usable number; it must be 1");
    refused("[project]\nformat = \"1\"\n", "p.toml:2: `format` must be a whole number, not a text");
    refused("[project]\nformat = 1\n", "p.toml:1: the project lacks `structure`; add `[structure]`");
    refused("project = 3\n", "p.toml:1: `project` must be a table, not a whole number");
    refused(
        "[project]\nformat = 1\nname = \"a\"\n",
        "p.toml:3: [project] has no key `name`; it takes `format`, `title`, `notes`",
    );
    let message = plan("[project]\nformat = \n", Path::new("p.toml")).unwrap_err().to_string();
    assert!(message.starts_with("p.toml:2: not valid TOML: "), "{message}");
    refused(
        "[project]\nformat = 1\ntitle = \"C:\\data\"\n",
        "p.toml:3: not valid TOML: a backslash between quotation marks begins a special letter; write paths with /, or in single \
         quotes ('C:\\data\\a.csv')",
    );
    let message = plan("[project]\nformat = 1\nformat = 1\n", Path::new("p.toml")).unwrap_err().to_string();
    assert!(message.starts_with("p.toml:3: not valid TOML: duplicate key"), "{message}");
}

#[test]
fn tables() {
    beam("[[sources]]\n", "p.toml:12: the project has no key `sources`; did you mean `source`?");
    beam(
        "[run]\n",
        "p.toml:12: `run` must be written as a list of tables, each under its name in double brackets, not a table",
    );
    beam(
        "run = 3\n",
        "p.toml:12: [structure] has no key `run`; it takes `kind`, `lumped_mass`, `correction`, `length`, `breadth`, `depth`, \
        `youngs_modulus`, `density`, `elements`, `supports`",
    );
}

#[test]
fn structures() {
    refused(
        "[project]\nformat = 1\n[structure]\nkind = \"plate\"\n",
        "p.toml:4: `kind = \"plate\"` is not understood; use one of \"beam\", \"chain\", \"matrices\", \"points\", \"component\"",
    );
    refused(
        "[project]\nformat = 1\n[structure]\nlength = 1\n",
        "p.toml:3: [structure] lacks `kind`; add `kind = \"beam\"`",
    );
    let without = BEAM.replace("depth = 0.004\n", "");
    refused(&without, "p.toml:3: [structure] lacks `depth`; add `depth = 0.004`");
    refused(&BEAM.replace("depth = ", "dept = "), "p.toml:7: [structure] has no key `dept`; did you mean `depth`?");
    refused(
        &BEAM.replace("0.56", "inf"),
        "p.toml:5: `length = inf` is not a usable number; it must be finite, from -1e30 to 1e30",
    );
    refused(&BEAM.replace("0.56", "\"0.56\""), "p.toml:5: `length` must be a number, not a text");
    refused(&BEAM.replace("0.56", "-1"), "p.toml:5: length is -1 m: give a positive number of at most 1e30");
    refused(
        &BEAM.replace("= 10", "= 0"),
        "p.toml:10: `elements = 0` is not a usable number; it must be between 1 and 10000",
    );
    refused(
        &BEAM.replace("= 10", "= 2.5"),
        "p.toml:10: `elements` must be a whole number, not a number with a decimal point",
    );
    refused(
        &BEAM.replace("clamped-free", "clamped"),
        "p.toml:11: `supports = \"clamped\"` is not understood; use one of \
        \"clamped-free\", \"free-free\", \"pinned-pinned\", \"clamped-clamped\", \"clamped-pinned\"",
    );
    refused(
        &CHAIN.replace("[50, 60]", "[50]"),
        "p.toml:7: coupling_stiffness has 1 values but 2 are needed (one less than masses)",
    );
    refused(
        &CHAIN.replace("[50, 60]", "[50, true]"),
        "p.toml:7: `coupling_stiffness` must be a number, not true or false",
    );
    refused(&POINTS.replace("\"b\"", "1"), "p.toml:5: the DOF label \"1\" is used twice: labels must differ");
    beam(
        "[[structure.lumped_mass]]\ndof = 99\nmass = 1\n",
        "p.toml:12: there is no DOF \"99\"; labels near it: 20, 19, 18, 17, 16",
    );
    refused(
        &format!("{POINTS}[[structure.lumped_mass]]\ndof = 1\nmass = 1\n"),
        "p.toml:6: a `points` structure has no mass matrix to add a lumped mass to; leave it out or give the matrices",
    );
    refused(
        "[project]\nformat = 1\n[structure]\nkind = \"matrices\"\nmass = \"no/m.mtx\"\nstiffness = \"k.mtx\"\n",
        "no/m.mtx: cannot be read: No such file or directory (os error 2); check the path",
    );
}

#[test]
fn sources() {
    chain(
        "[[source]]\nlaw = \"viscos\"\nstate = \"known\"\n",
        "p.toml:9: `law = \"viscos\"` is not understood; use one of \
        \"viscous\", \"coulomb\", \"quadratic\", \"power\", \"hysteretic\", \"stribeck\", \"elastic_slider\", \"maxwell\", \"iwan\", \
        \"fractional\", \"bouc_wen\", \"stiffening_bouc_wen\", \"dahl\", \"elastic_slider_backlash\", \"asymmetric_viscous\", \"asymmetric_coulomb\", \"stiffness\", \"cubic_stiffness\", \"quadratic_stiffness\", \"gap\", \"stop\", \"mass\", \"loss_factor\", \
        \"stiffness_proportional\", \"mass_proportional\", \"delay\", \"gain\"",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\ndofs = [1]\n",
        "p.toml:8: [[source]] lacks `state`; add `state = \"candidate\"`",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\n",
        "p.toml:9: law `viscous` needs a value for `c` [N s/m] where it is known: add `c = ...`",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nk = 3\n",
        "p.toml:12: [[source]] has no key `k`; it takes `law`, `dofs`, `elements`, `state`, `c`",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = -3\n",
        "p.toml:12: `c = -3` of law `viscous` is out of range: it must be at least 0 N s/m",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\ndofs = [4]\nstate = \"candidate\"\n",
        "p.toml:10: there is no DOF \"4\"; labels near it: 3, 2, 1",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\ndofs = [1, 1]\nstate = \"candidate\"\n",
        "p.toml:10: entries 1 and 2 of `dofs` of law `viscous` are the same DOF: name two different ones",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\ndofs = 1\nstate = \"candidate\"\n",
        "p.toml:10: `dofs` must be a list of DOF labels, such as [3], not a whole number",
    );
    chain(
        "[[source]]\nlaw = \"viscous\"\nstate = \"candidate\"\n",
        "p.toml:9: law `viscous` acts on a relative motion: give `dofs`, one for the ground, two for a pair, more for a chain",
    );
    chain(
        "[[source]]\nlaw = \"loss_factor\"\ndofs = [1]\nstate = \"candidate\"\n",
        "p.toml:10: law `loss_factor` acts on the whole structure: leave `dofs` out (`elements = [first, last]` restricts it)",
    );
    chain(
        "[[source]]\nlaw = \"gain\"\nstate = \"known\"\ngain = 1.1\n",
        "p.toml:9: law `gain` is an error of a measuring channel; write it under [[sensor]] with `channel`",
    );
    beam(
        "[[source]]\nlaw = \"loss_factor\"\nelements = [4, 11]\nstate = \"candidate\"\n",
        "p.toml:14: `elements = [4, 11]` of law `loss_factor` is no range of the 10 beam elements: use 1 <= first <= last <= 10",
    );
    beam(
        "[[source]]\nlaw = \"loss_factor\"\nelements = [1]\nstate = \"candidate\"\n",
        "p.toml:14: `elements` must be [first, last], two whole numbers from 1, not another list",
    );
    beam(
        "[[source]]\nlaw = \"viscous\"\ndofs = [1]\nelements = [1, 2]\nstate = \"candidate\"\n",
        "p.toml:12: law `viscous` has no key `elements`; `elements` restricts laws of the whole structure only, so leave it out",
    );
    let pair = "[[source]]\nlaw = \"viscous\"\ndofs = [1, 2]\nstate = \"candidate\"\n";
    let reversed = pair.replace("[1, 2]", "[2, 1]").replace("candidate", "forced");
    chain(
        &format!("{pair}{reversed}"),
        "p.toml:12: law `viscous` at the same place is given twice, first in line 8; leave one out",
    );
}

#[test]
fn families_and_sensors() {
    chain(
        "[[candidates]]\nlaw = \"viscous\"\n",
        "p.toml:8: [[candidates]] lacks `where`; add `where = \"each-translation\"`",
    );
    chain(
        "[[candidates]]\nlaw = \"viscous\"\nwhere = \"everywhere\"\n",
        "p.toml:10: `where = \"everywhere\"` is not understood; \
        use one of \"each-translation\", \"each-dof\", \"each-pair\", \"chain\"",
    );
    refused(
        &format!("{}[[candidates]]\nlaw = \"viscous\"\nwhere = \"chain\"\n", POINTS.replace(", \"b\"", "")),
        "p.toml:8: the family `chain` finds no place on this structure; choose another `where`",
    );
    chain(
        "[[sensor]]\nchannel = \"acc@1\"\n",
        "p.toml:8: [[sensor]] lacks `gain`; add `gain = 1.02` or `delay = 1e-4`",
    );
    chain(
        "[[sensor]]\nchannel = \"acc1\"\ngain = 1\n",
        "p.toml:8: `channel = \"acc1\"` is not understood; use one of \
        force@DOF, acc@DOF, vel@DOF, disp@DOF, without a unit",
    );
    chain("[[sensor]]\nchannel = \"acc@9\"\ngain = 1\n", "p.toml:8: there is no DOF \"9\"; labels near it: 3, 2, 1");
    chain(
        "[[sensor]]\nchannel = \"acc@1\"\ngain = 1\n[[sensor]]\nchannel = \"acc@1\"\ngain = 2\n",
        "p.toml:11: the gain of \"acc@1\" is given twice, first in line 8; leave one out",
    );
}

#[test]
fn runs_and_settings() {
    chain("[[run]]\nfrequency = 10\n", "p.toml:8: [[run]] lacks `file`; add `file = \"run-01.csv\"`");
    chain(
        "[[run]]\nfile = \"a.csv\"\nfrequency = 0\n",
        "p.toml:10: `frequency = 0` is not a usable number; it must be above 0 Hz",
    );
    chain(
        "[[run]]\nfile = \"a.csv\"\n[[run]]\nfile = \"a.csv\"\n",
        "p.toml:11: the record \"a.csv\" is given twice, first in line 9; leave one out",
    );
    chain("[[run]]\nfile = \"a.csv\"\nuse = 1\n", "p.toml:10: `use` must be true or false, not a whole number");
    chain("[[run]]\nfile = \"a.csv\"\nlevel = \"high\"\n", "p.toml:10: `level` must be a whole number, not a text");
    chain(
        "[[run]]\nfile = \"a.csv\"\nforce_n = 1\n",
        "p.toml:10: `force_n` is there without `force_dof`; give both or none",
    );
    chain(
        "[[run]]\nfile = \"a.csv\"\nforce_n = 1\nforce_dof = 7\n",
        "p.toml:11: there is no DOF \"7\"; labels near it: 3, 2, 1",
    );
    chain("[[harmonics]]\n", "p.toml:8: [[harmonics]] lacks `file`; add `file = \"harmonics.csv\"`");
    chain(
        "[analysis]\nexpansion = \"magic\"\n",
        "p.toml:9: `expansion = \"magic\"` is not understood; use one of \
        \"auto\", \"none\", \"single-mode\", \"modes\", \"dynamic\"",
    );
    chain(
        "[analysis]\nharmonics = 0\n",
        "p.toml:9: `harmonics = 0` is not a usable number; it must be between 1 and 1000",
    );
    chain(
        "[analysis]\nstop_angle_deg = 91\n",
        "p.toml:9: `stop_angle_deg = 91` is not a usable number; it must be between 0 and 90 degrees",
    );
    chain("[analysis]\nmax_source = 3\n", "p.toml:9: [analysis] has no key `max_source`; did you mean `max_sources`?");
    chain(
        "[simulate]\nsamples = 2\n",
        "p.toml:9: `samples = 2` is not a usable number; it must be between 16 and 100000000",
    );
    chain(
        "[simulate]\nchannels = [\"acc@1 [m/s^2]\", \"acc@4 [m/s^2]\"]\n",
        "p.toml:9: there is no DOF \"4\"; labels near it: 3, 2, 1",
    );
    let message =
        plan(&format!("{CHAIN}[simulate]\nchannels = [\"acc@1 [furlong]\"]\n"), Path::new("p.toml")).unwrap_err();
    assert!(message.to_string().starts_with("p.toml:9: "), "{message}");
    assert!(message.to_string().contains("furlong"), "{message}");
}

#[test]
fn numbers_beyond_physical_quantities() {
    let beyond = "is not a usable number; it must be finite, from -1e30 to 1e30";
    refused(&CHAIN.replace("2.5", "1e300"), &format!("p.toml:5: `masses = 1e300` {beyond}"));
    let source = |c: &str| format!("[[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = {c}\n");
    chain(&source("1e300"), &format!("p.toml:12: `c = 1e300` {beyond}"));
    assert!(plan(&format!("{CHAIN}{}", source("1e9")), Path::new("p.toml")).is_ok());
    let correction = |factor: &str| format!("[[structure.correction]]\nwhat = \"stiffness\"\nfactor = {factor}\n");
    let no_factor = "is not a usable number; it must be from 1e-9 to 1e9";
    chain(&correction("1e40"), &format!("p.toml:10: `factor = 1e40` {beyond}"));
    chain(&correction("1e12"), &format!("p.toml:10: `factor = 1000000000000` {no_factor}"));
    chain(&correction("0"), &format!("p.toml:10: `factor = 0` {no_factor}"));
    let coupling = |modes: &str| format!("[[structure.correction]]\nwhat = \"mode_coupling\"\n{modes}factor = 1.1\n");
    assert!(plan(&format!("{CHAIN}{}", coupling("modes = [1, 2]\n")), Path::new("p.toml")).is_ok());
    let different = "`modes = [2, 2]` is not a usable number; it must be two different modes";
    chain(&coupling("modes = [2, 2]\n"), &format!("p.toml:8: {different}"));
    let late = "p.toml:10: `delay = 1000000` is not a usable number; it must be from -60 s to 60 s";
    chain("[[sensor]]\nchannel = \"acc@1\"\ndelay = 1e6\n", late);
}
