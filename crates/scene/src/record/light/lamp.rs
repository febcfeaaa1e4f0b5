//! Lamps: point lights, or openings with the far-field distribution of a point light.

use std::path::PathBuf;

use super::emission::{LightColour, check_colour};
use super::modulation::{self, Modulation};
use super::opening::{self, LampOpening};
use super::placement::LampPlacement;
use super::strength::{LampStrength, MeasuredStrength};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, number, path, record, text, vector, words};
use crate::record::texture::IMAGE_EXTENSIONS;

record! {
    /// A lamp with equal intensity in all directions.
    pub struct PointLamp check(check_point) {
        /// Name of the light.
        required name: Placed<String> = text("the name of the light");
        /// Position. Its direction matters only with "mask", or with an "opening" that is no sphere.
        inside placement: LampPlacement;
        /// Strength, before the mask.
        inside strength: LampStrength;
        /// Colour.
        inside colour: LightColour;
        /// Image projected along +x that shapes the light.
        optional mask: Mask = record();
        /// Luminous surface. Default: an invisible point.
        optional opening: LampOpening = record();
        /// Strength over time. Default: constant.
        optional modulation: Modulation = record();
    }
}

record! {
    /// A lamp with a cone of light about its +x axis.
    pub struct SpotLamp check(check_spot) {
        /// Name of the light.
        required name: Placed<String> = text("the name of the light");
        /// Position and direction.
        inside placement: LampPlacement;
        /// Strength.
        inside strength: LampStrength;
        /// Colour.
        inside colour: LightColour;
        /// Full angle of the cone.
        required field_angle_deg: Placed<f64> = number("°").above(0.0).at_most(360.0);
        /// Full angle of constant intensity, falling smoothly to the field angle. Default: the field angle.
        optional inner_angle_deg: Placed<f64> = number("°").at_least(0.0).at_most(360.0);
        /// Image projected along +x that shapes the light.
        optional mask: Mask = record();
        /// Luminous surface. Default: an invisible point.
        optional opening: LampOpening = record();
        /// Strength over time. Default: constant.
        optional modulation: Modulation = record();
    }
}

record! {
    /// A lamp with measured intensities. Photometry of type C (road lamps): γ = 0 along −z, C0 towards +x, C90 towards +y. Types A and B (headlamps):
    /// along +x, positive horizontal angles to its right (−y).
    pub struct MeasuredLamp check(check_measured) {
        /// Name of the light.
        required name: Placed<String> = text("the name of the light");
        /// File of the measured intensities.
        required file: Placed<PathBuf> = path(&["ies", "ldt"]);
        /// Position and direction.
        inside placement: LampPlacement;
        /// Scale of the measured strength. Default: as measured.
        group strength: MeasuredStrength;
        /// Colour; the file does not contain it.
        inside colour: LightColour;
        /// Image projected along +x that shapes the light; not for photometry of type C.
        optional mask: Mask = record();
        /// Luminous surface. Default: an invisible point.
        optional opening: LampOpening = record();
        /// Strength over time. Default: constant.
        optional modulation: Modulation = record();
    }
}

record! {
    /// One beam of a headlamp.
    pub struct HeadLamp check(check_head_lamp) {
        /// Name of the light.
        required name: Placed<String> = text("the name of the light");
        /// Beam.
        required beam: Placed<Beam> = choice();
        /// For "low_beam": side of the road of the traffic, towards which the cut-off rises.
        optional traffic: Placed<Traffic> = choice();
        /// Downward tilt besides the beam's own dip. Default: 0.
        optional aim_down_deg: Placed<f64> = number("°").at_least(-10.0).at_most(10.0);
        /// Position and direction.
        inside placement: LampPlacement;
        /// Scale of the built-in beam's strength. Default: unscaled.
        group strength: MeasuredStrength;
        /// Colour.
        inside colour: LightColour;
        /// Image projected along +x that shapes the light.
        optional mask: Mask = record();
        /// Luminous surface. Default: an invisible point.
        optional opening: LampOpening = record();
        /// Strength over time. Default: constant.
        optional modulation: Modulation = record();
    }
}

words! {
    /// A beam of a headlamp.
    pub enum Beam {
        /// The passing beam, with an asymmetric cut-off.
        "low_beam" => Low,
        /// The driving beam.
        "high_beam" => High,
    }
}

words! {
    /// Side of the road on which traffic drives.
    pub enum Traffic {
        /// As in France or the United States.
        "right" => Right,
        /// As in Great Britain or Japan.
        "left" => Left,
    }
}

record! {
    /// An image in front of a lamp that shapes its light. Its middle is projected along the lamp's +x axis, its left column to the lamp's left (+y),
    /// its top row up.
    pub struct Mask {
        /// Image whose luminance is the transmittance (sRGB-encoded; HDR and EXR are linear and may exceed 1).
        required file: Placed<PathBuf> = path(IMAGE_EXTENSIONS);
        /// Full angles of the image's width and height; no light falls outside.
        required field_deg: Placed<[f64; 2]> = vector::<2>(number("°").above(0.0).at_most(179.0));
    }
}

/// Checks a lamp of equal intensity in all directions, which has no direction.
fn check_point(lamp: &PointLamp, errors: &mut DescriptionErrors) {
    check_colour(&lamp.colour, errors);
    opening::check(lamp.opening.as_ref(), &lamp.placement, false, errors);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, errors);
    if lamp.mask.is_some() || lamp.opening.as_ref().is_some_and(LampOpening::turns) {
        return;
    }
    for aim in lamp.placement.aims() {
        errors.add(ErrorCode::NoEffect, aim.place(), "an isotropic light has no direction", "remove it");
    }
}

fn check_spot(lamp: &SpotLamp, errors: &mut DescriptionErrors) {
    check_colour(&lamp.colour, errors);
    opening::check(lamp.opening.as_ref(), &lamp.placement, false, errors);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, errors);
    if let Some(inner) = &lamp.inner_angle_deg
        && inner.value > lamp.field_angle_deg.value
    {
        let problem = format!("found {}, but the field ends at {}", inner.value, lamp.field_angle_deg.value);
        errors.add(ErrorCode::WrongOrder, &inner.place, problem, "give an inner angle of at most \"field_angle_deg\"");
    }
}

fn check_measured(lamp: &MeasuredLamp, errors: &mut DescriptionErrors) {
    check_colour(&lamp.colour, errors);
    opening::check(lamp.opening.as_ref(), &lamp.placement, true, errors);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, errors);
}

fn check_head_lamp(lamp: &HeadLamp, errors: &mut DescriptionErrors) {
    check_colour(&lamp.colour, errors);
    opening::check(lamp.opening.as_ref(), &lamp.placement, false, errors);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, errors);
    match (lamp.beam.value, &lamp.traffic) {
        (Beam::Low, None) => errors.add(
            ErrorCode::MissingKey,
            &lamp.beam.place,
            "the side of the road towards which the cut-off of the low beam rises is missing",
            "add traffic = \"right\" or \"left\"",
        ),
        (Beam::High, Some(traffic)) => {
            errors.add(
                ErrorCode::NoEffect,
                &traffic.place,
                "\"traffic\" has no effect here, it belongs to beam = \"low_beam\"",
                "remove it",
            );
        }
        _ => {}
    }
}
