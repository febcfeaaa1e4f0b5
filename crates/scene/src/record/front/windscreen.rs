//! A windscreen in front of the camera.

use super::drops::Drops;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{flag, list, number, record};
use crate::record::curve::{Curve, curve};
use crate::record::lens::prescription::{Coating, coating};
use crate::record::reflectance::{Colour, any_colour};

record! {
    /// A windscreen: laminated glass, tilted and curved, without edges. It refracts light, and two internal reflections give a double image.
    pub struct Windscreen check(check) {
        /// Distance from the entrance pupil to its inner face along the axis.
        required distance_mm: Placed<f64> = number("mm").above(0.0);
        /// Angle between its normal and the axis; positive tilts its top towards the camera. Default: 0.
        optional tilt_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
        /// Rotation of its normal to the right. Default: 0.
        optional yaw_deg: Placed<f64> = number("°").at_least(-89.0).at_most(89.0);
        /// Horizontal radius of curvature of the inner face, centred on the camera's side. Default: flat.
        optional radius_across_mm: Placed<f64> = number("mm").above(0.0);
        /// Vertical radius of curvature of the inner face, centred on the camera's side. Default: flat.
        optional radius_upright_mm: Placed<f64> = number("mm").above(0.0);
        /// Layers, from the camera outwards. Default: 2.1 mm glass (n 1.52), 0.76 mm polyvinyl butyral (n 1.48), 2.1 mm glass.
        optional layers: Vec<Layer> = list(record::<Layer>(), 1);
        /// Wedge angle of the middle layer; the thickness grows upwards. Default: 0.
        optional wedge_mrad: Placed<f64> = number("mrad").at_least(-100.0).at_most(100.0);
        /// Bulk transmittance at normal incidence; lists are linear sRGB. Default: 1.
        optional internal_transmittance: Colour = any_colour();
        /// With "internal_transmittance": its thickness. Default: that of all layers.
        optional reference_thickness_mm: Placed<f64> = number("mm").above(0.0);
        /// Transmittance of each outer face: uncoated (Fresnel), a fraction or a layer. Default: "uncoated".
        optional coating: Coating = coating();
        /// Adds light reflected twice within the glass. Default: true.
        optional double_image: Placed<bool> = flag();
        /// Fraction of samples for the double image; affects noise only. Default: its fraction of the light.
        optional double_image_sample_fraction: Placed<f64> = number("").above(0.0).at_most(0.9);
        /// Water drops on the outer face.
        optional drops: Drops = record();
    }
}

record! {
    /// A layer of glass.
    pub struct Layer {
        /// Thickness.
        required thickness_mm: Placed<f64> = number("mm").above(0.0);
        /// Refractive index relative to air.
        required index: Curve = curve(number("").at_least(1.01).at_most(4.0));
    }
}

fn check(glass: &Windscreen, errors: &mut DescriptionErrors) {
    if let (Some(thickness), None) = (&glass.reference_thickness_mm, &glass.internal_transmittance) {
        let problem = "\"reference_thickness_mm\" has no effect here, it belongs to \"internal_transmittance\"";
        errors.add(ErrorCode::NoEffect, &thickness.place, problem, "remove it, or add the transmittance");
    }
    let doubles = glass.double_image.as_ref().is_none_or(|d| d.value);
    if let (Some(fraction), false) = (&glass.double_image_sample_fraction, doubles) {
        let problem = "\"double_image_sample_fraction\" has no effect with double_image = false";
        errors.add(ErrorCode::NoEffect, &fraction.place, problem, "remove one of them");
    }
}
