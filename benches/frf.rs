//! Frequency responses of a large hammer test: 8 references, 40 responses, 1601 lines, averages of 8 hits with 2 % noise and their
//! coherences. How long the project takes to open (all 320 functions and coherences read, lines chosen) and to identify.

use criterion::{Criterion, criterion_group, criterion_main};
use dashpot::control::Control;
use dashpot::exchange::atomic::write_atomically;
use dashpot::exchange::project::load;
use dashpot::identify::identify;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const BEAM: &str = "[project]\nformat = 1\ntitle = \"hammer test\"\n[structure]\nkind = \"beam\"\nlength = 1.2\nbreadth = 0.04\n\
                    depth = 0.008\nyoungs_modulus = 69e9\ndensity = 2700.0\nelements = 40\nsupports = \"clamped-free\"\n";
const TRUTH: &str = "[[source]]\nlaw = \"viscous\"\ndofs = [25]\nstate = \"known\"\nc = 2.0\n[[source]]\nlaw = \"viscous\"\n\
                     dofs = [61]\nstate = \"known\"\nc = 0.8\n[[source]]\nlaw = \"loss_factor\"\nstate = \"known\"\nloss_factor = 0.002\n\
                     [[frf]]\nfile = \"hammer.uff\"\naverages = 8\nband = [0, 800]\n";
/// The same with the dashpots alone: sets of up to eight of forty candidates.
const DASHPOTS: [&str; 2] = [
    "[[source]]\nlaw = \"loss_factor\"\nstate = \"candidate\"\n",
    "[[source]]\nlaw = \"loss_factor\"\nstate = \"known\"\nloss_factor = 0.002\n",
];
const ASKED: &str = "[[candidates]]\nlaw = \"viscous\"\nwhere = \"each-translation\"\n[[source]]\nlaw = \"loss_factor\"\n\
                     state = \"candidate\"\n[[frf]]\nfile = \"hammer.uff\"\naverages = 8\n";

/// The project in a folder, its measurement simulated.
fn project(folder: &Path) -> PathBuf {
    let places: Vec<usize> = (1..=40).map(|node| 2 * node - 1).collect();
    let forces = places.iter().skip(4).step_by(5).map(|dof| format!("\"force@{dof} [N]\""));
    let channels: Vec<String> = forces.chain(places.iter().map(|dof| format!("\"acc@{dof} [m/s^2]\""))).collect();
    let simulate = format!("[simulate]\nsamples = 1601\nchannels = [{}]\n", channels.join(", "));
    let (truth, asked) = (folder.join("truth.toml"), folder.join("project.toml"));
    let written = write_atomically(&truth, [BEAM, TRUTH, &simulate].concat().as_bytes())
        .and_then(|()| write_atomically(&asked, [BEAM, ASKED].concat().as_bytes()));
    written.unwrap_or_else(|error| panic!("{error}"));
    let words = ["dashpot", "simulate", "--noise", "0.02", "--seed", "3", "--as", "frf", "--out"];
    let all = words.iter().map(Into::into).chain([folder.into(), truth.into()]);
    dashpot::cli::answer(all).unwrap_or_else(|error| panic!("{error}"));
    asked
}

fn bench(c: &mut Criterion) {
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let path = project(folder.path());
    let open = || load(&path, &Control::unattended()).unwrap_or_else(|error| panic!("{error}"));
    let start = Instant::now();
    let opened = open();
    println!("{} runs of 512 320 values opened in {:.2} s", opened.runs.len(), start.elapsed().as_secs_f64());
    let mut group = c.benchmark_group("frf");
    group.sample_size(10).warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_secs(20));
    group.bench_function("open", |bencher| bencher.iter(open));
    group.bench_function("identify", |bencher| {
        bencher.iter(|| {
            identify(&opened.structure, &opened.sources, &opened.runs, &opened.settings, &Control::unattended())
                .unwrap_or_else(|error| panic!("{error}"))
        });
    });
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{error}"));
    let path = path.with_file_name("dashpots.toml");
    write_atomically(&path, text.replace(DASHPOTS[0], DASHPOTS[1]).as_bytes())
        .unwrap_or_else(|error| panic!("{error}"));
    let dashpots = load(&path, &Control::unattended()).unwrap_or_else(|error| panic!("{error}"));
    group.bench_function("identify dashpots", |bencher| {
        bencher.iter(|| {
            identify(&dashpots.structure, &dashpots.sources, &dashpots.runs, &dashpots.settings, &Control::unattended())
                .unwrap_or_else(|error| panic!("{error}"))
        });
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
