//! `[external_optics]`: elements in front of the lens, attached to the camera.

pub mod dirt;
pub mod drops;
pub mod mirror;
pub mod windscreen;

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::reader::record;
pub use dirt::Dirt;
pub use drops::Drops;
pub use mirror::Mirror;
pub use windscreen::Windscreen;

record! {
    /// Elements in front of the lens that move with the camera.
    pub struct ExternalOptics check(check) {
        /// Dirt on the front glass.
        optional dirt: Dirt = record();
        /// Windscreen.
        optional windscreen: Windscreen = record();
        /// Mirror.
        optional mirror: Mirror = record();
    }
}

fn check(front: &ExternalOptics, errors: &mut DescriptionErrors) {
    if front.dirt.is_none() && front.windscreen.is_none() && front.mirror.is_none() {
        let remedy = "add \"dirt\", \"windscreen\" or \"mirror\", or remove \"external_optics\"";
        errors.add(ErrorCode::Empty, &front.place, "there is nothing in front of the lens", remedy);
    }
    if let (Some(_), Some(mirror)) = (&front.windscreen, &front.mirror) {
        let problem = "a mirror and a windscreen in front of the same lens are not modelled";
        errors.add(ErrorCode::NotModelled, &mirror.place, problem, "keep one of them");
    }
    let behind = |dirt: &&Dirt| front.windscreen.iter().any(|g| dirt.distance_mm.value > g.distance_mm.value);
    if let Some(dirt) = front.dirt.as_ref().filter(behind) {
        let problem = "the dirt is beyond the windscreen; rays would cross it before the windscreen refracts them";
        errors.add(
            ErrorCode::OutOfRange,
            &dirt.distance_mm.place,
            problem,
            "give a distance of at most the windscreen's distance_mm",
        );
    }
}
