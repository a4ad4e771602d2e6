//! The program: arguments to the window or to the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    // Two cores and matrices of tens of rows: threads of the linear algebra cost more than they give.
    faer::set_global_parallelism(faer::Par::Seq);
    #[cfg(feature = "window")]
    if let Some(code) = dashpot::window::arguments::run(&std::env::args_os().collect::<Vec<_>>()) {
        return code;
    }
    dashpot::cli::run(std::env::args_os())
}
