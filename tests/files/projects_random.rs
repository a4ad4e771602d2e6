//! Any text, and any damage to a good project, ends in a project or in one line, never in a panic.

use super::projects::FULL;
use dashpot::exchange::matrices::parse_market;
use dashpot::exchange::matrices::table::{parse_dofs, parse_lines, parse_matrix_csv, parse_nodes};
use dashpot::exchange::project::{ProjectFile, plan};
use proptest::prelude::*;
use std::path::Path;

fn read(text: &str) {
    if let Err(error) = plan(text, Path::new("p.toml")) {
        let message = error.to_string();
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}

/// Pieces from which nearly valid projects are made.
fn piece() -> impl Strategy<Value = String> {
    let words = [
        "[project]\nformat = 1\n",
        "[structure]\n",
        "kind = ",
        "\"points\"\n",
        "\"chain\"\n",
        "\"beam\"\n",
        "dofs = [1, 2]\n",
        "masses = [1, 1]\nground_stiffness = [1, 1]\ncoupling_stiffness = [1]\n",
        "[[source]]\n",
        "law = \"viscous\"\n",
        "law = \"loss_factor\"\n",
        "state = \"known\"\n",
        "c = ",
        "1e400",
        "-0.0",
        "nan",
        "[1, 3]\n",
        "elements = ",
        "\n",
        "[[run]]\nfile = \"a.csv\"\n",
        "[[candidates]]\n",
        "where = \"chain\"\n",
        "[analysis]\n",
        "keep = 9223372036854775807\n",
        "elements = [-9e99, 9e99]\n",
        "[[sensor]]\nchannel = \"acc@1\"\n",
        "gain = 0\n",
        "[[harmonics]]\n",
        "é",
        "\0",
        "'''",
        "{",
    ];
    prop_oneof![proptest::sample::select(words.to_vec()).prop_map(str::to_owned), any::<String>()]
}

proptest! {
    #[test]
    fn any_text(text in any::<String>()) {
        read(&text);
    }

    #[test]
    fn pieces_in_any_order(pieces in proptest::collection::vec(piece(), 0..14)) {
        read(&pieces.concat());
    }

    #[test]
    fn a_damaged_project(at in 0..FULL.len(), length in 0_usize..40, put in any::<String>()) {
        let mut text = FULL.to_owned();
        text.replace_range(at..(at + length).min(FULL.len()), &put);
        read(&text);
    }

    #[test]
    fn damaged_tables(text in "[0-9a-z%.,; \n-]{0,80}", at in 0_usize..70) {
        let good = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 2\n2 2 3\n";
        let mut market = good.to_owned();
        market.insert_str(at.min(good.len()), &text);
        let _ = parse_market(&market, "m");
        let _ = parse_matrix_csv(&text, "m");
        let _ = parse_nodes(&format!("node,x,y,z\n{text}"), "n");
        let _ = parse_dofs(&format!("dof,node,direction\n{text}"), "d");
        let _ = parse_lines(&format!("node,node\n{text}"), "l");
    }

    #[test]
    fn any_values_survive_saving(
        title in any::<String>(),
        c in 0.0..1e30_f64,
        gain in 1e-300..1e30_f64,
        frequency in proptest::option::of(1e-300..1e30_f64),
        level in proptest::option::of(any::<i64>()),
        enabled in any::<bool>(),
        label in any::<String>(),
        samples in 16_usize..100_000_000,
    ) {
        let (mut file, _) = ProjectFile::parse(FULL, "p.toml").unwrap();
        file.project.title = title;
        file.source[0].parameters.insert("c".into(), c);
        file.source[1].dofs[0].0 = label.clone();
        file.sensor[0].gain = Some(gain);
        file.run[0].frequency = frequency;
        file.run[0].level = level;
        file.run[0].enabled = Some(enabled);
        file.run[0].file = label;
        file.simulate.samples = samples;
        let text = file.to_toml().unwrap();
        let (again, _) = ProjectFile::parse(&text, "again.toml").map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?;
        prop_assert_eq!(again, file);
    }
}
