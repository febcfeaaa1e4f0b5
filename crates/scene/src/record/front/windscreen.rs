//! Glass that the camera looks through.

use super::drops::Drops;
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{flag, list, number, record};
use crate::record::curve::{Curve, curve};
use crate::record::lens::prescription::{Coating, coating};
use crate::record::reflectance::{Colour, any_colour};

record! {
    /// A wind-screen: laminated glass, tilted and curved, without edges. Light is refracted through it, and some comes by
    /// two reflections within it: a double image.
    pub struct Windscreen check(check) {
        /// Distance of its inner face from the centre of the entrance pupil, along the camera's axis, mm, above 0.
        required distance_mm: Placed<f64> = number("mm").above(0.0);
        /// Angle between its normal and the camera's axis, degrees; positive leans the upper edge towards the camera, as in
        /// cars. −89 … 89. Default: 0.
        optional tilt_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
        /// How its normal is turned to the right, degrees, −89 … 89. Default: 0.
        optional yaw_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
        /// Radius of curvature of its inner face to left and right, mm, above 0, its centre on the camera's side.
        /// Default: not curved.
        optional radius_across_mm: Placed<f64> = number("mm").above(0.0);
        /// The same upwards and downwards. Default: not curved.
        optional radius_upright_mm: Placed<f64> = number("mm").above(0.0);
        /// Layers, from the camera outwards. Default: 2.1 mm of glass (n 1.52), 0.76 mm of polyvinyl butyral (n 1.48), 2.1 mm of
        /// glass.
        optional layers: Vec<Layer> = list(record::<Layer>(), 1);
        /// Angle by which the glass grows thicker upwards, mrad, −100 … 100; it lies in the middle layer. Default: 0.
        optional wedge_mrad: Placed<f64> = number("mrad").at_least(-100.0).at_most(100.0);
        /// Share of light that the bulk lets through at normal incidence, without reflections: a number, `[r, g, b]`
        /// (linear sRGB), `{ srgb = [r, g, b] }`, `{ spectrum = file }` or `{ named = "…" }`; 0 … 1. Default: 1.
        optional internal_transmittance: Colour = any_colour();
        /// With "internal_transmittance": the thickness for which it is stated, mm, above 0. Default: that of all layers.
        optional reference_thickness_mm: Placed<f64> = number("mm").above(0.0);
        /// What each of the two outer faces lets through: "uncoated" (Fresnel), a share above 0 and at most 1, or
        /// `{ quarter_wave_nm = … }`. Default: "uncoated".
        optional coating: Coating = coating();
        /// Whether light that is reflected twice within the glass is added. Default: true.
        optional double_image: Placed<bool> = flag();
        /// Share of samples that look for the double image, above 0 and at most 0.9: more make it less noisy and the rest
        /// more. It does not change the mean. Default: the share of light in it.
        optional double_image_sample_fraction: Placed<f64> = number("").above(0.0).at_most(0.9);
        /// Drops of water on the outer face. Default: none.
        optional drops: Drops = record();
    }
}

record! {
    /// A layer of glass.
    pub struct Layer {
        /// Thickness, mm, above 0.
        required thickness_mm: Placed<f64> = number("mm").above(0.0);
        /// Refractive index against air, 1.01 … 4: a number, or `{ spectrum = file }`.
        required index: Curve = curve(number("").at_least(1.01).at_most(4.0));
    }
}

fn check(glass: &Windscreen, faults: &mut Faults) {
    if let (Some(thickness), None) = (&glass.reference_thickness_mm, &glass.internal_transmittance) {
        let problem = "\"reference_thickness_mm\" has no effect here, it belongs to \"internal_transmittance\"";
        faults.add(ErrorCode::NoEffect, &thickness.place, problem, "remove it, or add the transmittance");
    }
    let doubles = glass.double_image.as_ref().is_none_or(|d| d.value);
    if let (Some(share), false) = (&glass.double_image_sample_fraction, doubles) {
        let problem = "\"double_image_sample_fraction\" has no effect with double_image = false";
        faults.add(ErrorCode::NoEffect, &share.place, problem, "remove one of them");
    }
}
