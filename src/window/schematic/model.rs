//! What there is to draw, as plain data: no positions on the screen, no colours, no physics.

use crate::effects::{Effect, Place, Source, State};
use crate::measurement::{Channel, Quantity, Run, TransientRun};
use crate::structure::{Direction, Structure, StructureKind};
use faer::MatRef;

/// How a node is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Support {
    /// Neither displacement nor rotation.
    Clamped,
    /// Rotation only.
    Pinned,
}

/// A point of the structure.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneNode {
    /// Name in files.
    pub label: String,
    /// Position, m.
    pub position: [f64; 3],
    /// How it is held, if it is.
    pub support: Option<Support>,
}

/// A degree of freedom.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneDof {
    /// Name in files.
    pub label: String,
    /// Index of its node.
    pub node: usize,
    /// Direction of positive displacement.
    pub direction: Direction,
    /// What is measured there in any run, forces excluded.
    pub sensors: Vec<Quantity>,
    /// Whether an exciter acts there in any run.
    pub exciter: bool,
}

/// A source on the schematic.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneSource {
    /// Index in the project.
    pub index: usize,
    /// The law.
    pub effect: Effect,
    /// DOF rows it acts on: one to the ground, two between, more a chain.
    pub dofs: Vec<usize>,
    /// What identification may do with it.
    pub state: State,
    /// Identified value in the step that is shown, as text with unit.
    pub identified: Option<String>,
    /// Law and place in words: `viscous dashpot at DOF 7`.
    pub name: String,
    /// Whether it is no source of the project but one that is suggested.
    pub suggested: bool,
}

/// A spring that belongs to the structure (of a chain).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// First DOF.
    pub first: usize,
    /// Second DOF; `None` is the ground.
    pub second: Option<usize>,
}

/// Everything that the schematic shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// How it is drawn.
    pub kind: StructureKind,
    /// Nodes.
    pub nodes: Vec<SceneNode>,
    /// Pairs of nodes joined by a line.
    pub lines: Vec<[usize; 2]>,
    /// DOFs in the order of the matrix rows.
    pub dofs: Vec<SceneDof>,
    /// Sources that act on DOFs.
    pub sources: Vec<SceneSource>,
    /// Springs of a chain.
    pub springs: Vec<Spring>,
    /// Whether its base moves in any run, whose motion was measured.
    pub on_moving_base: bool,
}

impl Scene {
    /// Collects the scene of a structure, its sources and the channels of its runs.
    pub fn new(structure: &Structure, sources: &[Source], runs: &[Run]) -> Self {
        let mut scene = Self {
            kind: structure.kind(),
            nodes: nodes(structure),
            lines: structure.lines().to_vec(),
            dofs: dofs(structure),
            sources: Vec::new(),
            springs: springs(structure),
            on_moving_base: false,
        };
        scene.set_runs(runs);
        scene.set_sources(structure, sources);
        scene
    }

    fn set_runs(&mut self, runs: &[Run]) {
        for run in runs {
            let recorded = run.record.as_ref().map_or(&[][..], |record| record.channels());
            let on_base = recorded.iter().any(|c| c.quantity == Quantity::Base);
            self.on_moving_base |= on_base;
            // What the base does to each mass is a force of the fit, but none of an exciter.
            let acts = |c: &&Channel| !on_base || c.quantity != Quantity::Force || recorded.contains(c);
            self.set_channels(run.fit.channels.iter().map(|fit| &fit.channel).filter(acts));
        }
    }

    /// With the sensors and exciters of records over time, which are no runs: decays, hammers, sweeps, noise. Nothing acts on a decay,
    /// and the forces of a moving base are none of an exciter.
    #[must_use]
    pub fn with_records(mut self, records: &[TransientRun]) -> Self {
        for record in records {
            let mut numbers = record.response_channels();
            self.on_moving_base |= record.on_moving_base;
            if !record.on_moving_base {
                numbers.extend(record.force_channels());
            }
            self.set_channels(numbers.into_iter().map(|c| &record.channels()[c]));
        }
        self
    }

