//! A windscreen in front of the camera.

use super::drops::Drops;
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{flag, list, number, record};
use crate::record::curve::{Curve, curve};
use crate::record::lens::prescription::{Coating, coating};
use crate::record::reflectance::{Colour, any_colour};

record! {
    /// A windscreen: laminated glass, tilted and curved, without edges. It refracts light, and two internal reflections give a double image.
    pub struct Windscreen check(check) {
        /// Distance from the centre of the entrance pupil to its inner face, along the camera's axis, mm, above 0.
        required distance_mm: Placed<f64> = number("mm").above(0.0);
        /// Angle between its normal and the camera's axis, degrees; positive tilts the upper edge towards the camera, as in cars. −89 … 89. Default:
        /// 0.
        optional tilt_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
        /// Rotation of its normal to the right, degrees, −89 … 89. Default: 0.
        optional yaw_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
        /// Horizontal radius of curvature of its inner face, mm, above 0, with the centre on the camera's side. Default: flat.
        optional radius_across_mm: Placed<f64> = number("mm").above(0.0);
        /// Vertical radius of curvature of its inner face, mm, above 0, with the centre on the camera's side. Default: flat.
        optional radius_upright_mm: Placed<f64> = number("mm").above(0.0);
        /// Layers, from the camera outwards. Default: 2.1 mm of glass (n 1.52), 0.76 mm of polyvinyl butyral (n 1.48), 2.1 mm of glass.
        optional layers: Vec<Layer> = list(record::<Layer>(), 1);
        /// Wedge angle by which the thickness grows upwards, mrad, −100 … 100; it lies in the middle layer. Default: 0.
        optional wedge_mrad: Placed<f64> = number("mrad").at_least(-100.0).at_most(100.0);
        /// Transmittance of the bulk at normal incidence, without reflections: a number, `[r, g, b]` (linear sRGB), `{ srgb = [r, g, b] }`, `{
        /// spectrum = file }` or `{ named = "…" }`; 0 … 1. Default: 1.
        optional internal_transmittance: Colour = any_colour();
        /// With "internal_transmittance": thickness to which it refers, mm, above 0. Default: that of all layers.
        optional reference_thickness_mm: Placed<f64> = number("mm").above(0.0);
        /// Transmittance of each of the two outer faces: "uncoated" (Fresnel), a fraction above 0 and at most 1, or `{ quarter_wave_nm = … }`.
        /// Default: "uncoated".
        optional coating: Coating = coating();
        /// Adds light that is reflected twice within the glass. Default: true.
        optional double_image: Placed<bool> = flag();
        /// Fraction of samples for the double image, above 0 and at most 0.9. More samples lower its noise and raise that of the rest; the mean does
        /// not change. Default: its fraction of the light.
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
        /// Refractive index relative to air, 1.01 … 4: a number, or `{ spectrum = file }`.
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
