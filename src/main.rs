//! The program: arguments to the window or to the command line.

use mimalloc::MiMalloc;
use std::process::ExitCode;

/// Harmonic balance and searches make many short-lived small matrices: a quarter of the time went into the C library's allocator.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    // Two cores and matrices of tens of rows: threads of the linear algebra cost more than they give.
    faer::set_global_parallelism(faer::Par::Seq);
    #[cfg(feature = "window")]
    if let Some(code) = dashpot::window::arguments::run(&std::env::args_os().collect::<Vec<_>>()) {
        return code;
    }
    dashpot::cli::run(std::env::args_os())
}
