//! A small project with records that carry their own answer, and a window on it.

use crate::common::models::{cantilever_parameters, chain as chain_of};
use dashpot::control::Control;
use dashpot::effects::{Effect, Place, Source};
use dashpot::response::dynamic_stiffness::DynamicStiffness;
use dashpot::structure::Structure;
use dashpot::structure::beam::BeamParameters;
use dashpot::window::App;
use dashpot::window::document::Document;
use egui_kittest::wgpu::WgpuTestRenderer;
use egui_kittest::{Harness, TestRenderer};
use faer::c64;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A project in a folder of its own.
pub(crate) struct Sample {
    pub _folder: tempfile::TempDir,
    /// Its file.
    pub path: PathBuf,
}

/// A cantilever of five elements with dashpots of 0.3 and 0.8 N s/m at DOFs 3 and 7, measured at 5 and 9.
pub(crate) fn beam() -> Sample {
    beam_with(0.8)
}

/// The same with another dashpot at DOF 7.
pub(crate) fn beam_with(second: f64) -> Sample {
    let parameters = BeamParameters { length: 0.5, ..cantilever_parameters(5) };
    let structure = parameters.build(&[]).unwrap();
    let head = "[project]\nformat = 1\ntitle = \"Test beam\"\n[structure]\nkind = \"beam\"\nlength = 0.5\nbreadth = 0.04\n\
                depth = 0.004\nyoungs_modulus = 69e9\ndensity = 2700.0\nelements = 5\nsupports = \"clamped-free\"\n\
                [[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n";
    let truth = [(2, 0.3), (6, second)].map(|(d, c)| Source::known(Effect::Viscous, Place::Dofs(vec![d]), &[c]));
    write(head, &structure, &truth, 8, &[4, 8])
}

/// A cantilever whose project states Young's modulus 2 % too low and a dashpot 15 % too small, and lacks nothing else.
pub(crate) fn detuned() -> Sample {
    let parameters = BeamParameters { length: 0.5, youngs_modulus: 70.4e9, ..cantilever_parameters(5) };
    let structure = parameters.build(&[]).unwrap();
    let head = "[project]\nformat = 1\ntitle = \"Detuned beam\"\n[structure]\nkind = \"beam\"\nlength = 0.5\nbreadth = 0.04\n\
                depth = 0.004\nyoungs_modulus = 69e9\ndensity = 2700.0\nelements = 5\nsupports = \"clamped-free\"\n\
                [[source]]\nlaw = \"viscous\"\ndofs = [3]\nstate = \"known\"\nc = 1.5\n\
                [[source]]\nlaw = \"viscous\"\ndofs = [7]\nstate = \"known\"\nc = 1.7\n";
    let truth = [(2, 1.5), (6, 2.0)].map(|(d, c)| Source::known(Effect::Viscous, Place::Dofs(vec![d]), &[c]));
    write(head, &structure, &truth, 8, &[2, 4, 8])
}

/// Four masses with a dashpot between the second and the third and a known one at the first.
pub(crate) fn chain() -> Sample {
    let structure = chain_of(&[1.0, 2.0, 1.5, 1.0], &[4000.0, 0.0, 0.0, 2000.0], &[3000.0, 5000.0, 4000.0]);
    let head = "[project]\nformat = 1\ntitle = \"Test chain\"\n[structure]\nkind = \"chain\"\nmasses = [1.0, 2.0, 1.5, 1.0]\n\
                ground_stiffness = [4000.0, 0.0, 0.0, 2000.0]\ncoupling_stiffness = [3000.0, 5000.0, 4000.0]\n\
                [[source]]\nlaw = \"viscous\"\ndofs = [1]\nstate = \"known\"\nc = 1.0\n\
                [[candidates]]\nlaw = \"viscous\"\nwhere = \"each-pair\"\n";
    let truth = [
        Source::known(Effect::Viscous, Place::Dofs(vec![0]), &[1.0]),
        Source::known(Effect::Viscous, Place::Dofs(vec![1, 2]), &[6.0]),
    ];
    write(head, &structure, &truth, 3, &[0, 1, 2, 3])
}

/// Records at the natural frequencies, written as CSV.
pub(crate) fn write(head: &str, structure: &Structure, truth: &[Source], force: usize, sensors: &[usize]) -> Sample {
    let folder = tempfile::tempdir().unwrap();
    let modes = structure.modes().unwrap();
    let stiffness = DynamicStiffness::new(structure, truth).unwrap();
    let mut text = head.to_owned();
    for r in 0..modes.len().min(4) {
        let omega = modes.omega[r];
        let mut load = vec![c64::new(0.0, 0.0); structure.len()];
        load[force] = c64::new(1.0, 0.0);
        let x = stiffness.solve(omega, &load).unwrap();
        let name = format!("run-{:02}.csv", r + 1);
        std::fs::write(folder.path().join(&name), record(structure, &x, omega, force, sensors)).unwrap();
        write!(text, "[[run]]\nfile = \"{name}\"\nfrequency = {:.9}\n", omega / TAU).unwrap();
    }
    let path = folder.path().join("project.toml");
    std::fs::write(&path, text).unwrap();
    Sample { _folder: folder, path }
}

