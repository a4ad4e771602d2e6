//! Elements of a thin-walled box, three translations a node, in the plane of their nodes.
//!
//! ```text
//! rod       k = E A / L
//! panel     constant shear, the mean over the rectangle: K = G t a b B^T B, B u = gamma at the centre
//! membrane  QM6: bilinear rectangle with the incompatible modes (1 - xi^2), (1 - eta^2) of both displacements, condensed;
//!           plane stress, 2 x 2 Gauss points
//! ```
//!
//! Rectangles are given by their corners in order; edges 1-2 and 1-4 are the local axes.

use nalgebra::{Matrix3, Matrix4, SMatrix, Vector3};

/// Stiffness of a rod between two points, 6 x 6, N/m.
pub(super) fn rod(ends: [Vector3<f64>; 2], youngs_modulus: f64, area: f64) -> Vec<f64> {
    let along = ends[1] - ends[0];
    let length = along.norm();
    let e = along / length;
    let b = SMatrix::<f64, 6, 1>::from_fn(|i, _| if i < 3 { -e[i] } else { e[i - 3] });
    let k = b * b.transpose() * (youngs_modulus * area / length);
    k.iter().copied().collect()
}

/// Unit vectors and lengths of the two edges of a rectangle.
fn axes(corners: &[Vector3<f64>; 4]) -> (Vector3<f64>, Vector3<f64>, f64, f64) {
    let (u, v) = (corners[1] - corners[0], corners[3] - corners[0]);
    let (a, b) = (u.norm(), v.norm());
    (u / a, v / b, a, b)
}

/// Area of a rectangle.
pub(super) fn area(corners: &[Vector3<f64>; 4]) -> f64 {
    let (_, _, a, b) = axes(corners);
    a * b
}

/// Signs of the local coordinates of the corners.
const XI: [f64; 4] = [-1.0, 1.0, 1.0, -1.0];
const ETA: [f64; 4] = [-1.0, -1.0, 1.0, 1.0];

/// Stiffness of a constant-shear panel, 12 x 12, N/m.
pub(super) fn panel(corners: &[Vector3<f64>; 4], shear_modulus: f64, thickness: f64) -> Vec<f64> {
    let (eu, ev, a, b) = axes(corners);
    let strain = SMatrix::<f64, 12, 1>::from_fn(|i, _| {
        let (corner, axis) = (i / 3, i % 3);
        ETA[corner] / (2.0 * b) * eu[axis] + XI[corner] / (2.0 * a) * ev[axis]
    });
    let k = strain * strain.transpose() * (shear_modulus * thickness * a * b);
    k.iter().copied().collect()
}

/// Elastic constants of a sheet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sheet {
    pub youngs_modulus: f64,
    pub poisson: f64,
    pub thickness: f64,
}

/// Stiffness of a QM6 membrane, 12 x 12, N/m.
pub(super) fn membrane(corners: &[Vector3<f64>; 4], sheet: Sheet) -> Vec<f64> {
    let (eu, ev, a, b) = axes(corners);
    let local = local_membrane(a, b, sheet);
    let turn = SMatrix::<f64, 8, 12>::from_fn(|i, j| {
        let (corner, axis) = (j / 3, j % 3);
        match i.checked_sub(2 * corner) {
            Some(0) => eu[axis],
            Some(1) => ev[axis],
            _ => 0.0,
        }
    });
    (turn.transpose() * local * turn).iter().copied().collect()
}

