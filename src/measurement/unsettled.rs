//! Tests none of whose runs has settled: what hardly changes is taken all the same, for else nothing would be left.

use super::finding::{Finding, Flag};
use super::run::Run;

/// Largest change of an amplitude within a record, relative, that passes for a steady one where there is none: the harmonics of the
/// record are off by less than half of it, no more than force levels and sensors are from run to run.
const USABLE: f64 = 0.05;

/// Takes the runs in use that have all but settled, where no run has; what should be known of it.
pub(crate) fn take_unsettled(runs: &mut [Run]) -> Option<String> {
    if runs.iter().any(Run::is_used) {
        return None;
    }
    let mut most: f64 = 0.0;
    let mut taken = 0;
    for run in runs.iter_mut().filter(|run| run.enabled) {
        let Some(share) = change(run) else { continue };
        (run.insisted, most, taken) = (true, most.max(share), taken + 1);
    }
    (taken > 0).then(|| {
        format!(
            "no run has settled: amplitudes change by up to {:.1} % within a record; {taken} runs are used all the same, for none \
             would be left: record later, and `use = false` leaves one out",
            100.0 * most
        )
    })
}

/// By how much a run changes that is all but settled and has nothing else against it.
fn change(run: &Run) -> Option<f64> {
    let against = |finding: &&Finding| matches!(finding.flag, Flag::NotSettled | Flag::NotPeriodic);
    let why_not = run.why_not_steady()?;
    let small = |finding: &Finding| finding.flag == Flag::NotSettled && finding.share.is_some_and(|s| s < USABLE);
    let all = run.findings.iter().filter(against).all(small);
    why_not.share.filter(|_| all && small(why_not))
}
