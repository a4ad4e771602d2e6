//! A frame of the window without drawing its pixels: layout, plots and tessellation, at the Measure stage with sixteen
//! channels of a million samples each under each other; close up, all of it, and while it is dragged. The goal is 8 ms.

use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::measurement::{Channel, Quantity, Record, Run};
use dashpot::window::App;
use dashpot::window::document::Document;
use dashpot::window::frame::panes::Pane;
use dashpot::window::view::Stage;
use egui::{Context, Event, Modifiers, PointerButton, Pos2, RawInput, Rect, pos2, vec2};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::hint::black_box;
use std::sync::Arc;

const CHANNELS: usize = 16;
const SAMPLES: usize = 1_000_000;
const RATE: f64 = 10_000.0;
const FREQUENCY: f64 = 50.0;

/// A chain of sixteen masses with a record of a million samples.
fn document() -> Document {
    let folder = tempfile::tempdir().expect("a folder");
    let list = |value: &str, n: usize| vec![value; n].join(", ");
    let mut text = format!(
        "[project]\nformat = 1\ntitle = \"Long records\"\n[structure]\nkind = \"chain\"\nmasses = [{}]\n\
         ground_stiffness = [1e5{}]\ncoupling_stiffness = [{}]\n[[run]]\nfile = \"run.csv\"\nfrequency = {FREQUENCY}\n",
        list("1.0", CHANNELS),
        ", 0.0".repeat(CHANNELS - 1),
        list("1e5", CHANNELS - 1)
    );
    text.push_str("[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-pair\"\n");
    let mut csv = "time [s],force@1 [N],acc@1 [m/s^2]".to_owned();
    for k in 0..400 {
        let t = f64::from(k) / RATE * 20.0;
        let _ = write!(csv, "\n{t:e},{:e},{:e}", (TAU * FREQUENCY * t).cos(), (TAU * FREQUENCY * t).sin());
    }
    let path = folder.path().join("project.toml");
    for (path, text) in [(&path, text), (&folder.path().join("run.csv"), csv)] {
        dashpot::exchange::atomic::write_atomically(path, text.as_bytes()).expect("a file");
    }
    let (mut document, _) = Document::open(&path, &Control::unattended()).expect("a project");
    let run = Run::from_record("run.csv".into(), None, true, record(), Some(FREQUENCY), 3, &[]).expect("a run");
    document.project.runs = vec![run];
    document
}

fn record() -> Arc<Record> {
    let time: Vec<f64> = (0..SAMPLES).map(|k| k as f64 / RATE).collect();
    let channel = |k: usize| {
        let quantity = if k == 0 { Quantity::Force } else { Quantity::Acceleration };
        Channel { quantity, dof: k, label: (k + 1).to_string() }
    };
    let mut seed = 1_u64;
    let samples = |k: usize| {
        let mut one = |t: &f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let noise = (seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5;
            (TAU * FREQUENCY * t + k as f64).cos() * (1.0 + 0.2 * (0.3 * t).sin()) + 0.1 * noise
        };
        time.iter().map(&mut one).collect::<Vec<f64>>()
    };
    let mut all = Vec::new();
    let mut samples = samples;
    for k in 0..CHANNELS {
        all.push(samples(k));
    }
    let channels = (0..CHANNELS).map(channel).collect();
    Arc::new(Record::new(time.clone(), channels, all).expect("a record"))
}

struct Window {
    ctx: Context,
    app: App,
    time: f64,
}

impl Window {
    /// One frame; gives back the number of triangles.
    fn frame(&mut self, events: Vec<Event>) -> usize {
        self.time += 1.0 / 60.0;
        let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(1920.0, 1080.0)));
        let input = RawInput { screen_rect, time: Some(self.time), events, ..RawInput::default() };
        let output = self.ctx.run_ui(input, |ui| self.app.frame(ui));
        let shapes = self.ctx.tessellate(output.shapes, 1.0);
        let triangles = |p: &egui::ClippedPrimitive| match &p.primitive {
            egui::epaint::Primitive::Mesh(mesh) => mesh.indices.len() / 3,
            egui::epaint::Primitive::Callback(_) => 0,
        };
        shapes.iter().map(triangles).sum()
    }

    fn button(pos: Pos2, pressed: bool) -> Event {
        Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
    }

    /// Frames until nothing is computed and what is drawn stays the same: records are prepared in the background.
    fn settle(&mut self) -> usize {
        let (mut last, mut same) = (0, 0);
        while same < 100 {
            let triangles = self.frame(Vec::new());
            same = if triangles == last && self.app.running().is_none() { same + 1 } else { 0 };
            last = triangles;
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        last
    }
}

fn bench(c: &mut Criterion) {
    let ctx = Context::default();
    dashpot::window::theme::install(&ctx);
    let mut app = App::default();
    app.document = Some(document());
    app.view.stage = Stage::Measure;
    app.view.every_channel = true;
    // The record has the whole window, so that all channels are in sight.
    for pane in [Pane::Schematic, Pane::Inspector, Pane::Runs, Pane::Spectrum] {
        app.desk.set_open(Stage::Measure, pane, false);
    }
    let mut window = Window { ctx, app, time: 0.0 };
    let at = pos2(1000.0, 400.0);
    window.frame(vec![Event::PointerMoved(at)]);
    println!("{} triangles close up", window.settle());
    c.bench_function("frame, 16 x 1 000 000 samples, close up", |b| b.iter(|| black_box(window.frame(Vec::new()))));
    for pressed in [true, false, true, false] {
        window.frame(vec![Window::button(at, pressed)]);
    }
    let all = window.settle();
    assert!(all > CHANNELS * 4000, "all channels are drawn from edge to edge: {all} triangles");
    println!("{all} triangles with all samples in sight");
    c.bench_function("frame, 16 x 1 000 000 samples, all", |b| b.iter(|| black_box(window.frame(Vec::new()))));
    window.frame(vec![Window::button(at, true)]);
    let mut turn = 0_u32;
    c.bench_function("frame, 16 x 1 000 000 samples, dragged", |b| {
        b.iter(|| {
            turn += 1;
            let x = at.x + 60.0 * (f64::from(turn) * 0.1).sin() as f32;
            black_box(window.frame(vec![Event::PointerMoved(pos2(x, at.y))]))
        });
    });
    println!("{} triangles while dragged", window.frame(vec![Event::PointerMoved(pos2(at.x + 200.0, at.y))]));
}

criterion_group!(benches, bench);
criterion_main!(benches);
