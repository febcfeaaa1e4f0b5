//! Small dense linear algebra in `f64`: what fits of some hundred parameters need.
//!
//! | what | for | file |
//! | --- | --- | --- |
//! | [`Matrix`] | row-major storage | `matrix.rs` |
//! | [`Cholesky`] | normal equations, covariance | `cholesky.rs` |
//! | [`Orthogonal`] | least squares whose conditioning counts | `orthogonal.rs` |
//! | [`eigen()`] | null vectors, what a fit cannot tell | `eigen.rs` |
//!
//! Golub & Van Loan, Matrix Computations (4th ed., 2013): algorithms 4.2.1, 5.2.1 and 8.5.2. Sums run in index order.
//! Left out: pivoting, sparse matrices, anything of more than some thousand columns.

mod cholesky;
mod eigen;
pub(crate) mod matrix;
mod orthogonal;

pub use cholesky::Cholesky;
pub use eigen::{Eigen, eigen};
pub use matrix::Matrix;
pub use orthogonal::{Orthogonal, Solution};
