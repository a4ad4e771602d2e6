//! A project of 200 runs and 40 channels is as easy as one of 8: an overview first, tables that are sorted and filtered.

use crate::common::models::cantilever_parameters;
use crate::events::spent;
use crate::support::{Sample, open, settle};
use dashpot::effects::{Effect, Place, Source};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::structure::beam::BeamParameters;
use dashpot::window::app::view::Stage;
use dashpot::window::frame::panes::Pane;
use dashpot::window::stages::run_table::Key;
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use faer::c64;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::time::Instant;

const CHANNELS: usize = 40;
const LEVELS: i32 = 4;
const RUNS: usize = 200;

/// A cantilever of an element a channel, as harmonics: frequencies about three resonances at each of four levels, `count` runs in all,
/// one dashpot that is not stated.
fn many(count: usize, channels: usize) -> Sample {
    let parameters = BeamParameters { length: 1.0, depth: 0.006, ..cantilever_parameters(channels) };
    let structure = parameters.build(&[]).unwrap();
    let truth = [Source::known(Effect::Viscous, Place::Dofs(vec![channels]), &[1.5])];
    let (modes, stiffness) = (structure.modes().unwrap(), DynamicStiffness::new(&structure, &truth).unwrap());
    let force = 2 * channels - 2;
    let mut text = format!(
        "[project]\nformat = 1\ntitle = \"Two hundred runs\"\n[structure]\nkind = \"beam\"\nlength = 1.0\nbreadth = 0.04\n\
         depth = 0.006\nyoungs_modulus = 69e9\ndensity = 2700.0\nelements = {channels}\nsupports = \"clamped-free\"\n"
    );
    let folder = tempfile::tempdir().unwrap();
    for level in 1..=LEVELS {
        let mut table = "run,frequency_hz,channel,harmonic,cos,sin".to_owned();
        let steps = count as i32 / LEVELS;
        for step in 0..steps {
            let across = f64::from(step / 3) / f64::from((steps / 3).max(1));
            let omega = modes.omega[(step % 3) as usize] * (0.94 + 0.12 * across);
            let mut load = vec![c64::new(0.0, 0.0); structure.len()];
            load[force] = c64::new(f64::from(level), 0.0);
            let x = stiffness.solve(omega, &load).unwrap();
            let (run, frequency) = (format!("sweep-{level}-{step:02}"), omega / TAU);
            write!(table, "\n{run},{frequency:.9},force@{} [N],1,{level},0", structure.label(force)).unwrap();
            for k in 0..channels {
                let y =
                    x[2 * k] * (-omega * omega) * (1.0 + 0.004 * f64::from((step * 7 + k as i32 * 3) % 11 - 5) / 5.0);
                let label = structure.label(2 * k);
                write!(table, "\n{run},{frequency:.9},acc@{label} [m/s^2],1,{:.9e},{:.9e}", y.re, -y.im).unwrap();
            }
        }
        std::fs::write(folder.path().join(format!("sweep-{level}.csv")), table).unwrap();
        write!(text, "[[harmonics]]\nfile = \"sweep-{level}.csv\"\nlevel = {level}\n").unwrap();
    }
    let path = folder.path().join("project.toml");
    std::fs::write(&path, text).unwrap();
    Sample { _folder: folder, path }
}

#[test]
fn many_runs_open_on_an_overview_and_are_sorted_and_filtered() {
    let sample = many(RUNS, CHANNELS);
    let mut harness = open(&sample, Theme::Light);
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), RUNS);
    let seen = |harness: &egui_kittest::Harness<'_, dashpot::window::App>, pane| {
        harness.state().desk.rect(Stage::Measure, pane).is_some()
    };
    assert!(seen(&harness, Pane::Overview) && !seen(&harness, Pane::Record));
    harness.get_by_role_and_label(Role::Button, "Sort by frequency").click();
    settle(&mut harness);
    assert_eq!(harness.state().view.runs.key, Key::Frequency);
    let p = &harness.state().document.as_ref().unwrap().project;
    let rows = harness.state().view.runs.rows(p, |_| None);
    assert!(rows.windows(2).all(|w| p.runs[w[0]].fit.omega <= p.runs[w[1]].fit.omega));
    harness.get_by_role_and_label(Role::TextInput, "Filter").click();
    settle(&mut harness);
    harness.event(egui::Event::Text("level 3".to_owned()));
    settle(&mut harness);
    harness.get_by_label("50 of 200 runs");
    harness.remove_cursor();
    settle(&mut harness);
    harness.snapshot("many-runs");
    // Together by level, in the order of their frequencies each.
    harness.state_mut().view.runs.filter.clear();
    harness.get_by_role_and_label(Role::CheckBox, "By level").click();
    settle(&mut harness);
    let p = &harness.state().document.as_ref().unwrap().project;
    let rows = harness.state().view.runs.rows(p, |_| None);
    assert_eq!(rows.len(), RUNS);
    let order = |r: usize| (p.runs[r].level, p.runs[r].fit.omega);
    assert!(rows.windows(2).all(|w| order(w[0]) <= order(w[1])), "by level, then by frequency");
}

/// Longest median frame, time of the processor; four times as much where nothing is optimised.
const FLUID: f64 = if cfg!(debug_assertions) { 32e-3 } else { 8e-3 };

/// Median time of the processor that a frame takes while the pointer moves and the wheel turns, s.
fn frame_time(harness: &mut egui_kittest::Harness<'_, dashpot::window::App>) -> f64 {
    let clock = Instant::now();
    let mut times = Vec::new();
    for k in 0..60 {
        let x = 60.0 + 20.0 * (k % 40) as f32;
        harness.event(egui::Event::PointerMoved(egui::pos2(x, 620.0 + (k % 7) as f32)));
        let before = spent(clock);
        harness.step();
        times.push(spent(clock).saturating_sub(before).as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

#[test]
fn two_thousand_runs_stay_fluid() {
    let sample = many(2000, 8);
    let mut harness = open(&sample, Theme::Light);
    assert_eq!(harness.state().document.as_ref().unwrap().project.runs.len(), 2000);
    let mut slow = Vec::new();
    for stage in Stage::ALL {
        harness.state_mut().view.stage = stage;
        settle(&mut harness);
        let time = frame_time(&mut harness);
        println!("{}: {:.1} ms a frame, drawing aside", stage.label(), 1e3 * time);
        if time >= FLUID {
            slow.push(format!("{}: {:.1} ms a frame", stage.label(), 1e3 * time));
        }
    }
    assert!(slow.is_empty(), "{slow:?}");
}
