//! Wing boxes: upper and lower skin on spars and ribs, built of rods, constant-shear panels and membranes with incompatible
//! modes; three translations a node, clamped at the first rib, lumped masses.
//!
//! x runs along the chord, y along the span, z upwards from the lower skin to the upper one. Nodes are numbered as in section 5.3
//! of the thesis: upper skin first, from the first free rib to the tip, spar by spar within a rib; then the lower skin. Clamped
//! nodes are called `u1`, `u2`, ... and `l1`, ...; DOFs by node and direction, such as `13z`.

mod elements;

use super::error::{StructureError, positive};
use super::geometry::{Direction, Node};
use super::imported::{ImportedDof, ImportedParameters};
use super::lumped_mass::LumpedMass;
use super::system::Structure;
use elements::Sheet;
use faer::Mat;
use nalgebra::Vector3;

const FOOT: f64 = 0.3048;
const POUND_FORCE: f64 = 4.448_221_615_260_5;
const SLUG: f64 = POUND_FORCE / FOOT;

/// A rectangular wing box; SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct WingParameters {
    /// From the clamped rib to the tip, m.
    pub span: f64,
    /// From the first spar to the last, m.
    pub chord: f64,
    /// From the lower skin to the upper one, m.
    pub height: f64,
    /// Bays between ribs along the span.
    pub bays: usize,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Shear modulus, Pa.
    pub shear_modulus: f64,
    /// Density, kg/m^3, of every element.
    pub density: f64,
    /// Thickness of both skins, m.
    pub skin: f64,
    /// Thickness of each spar's web, m; their number is that of the spars.
    pub webs: Vec<f64>,
    /// Thickness of the ribs, m.
    pub rib: f64,
    /// Area of each spar's caps, on either skin, m^2.
    pub spar_caps: Vec<f64>,
    /// Area of the ribs' caps, m^2.
    pub rib_cap: f64,
    /// Area of the posts between the skins, m^2.
    pub post: f64,
    /// Mass added at each node of a spar, kg; half of it at the tip and at the root.
    pub node_mass: Vec<f64>,
}

impl WingParameters {
    /// The heavy Goland wing of section 5.3: 20 x 4 x 1/3 ft.
    pub fn goland() -> Self {
        let (area, slug_per_volume) = (FOOT * FOOT, SLUG / FOOT.powi(3));
        Self {
            span: 20.0 * FOOT,
            chord: 4.0 * FOOT,
            height: FOOT / 3.0,
            bays: 10,
            youngs_modulus: 1.4976e9 * POUND_FORCE / area,
            shear_modulus: 5.616e8 * POUND_FORCE / area,
            density: 1e-4 * slug_per_volume,
            skin: 0.0155 * FOOT,
            webs: [0.0006, 0.0889, 0.0006].map(|t| t * FOOT).to_vec(),
            rib: 0.0347 * FOOT,
            spar_caps: [0.0416, 0.1496, 0.0416].map(|a| a * area).to_vec(),
            rib_cap: 0.0422 * area,
            post: 0.0008 * area,
            node_mass: [1.9650, 3.9442, 5.3398].map(|m| m * SLUG).to_vec(),
        }
    }

    /// Number of free nodes on one skin.
    fn free_per_skin(&self) -> usize {
        self.bays * self.webs.len()
    }

    /// Matrices and tables of the box.
    ///
    /// # Errors
    /// [`StructureError`] for sizes that are not positive and lists that do not name every spar.
    pub fn tables(&self) -> Result<ImportedParameters, StructureError> {
        self.check()?;
        let mut assembly = Assembly::new(self);
        assembly.add_rods(self);
        assembly.add_panels(self);
        assembly.add_skins(self);
        assembly.add_node_masses(self);
        Ok(assembly.tables(self))
    }

    /// The structure, as if its tables had been imported.
    ///
    /// # Errors
    /// Those of [`Self::tables`].
    pub fn build(&self, lumped: &[LumpedMass]) -> Result<Structure, StructureError> {
        self.tables()?.build(lumped)
    }

