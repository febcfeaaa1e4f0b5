//! Ray-transfer functions of a lens, from ISET's files.

/// A term c ρ^a dx^b dy^d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TermAsset {
    /// c.
    pub coefficient: f64,
    /// a, b, d.
    pub powers: [u8; 3],
}

/// Ray-pass function: rays that pass a plane.
#[derive(Clone, Debug, PartialEq)]
pub enum PassAsset {
    /// Ellipses by the height on the input plane: the height, centre and semi-axes (x, y), mm.
    Ellipses(Vec<(f64, [f64; 2], [f64; 2])>),
    /// Circles that a ray must all pass: radius (mm), and height of the centre over that on the input plane.
    Circles(Vec<(f64, f64)>),
}

/// The functions of one wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferAsset {
    pub wavelength_nm: f64,
    /// Ray-pass function.
    pub pass: PassAsset,
    /// Plane of the ray-pass function, from the input plane towards the scene, mm.
    pub pass_plane_mm: f64,
    /// Polynomials of x, y, z (mm, from the front vertex), dx, dy.
    pub outputs: [Vec<TermAsset>; 5],
    /// Polynomial whose sign is that of dz, if the file has one.
    pub forwards: Option<Vec<TermAsset>>,
}

/// A ray-transfer file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayTransferAsset {
    /// Name of the lens; may be empty.
    pub name: String,
    /// Distance from the rear vertex to the front vertex, mm.
    pub thickness_mm: f64,
    /// Distance of the input plane from the rear vertex towards the sensor, mm.
    pub input_offset_mm: f64,
    /// Functions by increasing wavelength.
    pub transfers: Vec<TransferAsset>,
    /// Ignored content, one sentence each.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
