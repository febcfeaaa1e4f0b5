//! What a chart's truth finds in a picture, and where.

use etendue_metrology::sfr::Strip;

/// A patch in the picture.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub name: String,
    /// Left column, top row, width, height, of the picture.
    pub at: [usize; 4],
    /// Its luminance, cd/m².
    pub luminance_cd_m2: f64,
    /// CIE XYZ, Y of the perfect diffuser 1.
    pub xyz: [f64; 3],
}

/// A star in the picture: its centre, and the rims of its ground and its own.
pub(crate) struct StarPlace {
    pub centre_px: [f64; 2],
    pub cycles: u32,
    pub inner_px: f64,
    pub outer_px: f64,
}

/// A light trap and the white about it.
pub(crate) struct TrapPlace {
    pub trap: [usize; 4],
    pub whites: Vec<[usize; 4]>,
}

/// An edge of a star among its others.
pub(crate) struct Spoke {
    pub strip: Strip,
    pub star: Star,
}

/// A star: which, and where its centre is in the picture.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Star {
    pub index: [usize; 2],
    pub centre_px: [f64; 2],
}

/// An edge and where it is sought.
pub(crate) struct Sought {
    /// Left column, top row, width, height, of the picture.
    pub at: [usize; 4],
    pub spoke: Option<Spoke>,
}