    fn check(&self) -> Result<(), StructureError> {
        let spars = self.webs.len();
        if spars < 2 || self.bays == 0 {
            return Err(StructureError::NoDofs);
        }
        for (what, found) in [("spar_caps", self.spar_caps.len()), ("node_mass", self.node_mass.len())] {
            if found != spars {
                return Err(StructureError::Count { what, found, expected: spars, hint: " (one a spar)" });
            }
        }
        let one = [
            ("span", self.span, "m"),
            ("chord", self.chord, "m"),
            ("height", self.height, "m"),
            ("youngs_modulus", self.youngs_modulus, "Pa"),
            ("shear_modulus", self.shear_modulus, "Pa"),
            ("skin", self.skin, "m"),
            ("rib", self.rib, "m"),
            ("rib_cap", self.rib_cap, "m^2"),
            ("post", self.post, "m^2"),
        ];
        let lists =
            [("web", &self.webs, "m"), ("spar_cap", &self.spar_caps, "m^2"), ("node_mass", &self.node_mass, "kg")];
        let many = lists.iter().flat_map(|(name, list, unit)| list.iter().map(move |&value| (*name, value, *unit)));
        one.into_iter().chain(many).try_for_each(|(name, value, unit)| positive(name, value, unit))
    }
}

/// A node by rib (0 = clamped), skin (0 = upper) and spar.
type At = (usize, usize, usize);

/// Matrices over all nodes, clamped ones too.
struct Assembly {
    spars: usize,
    ribs: usize,
    positions: Vec<Vector3<f64>>,
    mass: Vec<f64>,
    stiffness: Mat<f64>,
    lines: Vec<[usize; 2]>,
}

impl Assembly {
    fn new(wing: &WingParameters) -> Self {
        let (spars, ribs) = (wing.webs.len(), wing.bays + 1);
        let mut positions = vec![Vector3::zeros(); 2 * ribs * spars];
        for skin in 0..2 {
            for rib in 0..ribs {
                for spar in 0..spars {
                    let x = wing.chord * spar as f64 / (spars - 1) as f64;
                    let y = wing.span * rib as f64 / wing.bays as f64;
                    let z = wing.height * if skin == 0 { 0.5 } else { -0.5 };
                    positions[(skin * ribs + rib) * spars + spar] = Vector3::new(x, y, z);
                }
            }
        }
        let n = positions.len();
        Self { spars, ribs, positions, mass: vec![0.0; n], stiffness: Mat::zeros(3 * n, 3 * n), lines: Vec::new() }
    }

    fn node(&self, (rib, skin, spar): At) -> usize {
        (skin * self.ribs + rib) * self.spars + spar
    }

    /// Adds an element's stiffness (column by column) and an equal part of its mass to each node.
    fn add(&mut self, nodes: &[usize], stiffness: &[f64], mass: f64) {
        let size = 3 * nodes.len();
        let row = |i: usize| 3 * nodes[i / 3] + i % 3;
        for j in 0..size {
            for i in 0..size {
                self.stiffness[(row(i), row(j))] += stiffness[size * j + i];
            }
        }
        for &node in nodes {
            self.mass[node] += mass / nodes.len() as f64;
        }
    }

    fn add_rod(&mut self, wing: &WingParameters, ends: [At; 2], area: f64) {
        let nodes = ends.map(|at| self.node(at));
        let points = nodes.map(|node| self.positions[node]);
        let mass = wing.density * area * (points[1] - points[0]).norm();
        self.add(&nodes, &elements::rod(points, wing.youngs_modulus, area), mass);
        self.lines.push(nodes);
    }

    fn add_rods(&mut self, wing: &WingParameters) {
        for rib in 0..self.ribs {
            for spar in 0..self.spars {
                self.add_rod(wing, [(rib, 0, spar), (rib, 1, spar)], wing.post);
                for skin in 0..2 {
                    if rib + 1 < self.ribs {
                        self.add_rod(wing, [(rib, skin, spar), (rib + 1, skin, spar)], wing.spar_caps[spar]);
                    }
                    if spar + 1 < self.spars {
                        self.add_rod(wing, [(rib, skin, spar), (rib, skin, spar + 1)], wing.rib_cap);
                    }
                }
            }
        }
    }

    fn corners(&self, corners: [At; 4]) -> ([usize; 4], [Vector3<f64>; 4]) {
        let nodes = corners.map(|at| self.node(at));
        (nodes, nodes.map(|node| self.positions[node]))
    }

