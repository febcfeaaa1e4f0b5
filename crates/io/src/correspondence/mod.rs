//! Where points are seen in another picture: optical flow and disparity, in the files of the benchmarks.
//!
//! | file | numbers | not known | holds | after |
//! | --- | --- | --- | --- | --- |
//! | [`encode_flo`], `.flo` | two 32-bit floats a pixel, px | 10¹⁰ | all | Middlebury: Baker et al. 2011, "A database and evaluation methodology for optical flow", IJCV 92 |
//! | [`encode_kitti_flow`], 16-bit RGB PNG | R = 64 u + 2¹⁵, G = 64 v + 2¹⁵, B = 1 | B = 0 | ±512 px in steps of 1/64 | KITTI 2015: Menze, Geiger 2015, "Object scene flow for autonomous vehicles", CVPR |
//! | [`encode_kitti_disparity`], 16-bit grey PNG | 256 d | 0 | 1/256 to 256 px in steps of 1/256 | KITTI 2012 and 2015 |
//! | [`encode_pfm`], `.pfm` | a 32-bit float a pixel | +∞ | all | Debevec's float map, as Middlebury's stereo sets have it (Scharstein et al. 2014, GCPR) |
//!
//! u is to the right and v down, both in pixels. In memory what is not known is NaN. What a KITTI file cannot hold is marked as not known, never
//! cut to the nearest number; only a disparity below 1/512 px, which would read as not known, becomes 1/256 px, as KITTI's own program writes it.

mod kitti;
mod middlebury;
mod pfm;
#[cfg(test)]
pub(crate) mod tests_support;

pub(crate) use kitti::{decode_kitti_flow, is_kitti_flow};
pub use kitti::{encode_kitti_disparity, encode_kitti_flow};
pub(crate) use middlebury::is_flo;
pub use middlebury::{decode_flo, encode_flo};
pub use pfm::encode_pfm;

use crate::Error;
use crate::source::read_bytes;
use etendue_core::Plane;
use etendue_core::quantity::OpticalFlow;
use std::path::Path;

/// The optical flow in a `.flo` or a PNG of KITTI, NaN where it is not known; `None` where the file is neither.
///
/// # Errors
/// Where it is missing or damaged.
pub fn read_flow(file: &Path) -> Result<Option<Plane<OpticalFlow>>, Error> {
    let bytes = read_bytes(file, "flow or picture")?;
    match (is_flo(&bytes), is_kitti_flow(&bytes)) {
        (true, _) => decode_flo(file, &bytes).map(Some),
        (_, true) => decode_kitti_flow(file, &bytes).map(Some),
        _ => Ok(None),
    }
}