/// Twelve periods of the steady state with a little noise that is the same on every machine.
fn record(structure: &Structure, x: &[c64], omega: f64, force: usize, sensors: &[usize]) -> String {
    let mut text = format!("time [s],force@{} [N]", structure.label(force));
    for &s in sensors {
        write!(text, ",acc@{} [m/s^2]", structure.label(s)).unwrap();
    }
    let n = 600;
    let mut seed = 12345_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2e-3 * ((seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5)
    };
    for k in 0..n {
        let t = 12.0 * TAU / omega * f64::from(k) / f64::from(n);
        let wave = |a: c64, noise: f64| a.re * (omega * t).cos() - a.im * (omega * t).sin() + noise * a.re.hypot(a.im);
        write!(text, "\n{t:.12e},{:.9e}", wave(c64::new(1.0, 0.0), noise())).unwrap();
        for &s in sensors {
            write!(text, ",{:.9e}", wave(x[s] * (-omega * omega), noise())).unwrap();
        }
    }
    text
}

/// The document of a sample, without a window.
pub(crate) fn document(path: &Path) -> Document {
    Document::open(path, &Control::unattended()).unwrap().0
}

/// A window without anything open.
pub(crate) fn start() -> Harness<'static, App> {
    window(None, egui::Theme::Light, SIZE)
}

/// The same of another size.
pub(crate) fn start_sized(size: [f32; 2]) -> Harness<'static, App> {
    window(None, egui::Theme::Light, size)
}

/// Size of the window unless a test asks for another, points.
const SIZE: [f32; 2] = [1440.0, 900.0];

/// A window on a project, settled.
pub(crate) fn open(sample: &Sample, theme: egui::Theme) -> Harness<'static, App> {
    open_sized(sample, theme, SIZE)
}

/// The same of another size.
pub(crate) fn open_sized(sample: &Sample, theme: egui::Theme, size: [f32; 2]) -> Harness<'static, App> {
    let mut harness = window(Some(sample.path.clone()), theme, size);
    settle(&mut harness);
    harness
}

/// A window on a project, settled, of which no picture can be taken: what the graphics adapter holds until it draws does not add up.
pub(crate) fn open_unseen(sample: &Sample, theme: egui::Theme) -> Harness<'static, App> {
    let mut harness = rendered(Some(sample.path.clone()), theme, SIZE, Unseen);
    settle(&mut harness);
    harness
}

fn window(file: Option<PathBuf>, theme: egui::Theme, size: [f32; 2]) -> Harness<'static, App> {
    let setup = dashpot::window::headless::offscreen::setup(wgpu::Backends::PRIMARY);
    rendered(file, theme, size, Patient(WgpuTestRenderer::from_setup(setup)))
}

fn rendered(
    file: Option<PathBuf>,
    theme: egui::Theme,
    size: [f32; 2],
    renderer: impl TestRenderer + 'static,
) -> Harness<'static, App> {
    let mut harness =
        Harness::builder().with_size(egui::Vec2::from(size)).with_theme(theme).renderer(renderer).build_eframe(
            move |cc| {
                dashpot::window::appearance::theme::install(&cc.egui_ctx);
                cc.egui_ctx.set_theme(theme);
                let mut app = App::default();
                if let Some(file) = file {
                    app.open(&cc.egui_ctx, file);
                    app.settle(&cc.egui_ctx).unwrap();
                }
                app
            },
        );
    harness.run_steps(3);
    harness
}

/// The renderer of egui's tests with patience: it gives the adapter ten seconds for a picture, and the one in software may need more while
/// the machine is busy with other tests.
struct Patient(WgpuTestRenderer);

/// Tries of a picture.
const TRIES: usize = 30;

impl TestRenderer for Patient {
    fn setup_eframe(&self, cc: &mut eframe::CreationContext<'_>, frame: &mut eframe::Frame) {
        self.0.setup_eframe(cc, frame);
    }

    fn handle_delta(&mut self, delta: &mut egui::TexturesDelta) {
        self.0.handle_delta(delta);
    }

    fn render(&mut self, ctx: &egui::Context, output: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        let mut last = Err("nothing was drawn".to_owned());
        for _ in 0..TRIES {
            // It says by a panic that a picture was not read back in time.
            let tried = catch_unwind(AssertUnwindSafe(|| self.0.render(ctx, output)));
            last = tried.unwrap_or_else(|_| Err("the picture was not read back in time".to_owned()));
            if last.is_ok() {
                break;
            }
        }
        last
    }
}

/// Draws nothing.
struct Unseen;

impl TestRenderer for Unseen {
    fn handle_delta(&mut self, delta: &mut egui::TexturesDelta) {
        delta.clear();
    }

    fn render(&mut self, _: &egui::Context, _: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        Err("this window draws nothing".to_owned())
    }
}

/// Steps until no job has run for some frames, at most three minutes: a hang, not a slow machine, fails.
pub(crate) fn settle(harness: &mut Harness<'_, App>) {
    let start = Instant::now();
    harness.run_steps(2);
    // What one job brings may start the next one frames later.
    let mut idle = 0;
    while idle < IDLE {
        harness.run_steps(1);
        if harness.state().running().is_some() {
            assert!(start.elapsed() < Duration::from_mins(3), "{:?} still runs", harness.state().running());
            std::thread::sleep(Duration::from_millis(5));
            idle = 0;
        } else {
            idle += 1;
        }
    }
}

/// Frames without a job after which a window has settled.
const IDLE: usize = 6;

/// Draws with the pointer from one place to another.
pub(crate) fn drag(harness: &mut Harness<'_, App>, from: egui::Pos2, to: egui::Pos2) {
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    harness.run_steps(1);
    for k in 1..=4 {
        harness.hover_at(from + (to - from) * (k as f32 / 4.0));
        harness.run_steps(1);
    }
    harness.drop_at(to);
    harness.run_steps(3);
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

/// Drops files on the window.
pub(crate) fn drop_files(harness: &mut Harness<'_, App>, files: &[PathBuf]) {
    for file in files {
        harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(file.clone())));
    }
    harness.step();
    harness.input_mut().dropped_files.clear();
    harness.run_steps(2);
}
