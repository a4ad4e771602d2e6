//! What should be known beside an answer.

/// What should be known of a project's measurements, beside the answer.
pub(super) fn tell_remarks(project: &crate::exchange::Project) {
    project.remarks.iter().for_each(|remark| eprintln!("note: {remark}"));
}
