//! The program: the command line, and the window where it is compiled.

use dashpot::cli::Screen;
use mimalloc::MiMalloc;
use std::process::ExitCode;

/// Harmonic balance and searches make many short-lived small matrices: a quarter of the time went into the C library's allocator.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

#[cfg(feature = "window")]
mod display {
    use dashpot::cli::{Picture, Screen, Window};
    use dashpot::window::headless::picture::{self, picture};

    /// The window of this program.
    pub(crate) struct Display;

    impl Screen for Display {
        fn open(&self, asked: &Window) -> Result<(), String> {
            dashpot::window::open(asked.file.clone(), asked.photograph.clone())
        }

        fn picture(&self, asked: &Picture) -> Result<(), String> {
            let stage = picture::stage(&asked.stage)?;
            picture(&picture::Picture {
                file: asked.file.clone().filter(|_| stage.is_some()),
                stage: stage.unwrap_or_default(),
                pane: asked.pane.clone(),
                size: asked.size,
                dark: asked.theme == "dark",
                out: asked.out.clone(),
                plots: asked.plots.clone(),
            })
        }
    }
}

fn main() -> ExitCode {
    // Two cores and matrices of tens of rows: threads of the linear algebra cost more than they give.
    faer::set_global_parallelism(faer::Par::Seq);
    #[cfg(feature = "window")]
    let screen: Option<&dyn Screen> = Some(&display::Display);
    #[cfg(not(feature = "window"))]
    let screen: Option<&dyn Screen> = None;
    dashpot::cli::run(std::env::args_os(), screen)
}