    fn add_panel(&mut self, wing: &WingParameters, corners: [At; 4], thickness: f64) {
        let (nodes, points) = self.corners(corners);
        let mass = wing.density * thickness * elements::area(&points);
        self.add(&nodes, &elements::panel(&points, wing.shear_modulus, thickness), mass);
    }

    fn add_panels(&mut self, wing: &WingParameters) {
        for rib in 0..self.ribs {
            for spar in 0..self.spars {
                if rib + 1 < self.ribs {
                    let web = [(rib, 1, spar), (rib + 1, 1, spar), (rib + 1, 0, spar), (rib, 0, spar)];
                    self.add_panel(wing, web, wing.webs[spar]);
                }
                if spar + 1 < self.spars {
                    let plate = [(rib, 1, spar), (rib, 1, spar + 1), (rib, 0, spar + 1), (rib, 0, spar)];
                    self.add_panel(wing, plate, wing.rib);
                }
            }
        }
    }

    fn add_skins(&mut self, wing: &WingParameters) {
        let poisson = 0.5 * wing.youngs_modulus / wing.shear_modulus - 1.0;
        let sheet = Sheet { youngs_modulus: wing.youngs_modulus, poisson, thickness: wing.skin };
        for rib in 0..wing.bays {
            for spar in 0..self.spars - 1 {
                for skin in 0..2 {
                    let field =
                        [(rib, skin, spar), (rib, skin, spar + 1), (rib + 1, skin, spar + 1), (rib + 1, skin, spar)];
                    let (nodes, points) = self.corners(field);
                    let mass = wing.density * wing.skin * elements::area(&points);
                    self.add(&nodes, &elements::membrane(&points, sheet), mass);
                }
            }
        }
    }

    fn add_node_masses(&mut self, wing: &WingParameters) {
        for skin in 0..2 {
            for rib in 0..self.ribs {
                for spar in 0..self.spars {
                    let share = if rib == 0 || rib + 1 == self.ribs { 0.5 } else { 1.0 };
                    let node = self.node((rib, skin, spar));
                    self.mass[node] += share * wing.node_mass[spar];
                }
            }
        }
    }

    /// Number of a free node from 0, `None` where it is clamped.
    fn free(&self, node: usize) -> Option<usize> {
        let (skin, rest) = (node / (self.ribs * self.spars), node % (self.ribs * self.spars));
        let per_skin = (self.ribs - 1) * self.spars;
        rest.checked_sub(self.spars).map(|place| skin * per_skin + place)
    }

    fn label(&self, node: usize) -> String {
        match self.free(node) {
            Some(number) => (number + 1).to_string(),
            None if node < self.ribs * self.spars => format!("u{}", node + 1),
            None => format!("l{}", node % (self.ribs * self.spars) + 1),
        }
    }

    fn tables(&self, wing: &WingParameters) -> ImportedParameters {
        let n = 6 * wing.free_per_skin();
        let mut rows = Vec::with_capacity(n);
        let mut dofs = Vec::with_capacity(n);
        for node in (0..self.positions.len()).filter(|&node| self.free(node).is_some()) {
            for (axis, (direction, letter)) in
                [(Direction::X, 'x'), (Direction::Y, 'y'), (Direction::Z, 'z')].into_iter().enumerate()
            {
                let label = self.label(node);
                rows.push((3 * node + axis, self.mass[node]));
                dofs.push(ImportedDof { label: format!("{label}{letter}"), node: label, direction });
            }
        }
        let mut mass = Mat::zeros(n, n);
        let mut stiffness = Mat::zeros(n, n);
        for (j, &(column, m)) in rows.iter().enumerate() {
            mass[(j, j)] = m;
            for (i, &(row, _)) in rows.iter().enumerate() {
                stiffness[(i, j)] = self.stiffness[(row, column)];
            }
        }
        let position = |p: &Vector3<f64>| [p.x, p.y, p.z];
        let nodes = self.positions.iter().enumerate();
        ImportedParameters {
            mass,
            stiffness,
            nodes: Some(nodes.map(|(i, p)| Node { label: self.label(i), position: position(p) }).collect()),
            dofs: Some(dofs),
            lines: self.lines.iter().map(|pair| pair.map(|node| self.label(node))).collect(),
        }
    }
}
