//! Records of tests that are not steady, as a data recorder would have written them: what drives the structure
//! (`loading`), its motion by time integration, the filter against aliasing and the converter (`recorder`).

mod component;
pub(crate) mod loading;
mod recorder;

pub use component::{ComponentForceError, component_force};
pub use loading::Loading;
pub use recorder::{Release, TestRecord, TestSetup, quantise, record_test};
