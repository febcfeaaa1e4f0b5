//! Lamps: points, or openings that shine as points would from afar.

use std::path::PathBuf;

use super::emission::{LightColour, check_colour};
use super::modulation::{self, Modulation};
use super::opening::{self, LampOpening};
use super::placement::LampPlacement;
use super::strength::{LampStrength, MeasuredStrength};
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{choice, number, path, record, text, vector, words};

record! {
    /// Shines alike in all directions.
    pub struct PointLamp check(check_point) {
        /// Its name.
        required name: Placed<String> = text("the name of the light");
        /// Where it stands. It points somewhere only with "mask", or with an "opening" that is no sphere.
        inside placement: LampPlacement;
        /// How much light, before the mask.
        inside strength: LampStrength;
        /// Of which colour.
        inside colour: LightColour;
        /// A picture that shapes its light, along its +x axis. Default: none.
        optional mask: Mask = record();
        /// The surface that its light leaves from. Default: none, a point, which casts sharp shadows and is not seen itself.
        optional opening: LampOpening = record();
        /// How its strength changes over time. Default: not at all.
        optional modulation: Modulation = record();
    }
}

record! {
    /// Shines in a cone about its +x axis.
    pub struct SpotLamp check(check_spot) {
        /// Its name.
        required name: Placed<String> = text("the name of the light");
        /// Where it stands.
        inside placement: LampPlacement;
        /// How much light.
        inside strength: LampStrength;
        /// Of which colour.
        inside colour: LightColour;
        /// Full angle of the cone outside of which there is no light, degrees, above 0 and at most 360.
        required field_angle_deg: Placed<f64> = number("°").above(0.0).at_most(360.0);
        /// Full angle of the cone within which the intensity is constant, degrees, 0 up to the field angle; between the two
        /// it falls smoothly. Default: the field angle, a sharp edge.
        optional inner_angle_deg: Placed<f64> = number("°").at_least(0.0).at_most(360.0);
        /// A picture that shapes its light, along its +x axis. Default: none.
        optional mask: Mask = record();
        /// The surface that its light leaves from. Default: none, a point, which casts sharp shadows and is not seen itself.
        optional opening: LampOpening = record();
        /// How its strength changes over time. Default: not at all.
        optional modulation: Modulation = record();
    }
}

record! {
    /// Shines as it was measured. A lamp of type C (road lamps) hangs with γ = 0 along −z, C0 towards +x and C90 towards +y;
    /// one of type A or B (head lamps) shines along +x, with positive horizontal angles to its right (−y).
    pub struct MeasuredLamp check(check_measured) {
        /// Its name.
        required name: Placed<String> = text("the name of the light");
        /// The file of the intensities.
        required file: Placed<PathBuf> = path(&["ies", "ldt"]);
        /// Where it stands.
        inside placement: LampPlacement;
        /// Whether it is stronger or weaker than measured. Default: as measured.
        group strength: MeasuredStrength;
        /// Of which colour; the file does not say it.
        inside colour: LightColour;
        /// A picture that shapes its light, along its +x axis. Not for photometry of type C, which shines down. Default:
        /// none.
        optional mask: Mask = record();
        /// The surface that its light leaves from. Default: none, a point, which casts sharp shadows and is not seen itself.
        optional opening: LampOpening = record();
        /// How its strength changes over time. Default: not at all.
        optional modulation: Modulation = record();
    }
}

record! {
    /// One beam of a head lamp.
    pub struct HeadLamp check(check_head_lamp) {
        /// Its name.
        required name: Placed<String> = text("the name of the light");
        /// Which beam.
        required beam: Placed<Beam> = choice();
        /// With beam = "low_beam": the side of the road on which traffic keeps; the cut-off rises towards it.
        optional traffic: Placed<Traffic> = choice();
        /// How far the lamp is turned down from its frame, degrees, −10 … 10, besides the dip that the beam has of its own.
        /// Default: 0.
        optional aim_down_deg: Placed<f64> = number("°").at_least(-10.0).at_most(10.0);
        /// Where it stands.
        inside placement: LampPlacement;
        /// Whether it is stronger or weaker than the ready beam. Default: as it is.
        group strength: MeasuredStrength;
        /// Of which colour.
        inside colour: LightColour;
        /// A picture that shapes its light, along its +x axis. Default: none.
        optional mask: Mask = record();
        /// The surface that its light leaves from. Default: none, a point, which casts sharp shadows and is not seen itself.
        optional opening: LampOpening = record();
        /// How its strength changes over time. Default: not at all.
        optional modulation: Modulation = record();
    }
}