/// 8 x 8 in the sheet's own axes, the incompatible modes condensed.
fn local_membrane(a: f64, b: f64, sheet: Sheet) -> SMatrix<f64, 8, 8> {
    let nu = sheet.poisson;
    let stress =
        Matrix3::new(1.0, nu, 0.0, nu, 1.0, 0.0, 0.0, 0.0, 0.5 * (1.0 - nu)) * (sheet.youngs_modulus / (1.0 - nu * nu));
    let gauss = 1.0 / 3f64.sqrt();
    let weight = 0.25 * a * b * sheet.thickness;
    let mut uu = SMatrix::<f64, 8, 8>::zeros();
    let mut ua = SMatrix::<f64, 8, 4>::zeros();
    let mut aa = Matrix4::zeros();
    for (xi, eta) in [(-gauss, -gauss), (gauss, -gauss), (gauss, gauss), (-gauss, gauss)] {
        let nodes = strains(a, b, xi, eta);
        let (dx, dy) = (-4.0 * xi / a, -4.0 * eta / b);
        let bubbles = SMatrix::<f64, 3, 4>::new(dx, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, dy, 0.0, dy, dx, 0.0);
        uu += nodes.transpose() * stress * nodes * weight;
        ua += nodes.transpose() * stress * bubbles * weight;
        aa += bubbles.transpose() * stress * bubbles * weight;
    }
    // Positive definite for any sheet with thickness and stiffness.
    match aa.try_inverse() {
        Some(inverse) => uu - ua * inverse * ua.transpose(),
        None => uu,
    }
}

/// Strains of the bilinear displacements at a point, 3 x 8.
fn strains(a: f64, b: f64, xi: f64, eta: f64) -> SMatrix<f64, 3, 8> {
    SMatrix::<f64, 3, 8>::from_fn(|row, column| {
        let corner = column / 2;
        let dx = 0.5 * XI[corner] * (1.0 + eta * ETA[corner]) / a;
        let dy = 0.5 * ETA[corner] * (1.0 + xi * XI[corner]) / b;
        match (row, column % 2) {
            (0, 0) | (2, 1) => dx,
            (1, 1) | (2, 0) => dy,
            _ => 0.0,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle() -> [Vector3<f64>; 4] {
        [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]].map(|[x, y]| Vector3::new(x, y, 0.0))
    }

    /// `u^T K u` of displacements given by a function of position.
    fn energy(k: &[f64], corners: &[Vector3<f64>; 4], u: impl Fn(&Vector3<f64>) -> [f64; 3]) -> f64 {
        let all: Vec<f64> = corners.iter().flat_map(u).collect();
        (0..12).map(|i| (0..12).map(|j| all[i] * k[12 * j + i] * all[j]).sum::<f64>()).sum()
    }

    const SHEET: Sheet = Sheet { youngs_modulus: 8.0, poisson: 0.25, thickness: 0.5 };

    #[test]
    fn constant_strain_is_exact() {
        let corners = rectangle();
        let k = membrane(&corners, SHEET);
        // Uniaxial stretch 0.1 with free sides: E t a b eps^2; pure shear: G t a b gamma^2.
        let stretch = energy(&k, &corners, |p| [0.1 * p.x, -0.025 * p.y, 0.0]);
        assert!((stretch - 8.0 * 0.5 * 6.0 * 0.01).abs() < 1e-12);
        let shear = energy(&k, &corners, |p| [0.1 * p.y, 0.0, 0.0]);
        assert!((shear - 3.2 * 0.5 * 6.0 * 0.01).abs() < 1e-12);
        let panel = panel(&corners, 3.2, 0.5);
        assert!((energy(&panel, &corners, |p| [0.1 * p.y, 0.0, 0.0]) - shear).abs() < 1e-12);
        assert!(energy(&panel, &corners, |p| [0.1 * p.x, 0.2 * p.y, 0.3]).abs() < 1e-12);
    }

    #[test]
    fn rigid_motion_costs_nothing_and_bending_is_exact() {
        let corners = rectangle();
        let k = membrane(&corners, SHEET);
        assert!(energy(&k, &corners, |p| [1.0 - 0.2 * p.y, 0.2 * p.x, 0.0]).abs() < 1e-12);
        // Pure bending u = -k x y: the beam's E I k^2 L, I = t h^3 / 12, which a bilinear element misses (locking).
        let bent = energy(&k, &corners, |p| [-0.1 * (p.x - 1.0) * (p.y - 1.5), 0.0, 0.0]);
        assert!((bent - 8.0 * 0.5 * 27.0 / 12.0 * 0.01 * 2.0).abs() < 1e-12, "{bent}");
    }
}
