//! How many layouts the energies alone allow: sets of as many sources as were accepted that meet the energy of every run.
//!
//! With no more runs than sources the energy equation has solutions in great number; the user must know that the set
//! shown is one of many, or that only the response at the sensors told it apart.

use super::outcome::Form;
use super::{found::Found, problem::Problem, system::System};
use crate::balance::Weights;
use crate::control::Control;
use crate::math::subsets::{SubsetProblem, branch_and_bound};

/// Layouts counted at most.
const MOST: usize = 500;
/// Fewer are no news: the alternatives of the step tell them.
const LEAST: usize = 10;
/// Columns above which nothing is counted.
const MANY: usize = 200;
/// Nodes of the tree after which the count is a lower bound.
const NODES: u64 = 60_000;

/// A warning where layouts are many; `None` where runs outnumber the accepted sources by two or more, or damping ratios
/// stand beside the energies.
pub(super) fn warning(problem: &Problem<'_>, found: &Found, accepted: usize) -> Option<String> {
    let runs = problem.measured.len();
    if problem.ratios.is_some()
        || !problem.windows.is_empty()
        || accepted + 1 < runs
        || problem.columns.len() > MANY
        || problem.columns.len() <= runs
    {
        return None;
    }
    let size = accepted.min(runs);
    if problem.forced.len() > size {
        return None;
    }
    let energy = System::energy(problem, &found.state, Weights::Energy);
    let question = SubsetProblem {
        a: energy.a.as_ref(),
        b: &energy.b,
        size,
        keep: MOST + 1,
        forced: &problem.forced,
        node_limit: NODES,
    };
    let sets = branch_and_bound(&question, &Control::unattended()).ok()?.sets;
    let limit = problem.settings.stop_angle_deg;
    let count = sets.iter().filter(|set| set.angle.to_degrees() < limit).count();
    if count < LEAST {
        return None;
    }
    let many = if count > MOST { format!("more than {MOST}") } else { count.to_string() };
    let told = if found.form == Form::Response { "; only the response at the sensors tells them apart" } else { "" };
    Some(format!(
        "{many} layouts of {size} sources meet the energies of the {runs} runs within {limit} deg{told}; measure more \
         independent runs or name fewer candidates"
    ))
}