words! {
    /// A beam of a head lamp.
    pub enum Beam {
        /// The passing beam, with an asymmetric cut-off.
        "low_beam" => Low,
        /// The driving beam.
        "high_beam" => High,
    }
}

words! {
    /// The side of the road on which traffic keeps.
    pub enum Traffic {
        /// As in France or the United States.
        "right" => Right,
        /// As in Great Britain or Japan.
        "left" => Left,
    }
}

record! {
    /// A picture before a lamp, that shapes its light in space. Its middle lies along the lamp's +x axis, its left column to
    /// the lamp's left (+y), its top row up.
    pub struct Mask {
        /// The picture, whose luminance is the share of the light that is let through; 0 … 1, or more in an HDR picture. PNG
        /// and JPEG are taken as sRGB-encoded.
        required file: Placed<PathBuf> = path(&["png", "jpg", "jpeg", "hdr", "exr"]);
        /// Full angles that the picture's width and height cover, degrees, above 0 and at most 179 (a plane picture,
        /// projected). Beyond it is dark.
        required field_deg: Placed<[f64; 2]> = vector::<2>(number("°").above(0.0).at_most(179.0));
    }
}

/// A lamp that shines alike in all directions points nowhere.
fn check_point(lamp: &PointLamp, faults: &mut Faults) {
    check_colour(&lamp.colour, faults);
    opening::check(lamp.opening.as_ref(), &lamp.placement, false, faults);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, faults);
    if lamp.mask.is_some() || lamp.opening.as_ref().is_some_and(LampOpening::turns) {
        return;
    }
    for aim in lamp.placement.aims() {
        faults.add(
            ErrorCode::NoEffect,
            aim.place(),
            "a lamp that shines alike in all directions points nowhere",
            "remove it",
        );
    }
}

fn check_spot(lamp: &SpotLamp, faults: &mut Faults) {
    check_colour(&lamp.colour, faults);
    opening::check(lamp.opening.as_ref(), &lamp.placement, false, faults);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, faults);
    if let Some(inner) = &lamp.inner_angle_deg
        && inner.value > lamp.field_angle_deg.value
    {
        let problem = format!("found {}, and the field ends at {}", inner.value, lamp.field_angle_deg.value);
        faults.add(ErrorCode::WrongOrder, &inner.place, problem, "give an inner angle of at most \"field_angle_deg\"");
    }
}

fn check_measured(lamp: &MeasuredLamp, faults: &mut Faults) {
    check_colour(&lamp.colour, faults);
    opening::check(lamp.opening.as_ref(), &lamp.placement, true, faults);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, faults);
}

fn check_head_lamp(lamp: &HeadLamp, faults: &mut Faults) {
    check_colour(&lamp.colour, faults);
    opening::check(lamp.opening.as_ref(), &lamp.placement, false, faults);
    modulation::check(lamp.modulation.as_ref(), &lamp.placement, faults);
    match (lamp.beam.value, &lamp.traffic) {
        (Beam::Low, None) => faults.add(
            ErrorCode::MissingKey,
            &lamp.beam.place,
            "a low beam rises towards one side of the road, which is not said",
            "add traffic = \"right\" or \"left\"",
        ),
        (Beam::High, Some(traffic)) => {
            faults.add(
                ErrorCode::NoEffect,
                &traffic.place,
                "\"traffic\" has no effect here, it belongs to beam = \"low_beam\"",
                "remove it",
            );
        }
        _ => {}
    }
}
