//! Colour: XYZ, linear and encoded sRGB, CIE L*a*b*, and colour difference.
//!
//! Linear sRGB has the primaries of IEC 61966-2-1 and, as white, illuminant D65 as this crate tabulates and integrates
//! it ([`D65_WHITE`]), so that a perfect diffuser under D65 is exactly grey; the standard's own white (x = 0.3127,
//! y = 0.3290) differs by less than 3e-4.

mod difference;
mod lab;
mod luma;
mod primaries;
mod srgb;

pub use difference::ciede2000;
pub use lab::{Lab, lab};
pub use luma::{BT709, luma};
pub use primaries::{Primaries, REC_709};
pub use srgb::{
    D65_WHITE, SRGB_FROM_XYZ, XYZ_FROM_SRGB, decode, decode_byte, encode, linear_srgb_from_xyz, xyz_from_linear_srgb,
};
