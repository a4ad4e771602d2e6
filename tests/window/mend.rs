//! Channels that were connected or read wrongly: named before all else, mended in the mapping by one click, taken back by undo.

use crate::support::{Sample, open, settle};
use dashpot::cli::answer;
use dashpot::diagnosis::channels::ChannelFault;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use egui::{Key, Modifiers, Theme, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

/// A beam with a dashpot at its end; the stiffness in Pa.
pub(super) fn beam(youngs_modulus: f64) -> String {
    format!(
        "[project]\nformat = 1\ntitle = \"Cables mixed up\"\n[structure]\nkind = \"beam\"\nlength = 0.56\nbreadth = 0.04\n\
         depth = 0.004\nyoungs_modulus = {youngs_modulus:?}\ndensity = 2700.0\nelements = 10\nsupports = \"clamped-free\"\n\
         [[source]]\nlaw = \"viscous\"\ndofs = [19]\nstate = \"known\"\nc = 0.2\n"
    )
}

fn runs(more: &str) -> String {
    let run = |(i, f): (usize, &f64)| format!("[[run]]\nfile = \"run-{i}.csv\"\nfrequency = {f:?}\n{more}");
    [9.6, 11.2, 61.0, 66.0, 176.0, 186.0].iter().enumerate().map(run).collect()
}

/// Records with 1 % noise beside a model whose stiffness is 0.3 % too high, each changed by `header` and `values`.
fn recorded(header: impl Fn(&str) -> String, values: impl Fn(&mut [f64])) -> Sample {
    let folder = tempfile::tempdir().unwrap();
    let channels = "[simulate]\nchannels = [\"force@19 [N]\", \"acc@3 [m/s^2]\", \"acc@7 [m/s^2]\", \"acc@11 [m/s^2]\", \
                    \"acc@15 [m/s^2]\", \"acc@19 [m/s^2]\"]\n";
    let truth = folder.path().join("truth.toml");
    std::fs::write(&truth, beam(69e9) + &runs("force_dof = 19\nforce_n = 1.0\n") + channels).unwrap();
    let out = folder.path().as_os_str();
    let simulate = ["dashpot", "simulate", "--noise", "0.01", "--seed", "4", "--out"].map(std::ffi::OsString::from);
    answer(simulate.into_iter().chain([out.to_owned(), truth.as_os_str().to_owned()])).unwrap();
    for i in 0..6 {
        let file = folder.path().join(format!("run-{i}.csv"));
        let text = std::fs::read_to_string(&file).unwrap();
        let (first, rest) = text.split_once('\n').unwrap();
        let changed = |line: &str| {
            let mut row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            values(&mut row);
            row.iter().map(ToString::to_string).collect::<Vec<_>>().join(",") + "\n"
        };
        std::fs::write(&file, header(first) + "\n" + &rest.lines().map(changed).collect::<String>()).unwrap();
    }
    let path = folder.path().join("project.toml");
    std::fs::write(&path, beam(69.2e9) + &runs("")).unwrap();
    Sample { _folder: folder, path }
}

/// Error of the model as it stands and what is said of the channels.
fn found(harness: &Harness<'_, App>) -> (f64, Vec<String>) {
    let app = harness.state();
    let (document, explained) = (app.document.as_ref().unwrap(), &app.derived.explained);
    let faults = &explained.diagnosis(document).unwrap().as_ref().unwrap().channel_faults;
    (explained.comparison(document).unwrap().as_ref().unwrap().error, faults.iter().map(ChannelFault::words).collect())
}

/// The fault is named, a click on `Mend` writes `mapping` and the error falls by half at least; undo takes it back. Pictures of
/// before and after take `name`.
fn mended(sample: &Sample, words: &str, name: Option<&str>, mapping: impl Fn(&dashpot::session::Document) -> bool) {
    let mut harness = open(sample, Theme::Light);
    harness.state_mut().view.stage = Stage::Explain;
    settle(&mut harness);
    let picture = |harness: &mut Harness<'_, App>, when: &str| {
        let Some(name) = name else { return };
        harness.remove_cursor();
        settle(harness);
        harness.snapshot(format!("{name}-{when}"));
    };
    let (before, said) = found(&harness);
    assert_eq!(said, [words]);
    harness.get_by_label_contains(words);
    picture(&mut harness, "before");
    harness.get_by_role_and_label(Role::Button, "Mend").click();
    settle(&mut harness);
    let (after, said) = found(&harness);
    assert!(said.is_empty() && after < 0.5 * before, "{said:?}: error {before} before, {after} after");
    assert!(mapping(harness.state().document.as_ref().unwrap().session().document()));
    picture(&mut harness, "after");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut harness);
    assert_eq!(found(&harness), (before, vec![words.to_owned()]));
}

/// The table of a channel by its name in the records.
fn table<'a>(document: &'a dashpot::session::Document, name: &str) -> &'a dashpot::exchange::mapping::ChannelTable {
    document.file().channel.iter().find(|table| table.name.starts_with(name)).unwrap()
}

#[test]
fn a_reversed_channel_is_mended_by_a_click() {
    let sample = recorded(str::to_owned, |row| row[3] = -row[3]);
    mended(&sample, "acc@7 looks reversed", Some("mend-reversed"), |document| {
        table(document, "acc@7").sign.is_some_and(|sign| sign < 0)
    });
}

#[test]
fn a_channel_in_multiples_of_free_fall_is_mended_by_a_click() {
    // The file gives g and its header says m/s^2.
    let sample = recorded(str::to_owned, |row| row[4] /= 9.806_65);
    mended(&sample, "acc@11 reads 9.81 times too small: g read as m/s^2?", None, |document| {
        let table = table(document, "acc@11");
        table.factor.is_some() || table.unit.is_some()
    });
}

#[test]
fn exchanged_cables_are_mended_by_a_click() {
    let swap = |header: &str| header.replace("acc@7", "acc@x").replace("acc@15", "acc@7").replace("acc@x", "acc@15");
    mended(&recorded(swap, |_| {}), "acc@15 and acc@7 look exchanged", None, |document| {
        table(document, "acc@7").channel().starts_with("acc@15")
            && table(document, "acc@15").channel().starts_with("acc@7")
    });
}
