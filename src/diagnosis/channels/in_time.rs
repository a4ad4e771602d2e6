//! Faults of channels in records that are not steady, on the lines of their spectra next to the modes ([`super::lines`]).
//!
//! The model of a line is the motion that its measured force makes, with a nominal damping, and the amplitudes of the modes nearby
//! that fit the channels by least absolute deviations: these are free afterwards as well, as on steady runs.

use super::cells::{Cells, Frequencies, Nearest, SMALL, by_distance, free_modes};
use super::fault::ChannelFault;
use super::lines::{Line, highest as highest_of, lines};
use super::search::{Search, modes_up_to};
use crate::measurement::{Channel, Quantity, TransientRun};
use crate::structure::Structure;
use crate::structure::modes::Modes;
use faer::c64;

/// Damping ratio of the model of a line: next to a mode its amplitude is free, far from it damping hardly matters.
const NOMINAL: f64 = 0.01;
/// Median over the largest of channels below which a channel is no measure of an error before the model is fitted.
const OF_MEDIAN: f64 = 0.1;

/// What is wrong with the channels of the records that are used; none where the structure has no matrices.
pub(crate) fn find_in_time(structure: &Structure, runs: &[TransientRun]) -> Vec<ChannelFault> {
    let used: Vec<&TransientRun> = runs.iter().filter(|run| run.enabled).collect();
    let highest = used.iter().map(|run| highest_of(run)).fold(0.0, f64::max);
    let Some(modes) = modes_up_to(structure, highest).filter(|_| structure.matrices().is_some()) else {
        return Vec::new();
    };
    let [responses, forces] = [false, true].map(|force| different(&used, force));
    let mut frequencies = Frequencies::default();
    let mut cells = Vec::new();
    for run in &used {
        let numbers = Numbers { run, responses: &responses, forces: &forces };
        for line in lines(run, &modes) {
            let frequency = frequencies.number(line.omega);
            cells.extend(numbers.cells(structure, &modes, &line, frequency));
        }
    }
    let named = |list: &[Channel]| list.iter().map(|c| (c.to_string(), c.dof)).unzip::<String, usize, Vec<_>, Vec<_>>();
    let ((names, dofs), forces) = (named(&responses), named(&forces));
    let mut search = Search::new(structure, &modes, names, dofs, cells);
    search.knows_any_gain();
    search.all_faults(&forces.0, &forces.1)
}

/// Channels of motion, or of forces, that differ in what they measure and where.
fn different(runs: &[&TransientRun], force: bool) -> Vec<Channel> {
    let mut list: Vec<Channel> = Vec::new();
    for run in runs {
        let own = if force { run.force_channels() } else { run.response_channels() };
        for channel in own.into_iter().map(|c| &run.channels()[c]).filter(|c| c.quantity != Quantity::Base) {
            if !list.contains(channel) {
                list.push(channel.clone());
            }
        }
    }
    list
}

/// A run, and the channels that its numbers stand for among all.
struct Numbers<'a> {
    run: &'a TransientRun,
    responses: &'a [Channel],
    forces: &'a [Channel],
}

