//! The luminous opening of a lamp: the surface that emits its light.

use super::placement::LampPlacement;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{NumberRule, number, record, variants};

variants! {
    /// Surface about the lamp's position that emits its light. It is visible directly and in mirrors, and turns with the lamp. Flat openings are
    /// perpendicular to the lamp's main direction (+x, or the downward axis for photometry in C planes) and emit to either side as the lamp's
    /// distribution does.
    pub enum LampOpening by "shape" {
        /// A sphere.
        "sphere" => Sphere(SphereOpening),
        /// A disc: a 48-sided polygon of equal area.
        "disc" => Disc(DiscOpening),
        /// A rectangle.
        "rectangle" => Rectangle(RectangleOpening),
        /// A cylinder along y that emits from side and ends: a prism of 48 sides.
        "tube" => Tube(TubeOpening),
        /// For "measured": the opening in the file of intensities.
        "file" => File(FileOpening),
    }
}

record! {
    /// A sphere.
    pub struct SphereOpening {
        /// Radius.
        required radius_m: Placed<f64> = radius();
    }
}

record! {
    /// A disc.
    pub struct DiscOpening {
        /// Radius.
        required radius_m: Placed<f64> = radius();
    }
}

record! {
    /// A rectangle.
    pub struct RectangleOpening {
        /// Extent along the lamp's y axis.
        required width_m: Placed<f64> = side();
        /// Extent along the lamp's z axis; x for photometry in C planes.
        required height_m: Placed<f64> = side();
    }
}

record! {
    /// A cylinder.
    pub struct TubeOpening {
        /// Extent along the lamp's y axis.
        required length_m: Placed<f64> = side();
        /// Radius.
        required radius_m: Placed<f64> = radius();
    }
}

record! {
    /// The opening stated in the file.
    pub struct FileOpening {}
}

const fn radius() -> NumberRule {
    number("m").at_least(1e-4).at_most(50.0)
}

const fn side() -> NumberRule {
    number("m").at_least(1e-4).at_most(100.0)
}

impl LampOpening {
    /// Place in the description.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Sphere(v) => &v.place,
            Self::Disc(v) => &v.place,
            Self::Rectangle(v) => &v.place,
            Self::Tube(v) => &v.place,
            Self::File(v) => &v.place,
        }
    }

    /// True if its orientation matters; always true for a file, whose shape is unknown here.
    pub(super) fn turns(&self) -> bool {
        !matches!(self, Self::Sphere(_))
    }
}

/// Reports contradictions of an opening.
pub(super) fn check(
    opening: Option<&LampOpening>,
    placement: &LampPlacement,
    is_measured: bool,
    errors: &mut DescriptionErrors,
) {
    let Some(opening) = opening else { return };
    if let (LampOpening::File(file), false) = (opening, is_measured) {
        errors.add(
            ErrorCode::NoEffect,
            &file.place,
            "shape = \"file\" has no effect here, it belongs to type = \"measured\"",
            "give one of \"sphere\", \"disc\", \"rectangle\", \"tube\"",
        );
    }
    if let Some(attenuation) = &placement.attenuation_per_m {
        errors.add(
            ErrorCode::Contradiction,
            &attenuation.place,
            "\"attenuation_per_m\" contradicts \"opening\": the radiance of a surface does not depend on distance",
            "remove one of the two",
        );
    }
}
