//! Records of tests that are not steady, as a data recorder would have written them: what drives the structure
//! (`loading`, `base`), its motion by time integration, the filter against aliasing and the converter (`recorder`).

mod base;
mod component;
pub(crate) mod loading;
mod recorder;

pub use base::BaseMotion;
pub use component::{ComponentForceError, component_force};
pub use loading::Loading;
pub use recorder::{Release, TestRecord, TestSetup, quantise, record_base_test, record_test};
