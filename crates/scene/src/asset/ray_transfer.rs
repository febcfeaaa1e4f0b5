//! Ray-transfer functions of a lens, as ISET's files state them.

/// A term c ρ^a dx^b dy^d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TermAsset {
    /// c.
    pub coefficient: f64,
    /// a, b, d.
    pub powers: [u8; 3],
}

/// Which rays pass a plane.
#[derive(Clone, Debug, PartialEq)]
pub enum PassAsset {
    /// Ellipses by the height on the input plane: the height, centre and semi-axes (x, y), mm.
    Ellipses(Vec<(f64, [f64; 2], [f64; 2])>),
    /// Circles that all have to be passed: radius (mm), and height of the centre over that on the input plane.
    Circles(Vec<(f64, f64)>),
}

/// The functions of one wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferAsset {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// What passes.
    pub pass: PassAsset,
    /// The plane of what passes, from the input plane towards the scene, mm.
    pub pass_plane_mm: f64,
    /// Polynomials of x, y, z (mm, from the front vertex), dx, dy.
    pub outputs: [Vec<TermAsset>; 5],
    /// The polynomial whose sign is that of dz, where the file uses one.
    pub forwards: Option<Vec<TermAsset>>,
}

/// A ray-transfer file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayTransferAsset {
    /// The lens's name; may be empty.
    pub name: String,
    /// From the rear vertex to the front vertex, mm.
    pub thickness_mm: f64,
    /// The input plane from the rear vertex towards the sensor, mm.
    pub input_offset_mm: f64,
    /// By rising wavelength.
    pub transfers: Vec<TransferAsset>,
    /// What was passed over, a sentence each.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
