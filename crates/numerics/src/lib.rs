//! Dense linear algebra and Fourier transforms without type parameters.
//!
//! `faer`'s factorisations and `rustfft`'s kernels are generic and so are compiled anew in every crate that calls them,
//! which cost two minutes a build. Here they are compiled once, optimised, for the numbers that the program knows.

mod eigen;
mod equilibrated;
mod factor;
mod fourier;
mod lanes;
mod product;
mod rows;
mod singular;
mod small;
mod sparse;
mod steps;

pub use eigen::{eigenvalues, generalised_symmetric, real_general, symmetric, symmetric_values};
pub use equilibrated::EquilibratedCholesky;
pub use factor::{Cholesky, ComplexLu, RealLu, least_squares, solve_indefinite, thin_qr, triangle};
pub use fourier::RealTransform;
pub use lanes::{LANES, dot, sum};
pub use product::{product, product_transposed, transposed_product, with_columns};
pub use rows::{add_product_to_rows, add_to_rows, combine_rows, stride, turn_rows};
pub use singular::thin_svd;
pub use small::RowLu;
pub use sparse::{SparseCholesky, SparseSymmetric};
pub use steps::{add_product, scalar_products, turn};