    fn set_channels<'a>(&mut self, channels: impl Iterator<Item = &'a Channel>) {
        for channel in channels {
            let Some(dof) = self.dofs.get_mut(channel.dof) else { continue };
            if channel.quantity == Quantity::Force {
                dof.exciter = true;
            } else if !dof.sensors.contains(&channel.quantity) {
                dof.sensors.push(channel.quantity);
            }
        }
    }

    fn set_sources(&mut self, structure: &Structure, sources: &[Source]) {
        let on_dofs = |(index, source): (usize, &Source)| match &source.place {
            Place::Dofs(dofs) if !dofs.is_empty() => Some(SceneSource {
                index,
                effect: source.effect,
                dofs: dofs.clone(),
                state: source.state,
                identified: None,
                name: source.phrase(structure),
                suggested: false,
            }),
            _ => None,
        };
        self.sources = sources.iter().enumerate().filter_map(on_dofs).collect();
    }

    /// DOFs that are translations, in order of their rows.
    pub fn translations(&self) -> Vec<usize> {
        (0..self.dofs.len()).filter(|&d| !self.dofs[d].direction.is_rotation()).collect()
    }

    /// One line that says what a DOF is, for tooltips and screen readers: `DOF 19, translation z, node 10, acc, exciter`.
    pub fn describe(&self, dof: usize) -> String {
        let d = &self.dofs[dof];
        let motion = match d.direction {
            Direction::X => "translation x",
            Direction::Y => "translation y",
            Direction::Z => "translation z",
            Direction::Rx => "rotation x",
            Direction::Ry => "rotation y",
            Direction::Rz => "rotation z",
            Direction::Q => "generalised coordinate",
        };
        let mut text = format!("DOF {}, {motion}, node {}", d.label, self.nodes[d.node].label);
        for quantity in &d.sensors {
            text.push_str(", measured ");
            text.push_str(quantity.word());
        }
        if d.exciter {
            text.push_str(", exciter");
        }
        text
    }
}

fn nodes(structure: &Structure) -> Vec<SceneNode> {
    let support = |node: usize| {
        if structure.kind() != StructureKind::Beam {
            return None;
        }
        let has = |rotation: bool| {
            structure.dofs().iter().any(|dof| dof.node == node && dof.direction.is_rotation() == rotation)
        };
        match (has(false), has(true)) {
            (false, false) => Some(Support::Clamped),
            (false, true) => Some(Support::Pinned),
            _ => None,
        }
    };
    let node = |(k, node): (usize, &crate::structure::Node)| SceneNode {
        label: node.label.clone(),
        position: node.position,
        support: support(k),
    };
    structure.nodes().iter().enumerate().map(node).collect()
}

fn dofs(structure: &Structure) -> Vec<SceneDof> {
    let dof = |dof: &crate::structure::Dof| SceneDof {
        label: dof.label.clone(),
        node: dof.node,
        direction: dof.direction,
        sensors: Vec::new(),
        exciter: false,
    };
    structure.dofs().iter().map(dof).collect()
}

/// Springs of a chain, read from its stiffness matrix: off-diagonals couple, what is left of the row sum goes to the ground.
fn springs(structure: &Structure) -> Vec<Spring> {
    let Some(matrices) = structure.matrices().filter(|_| structure.kind() == StructureKind::Chain) else {
        return Vec::new();
    };
    let k = matrices.stiffness.as_ref();
    let scale = (0..k.nrows()).map(|i| k[(i, i)].abs()).fold(0.0, f64::max) * 1e-12;
    let mut springs = Vec::new();
    for i in 0..k.nrows() {
        if row_sum(k, i).abs() > scale {
            springs.push(Spring { first: i, second: None });
        }
        for j in i + 1..k.ncols() {
            if k[(i, j)].abs() > scale {
                springs.push(Spring { first: i, second: Some(j) });
            }
        }
    }
    springs
}

fn row_sum(k: MatRef<'_, f64>, i: usize) -> f64 {
    (0..k.ncols()).map(|j| k[(i, j)]).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::{Scene, Spring, Support};
    use crate::effects::{Effect, Place, Source};
    use crate::window::schematic::samples;

    #[test]
    fn a_cantilever_is_clamped_at_its_left_end_only() {
        let scene = Scene::new(&samples::cantilever(4), &[], &[]);
        let supports: Vec<_> = scene.nodes.iter().map(|n| n.support).collect();
        assert_eq!(supports, [Some(Support::Clamped), None, None, None, None]);
        assert_eq!(scene.translations(), [0, 2, 4, 6]);
        assert_eq!(scene.describe(7), "DOF 8, rotation y, node 4");
    }

    #[test]
    fn springs_of_a_chain_come_from_its_stiffness() {
        let scene = Scene::new(&samples::chain(), &[], &[]);
        let ground = |first| Spring { first, second: None };
        let between = |first, second| Spring { first, second: Some(second) };
        assert_eq!(scene.springs, [ground(0), between(0, 1), between(1, 2)]);
    }

    #[test]
    fn sources_of_the_whole_structure_are_not_on_the_schematic() {
        let whole = Source::candidate(Effect::LossFactor, Place::Whole(None));
        let dashpot = Source::candidate(Effect::Viscous, Place::Dofs(vec![2]));
        let scene = Scene::new(&samples::chain(), &[whole, dashpot], &[]);
        assert_eq!(scene.sources.len(), 1);
        assert_eq!(scene.sources[0].index, 1);
    }
}
