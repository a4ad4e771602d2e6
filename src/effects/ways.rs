//! An internal force that follows the displacement, led over straight ways.

/// Where a straight way leads the internal force.
#[derive(Debug, Clone, Copy)]
pub struct Way {
    /// Force at the end, N.
    pub force: f64,
    /// Its derivative by the force at the start.
    pub by_start: f64,
    /// Its derivative by the way, N/m.
    pub by_way: f64,
}

/// A law with one internal force at its parameters, stepped from outside: for integrators that carry derivatives along.
pub trait InternalSteps: Send + Sync {
    /// From the force `start` (N) over the straight `way` (m).
    fn step(&self, start: f64, way: f64) -> Way;

    /// Derivative of the force at the end by parameter `k`, start and way held.
    fn step_by(&self, k: usize, start: f64, way: f64) -> f64;

    /// The law's force (N) at this internal one, and its slope by it.
    fn output(&self, internal: f64) -> [f64; 2];

    /// Derivative of the law's force by parameter `k`, the internal one held.
    fn output_by(&self, k: usize, internal: f64) -> f64;
}