impl Numbers<'_> {
    fn channel(&self, number: usize) -> &Channel {
        &self.run.channels()[number]
    }

    /// What the channels read on a line beside the model; none where the channels are too few for the modes.
    fn cells(&self, structure: &Structure, modes: &Modes, line: &Line, frequency: usize) -> Option<Cells> {
        let rows: Vec<usize> = line.motion.iter().map(|(c, _)| self.channel(*c).dof).collect();
        let near = free_modes(modes, line.omega, rows.len())?;
        if near.is_empty() {
            return None;
        }
        let shape = |j: usize| rows.iter().map(|&dof| modes.shapes[(dof, j)]).collect::<Vec<f64>>();
        let measured: Vec<c64> = line.motion.iter().map(|(_, x)| *x).collect();
        let number = |c: usize| self.responses.iter().position(|channel| channel == self.channel(c));
        let turns: Vec<bool> = rows.iter().map(|&dof| structure.dofs()[dof].direction.is_rotation()).collect();
        let everywhere = self.forced(structure, modes, line);
        let mut cells = Cells {
            frequency,
            channels: line.motion.iter().map(|(c, _)| number(*c)).collect::<Option<_>>()?,
            moves: Vec::new(),
            model: rows.iter().map(|&dof| everywhere[dof]).collect(),
            everywhere,
            floor: floors(&measured, &turns, OF_MEDIAN, middle),
            measured,
            shapes: near.iter().map(|&j| shape(j)).collect(),
            nearest: self.nearest(modes, line, &near, &shape),
            free: near,
        };
        let start = agreed(&cells);
        cells.moved_on(&[start], modes);
        let free = cells.free_amplitudes(&cells.measured, None);
        cells.moved_on(&free, modes);
        cells.floor = floors(&cells.model, &turns, SMALL, |sizes| sizes.iter().copied().fold(0.0, f64::max));
        cells.moves = cells.model.iter().zip(&cells.floor).map(|(x, floor)| x.norm() >= *floor).collect();
        cells.floor.iter().all(|floor| floor.is_finite() && *floor > 0.0).then_some(cells)
    }

    /// The motion of every DOF that the measured forces make, m s (rad s); zero in a decay.
    fn forced(&self, structure: &Structure, modes: &Modes, line: &Line) -> Vec<c64> {
        let mut motion = vec![c64::new(0.0, 0.0); structure.len()];
        let Some(s) = line.s else { return motion };
        for (j, &omega) in modes.omega.iter().enumerate() {
            let q = self.modal_force(modes, line, j) / (s * s + s * (2.0 * NOMINAL * omega) + omega * omega);
            motion.iter_mut().enumerate().for_each(|(dof, x)| *x += q * modes.shapes[(dof, j)]);
        }
        motion
    }

    fn modal_force(&self, modes: &Modes, line: &Line, mode: usize) -> c64 {
        line.forces.iter().map(|(c, force)| force * modes.shapes[(self.channel(*c).dof, mode)]).sum()
    }

    /// The mode next to the line, where a force is measured; none on a base that moves, since motions relative to it have no factor in
    /// common with those that were measured.
    fn nearest(
        &self,
        modes: &Modes,
        line: &Line,
        near: &[usize],
        shape: &dyn Fn(usize) -> Vec<f64>,
    ) -> Option<Nearest> {
        let mode = *near.first().filter(|_| line.s.is_some() && !self.run.on_moving_base)?;
        let count = line.motion.len().saturating_sub(1);
        let told: Vec<usize> = by_distance(modes, line.omega).into_iter().take(count).collect();
        let alone = match line.forces[..] {
            [(c, force)] => self.forces.iter().position(|channel| channel == self.channel(c)).map(|f| (f, force)),
            _ => None,
        };
        Some(Nearest {
            mode,
            omega: [modes.omega[mode], line.omega],
            alone,
            force: self.modal_force(modes, line, mode),
            shapes: told.iter().map(|&j| shape(j)).collect(),
            modes: told,
        })
    }
}

impl Cells {
    /// Adds amplitudes of the free modes to the model.
    fn moved_on(&mut self, free: &[c64], modes: &Modes) {
        self.model = self.moved_by(free);
        for (&mode, b) in self.free.iter().zip(free) {
            let all = self.everywhere.iter_mut().enumerate();
            all.for_each(|(dof, x)| *x += b * modes.shapes[(dof, mode)]);
        }
    }
}

/// The amplitude of the nearest mode by the one channel with which the others agree best. A fit of all would start at a channel that
/// reads far too little: its relative error of a motion that the others show is the largest.
fn agreed(cells: &Cells) -> c64 {
    let by = |c: usize| (cells.measured[c] - cells.model[c]) / cells.shapes[0][c];
    let left = |b: &c64| -> f64 {
        let fit = cells.moved_by(&[*b]);
        (0..fit.len()).map(|c| cells.error(c, cells.measured[c], fit[c])).sum()
    };
    let all = (0..cells.measured.len()).map(by).filter(|b| b.re.is_finite() && b.im.is_finite());
    all.min_by(|a, b| left(a).total_cmp(&left(b))).unwrap_or_default()
}

/// Least amplitude that an error of each channel is measured by: a share of that of its kind, of translations or of rotations.
fn floors(motion: &[c64], turns: &[bool], share: f64, of_all: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let of_kind = |turns_too: bool| {
        let alike = motion.iter().zip(turns).filter(|(_, turns)| **turns == turns_too);
        of_all(&alike.map(|(x, _)| x.norm()).collect::<Vec<f64>>())
    };
    turns.iter().map(|&kind| share * of_kind(kind)).collect()
}

/// The larger of the two in the middle where they are even in number.
fn middle(sizes: &[f64]) -> f64 {
    let mut sizes = sizes.to_vec();
    let middle = sizes.len() / 2;
    if sizes.is_empty() { 0.0 } else { *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
