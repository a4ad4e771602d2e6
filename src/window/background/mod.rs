//! Work in the background: jobs, results by the key they were asked for, and what is derived from the document.

pub(crate) mod cache;
pub(crate) mod derived;
pub(crate) mod jobs;
