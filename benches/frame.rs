//! A frame of the window without drawing its pixels: layout, plots and tessellation, at the Measure stage with sixteen
//! channels of a million samples each under each other; close up, all of it, and while it is dragged; and at every stage of a
//! project of 2000 runs and 40 channels while the pointer moves. The goal is 8 ms.

use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::measurement::{Channel, Quantity, Record, Run};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::structure::chain::ChainParameters;
use dashpot::window::App;
use dashpot::window::app::view::Stage;
use dashpot::window::document::Document;
use dashpot::window::frame::panes::Pane;
use egui::{Context, Event, Modifiers, PointerButton, Pos2, RawInput, Rect, pos2, vec2};
use faer::c64;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::hint::black_box;
use std::sync::Arc;

const CHANNELS: usize = 16;
const SAMPLES: usize = 1_000_000;
const RATE: f64 = 10_000.0;
const FREQUENCY: f64 = 50.0;
/// Runs and masses of the project of many runs.
const RUNS: usize = 2000;
const MASSES: usize = 40;

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
        let mut sample_at = |t: &f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let noise = (seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5;
            (TAU * FREQUENCY * t + k as f64).cos() * (1.0 + 0.2 * (0.3 * t).sin()) + 0.1 * noise
        };
        time.iter().map(&mut sample_at).collect::<Vec<f64>>()
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

/// A chain of forty masses as harmonics: 2000 runs at four levels about its first three resonances, an accelerometer a mass.
fn many_runs() -> Document {
    let folder = tempfile::tempdir().expect("a folder");
    let list = |value: &str, n: usize| vec![value; n].join(", ");
    let mut text = format!(
        "[project]\nformat = 1\ntitle = \"Many runs\"\n[structure]\nkind = \"chain\"\nmasses = [{}]\n\
         ground_stiffness = [1e5{}]\ncoupling_stiffness = [{}]\n[[source]]\nlaw = \"viscous\"\ndofs = [3]\nstate = \"known\"\n\
         c = 2.0\n[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n",
        list("1.0", MASSES),
        ", 0.0".repeat(MASSES - 1),
        list("1e5", MASSES - 1)
    );
    let structure = ChainParameters {
        masses: vec![1.0; MASSES],
        ground_stiffness: std::iter::once(1e5).chain(std::iter::repeat_n(0.0, MASSES - 1)).collect(),
        coupling_stiffness: vec![1e5; MASSES - 1],
    }
    .build(&[])
    .expect("a chain");
    let place = |dof: usize, c: f64| Source::known(Effect::Viscous, Place::Dofs(vec![dof]), &[c]);
    let stiffness = DynamicStiffness::new(&structure, &[place(2, 2.0), place(20, 5.0)]).expect("a model");
    let modes = structure.modes().expect("modes");
    for level in 1..=4 {
        let mut table = "run,frequency_hz,channel,harmonic,cos,sin".to_owned();
        for step in 0..RUNS / 4 {
            let across = (step / 3) as f64 / (RUNS / 12) as f64;
            let omega = modes.omega[step % 3] * (0.94 + 0.12 * across);
            let mut load = vec![c64::new(0.0, 0.0); MASSES];
            load[MASSES - 1] = c64::new(f64::from(level), 0.0);
            let x = stiffness.solve(omega, &load).expect("a response");
            let (run, frequency) = (format!("sweep-{level}-{step:03}"), omega / TAU);
            let _ = write!(table, "\n{run},{frequency:.9},force@{MASSES} [N],1,{level},0");
            for (k, x) in x.iter().enumerate() {
                let y = x * (-omega * omega) * (1.0 + 0.004 * ((step * 7 + k * 3) % 11) as f64 / 5.0);
                let _ = write!(table, "\n{run},{frequency:.9},acc@{} [m/s^2],1,{:.9e},{:.9e}", k + 1, y.re, -y.im);
            }
        }
        let path = folder.path().join(format!("sweep-{level}.csv"));
        dashpot::exchange::atomic::write_atomically(&path, table.as_bytes()).expect("a file");
        let _ = write!(text, "[[harmonics]]\nfile = \"sweep-{level}.csv\"\nlevel = {level}\n");
    }
    let path = folder.path().join("project.toml");
    dashpot::exchange::atomic::write_atomically(&path, text.as_bytes()).expect("a file");
    Document::open(&path, &Control::unattended()).expect("a project").0
}

/// Every stage of a project of many runs while the pointer moves over it.
fn bench_many_runs(c: &mut Criterion) {
    let ctx = Context::default();
    dashpot::window::appearance::theme::install(&ctx);
    let mut app = App::default();
    app.loaded(many_runs(), false);
    // A search for what is missing ends by then, with the best so far.
    app.view.limit_s = Some(10.0);
    let mut window = Window { ctx, app, time: 0.0 };
    for stage in Stage::ALL {
        window.app.view.stage = stage;
        window.frame(Vec::new());
        window.settle();
        let mut turn = 0_u32;
        c.bench_function(&format!("frame, {RUNS} runs x {MASSES} channels, {}", stage.label()), |b| {
            b.iter(|| {
                turn += 1;
                let at = pos2(60.0 + 20.0 * (turn % 40) as f32, 620.0 + (turn % 7) as f32);
                black_box(window.frame(vec![Event::PointerMoved(at)]))
            });
        });
    }
}

fn bench(c: &mut Criterion) {
    let ctx = Context::default();
    dashpot::window::appearance::theme::install(&ctx);
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

criterion_group!(benches, bench, bench_many_runs);
criterion_main!(benches);
