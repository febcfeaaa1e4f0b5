//! A camera known by where its pixels look.

use std::path::PathBuf;

use super::focus::{FocusDistance, focus_distance};
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, share};
use super::projection::{CalibrationFile, Projection, TableSource};
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{choice, keyed, list, number, path, record, words};

record! {
    /// A calibrated or ideal projection with a lens's light.
    pub struct Calibrated check(check) {
        /// Where its pixels look.
        inside view: View;
        /// How much light comes through, 0.5 or more: on the axis E = π τ L/(4 N²). With "focus_distance_m" also the pupil's size.
        required f_number: Placed<f64> = f_number();
        /// Distance of what is sharp from the entrance pupil, m, above 0, or "infinity": along the axis for a flat pupil, along
        /// the ray for a turning one. Default: everything is sharp.
        optional focus_distance_m: FocusDistance = focus_distance();
        /// How the entrance pupil stands. Default: "flat" for projections that see less than 180°, "turning" for others.
        optional pupil: Placed<Pupil> = choice();
        /// Measured relative illumination, in place of the pupil's and the projection's own. Default: theirs.
        optional relative_illumination: RelativeIllumination = record();
        /// The field angle (from the axis) from which on the camera sees nothing, degrees, above 0 and at most 180. Default:
        /// where the projection ends.
        optional greatest_angle_deg: Placed<f64> = number("degrees").above(0.0).at_most(180.0);
        /// Share of light that the lens lets through, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
        /// Image size by wavelength. Default: all colours alike.
        optional lateral_colour: LateralColour = record();
    }
}

keyed! {
    /// Where pixels look.
    pub enum View {
        /// A projection with its numbers.
        projection => Projection(Box<Projection>) = record();
        /// A calibration of another program; its picture must have the sensor's size.
        calibration => Calibration(Box<CalibrationFile>) = record();
    }
}

impl View {
    /// The file that a projection has its table from.
    #[must_use]
    pub fn projection_file(&self) -> Option<&Placed<PathBuf>> {
        match self {
            Self::Projection(projection) => match &**projection {
                Projection::Table(table) => match &table.source {
                    TableSource::File(file) => Some(file),
                    TableSource::Angles(_) => None,
                },
                _ => None,
            },
            Self::Calibration(_) => None,
        }
    }
}

words! {
    /// How an entrance pupil stands to the rays.
    pub enum Pupil {
        /// A disc across the axis: a direction sees it foreshortened by cos θ, so light falls off as cos θ dΩ/dA; sees less than
        /// 180°.
        "flat" => Flat,
        /// Turned towards each direction, as wide lenses' pupils do: light falls off as dΩ/dA.
        "turning" => Turning,
    }
}

record! {
    /// Irradiance over that on the axis, linear between the points.
    pub struct RelativeIllumination check(check_illumination) {
        /// Where its points are.
        inside source: IlluminationSource;
        /// With "radius_mm": irradiance over that on the axis, 0 or more; the first is 1.
        optional ratio: Vec<Placed<f64>> = list(number("").at_least(0.0), 1);
    }
}

keyed! {
    /// Where a relative illumination is.
    pub enum IlluminationSource {
        /// Zemax's "Relative Illumination" exported as text, its fields in degrees or in mm of the picture, to the picture's farthest corner or beyond.
        file => File(Placed<PathBuf>) = path(&["txt"]);
        /// Distances from the principal point, mm, rising from 0 to the picture's farthest corner or beyond.
        radius_mm => Radii(Vec<Placed<f64>>) = list(number("mm").at_least(0.0), 1);
    }
}

fn check(lens: &Calibrated, faults: &mut Faults) {
    if let (Some(pupil), Some(_), None) = (&lens.pupil, &lens.relative_illumination, &lens.focus_distance_m) {
        let problem = "\"pupil\" has no effect here: the illumination is measured and everything is sharp";
        faults.add(ErrorCode::NoEffect, &pupil.place, problem, "remove it");
    }
}

fn check_illumination(table: &RelativeIllumination, faults: &mut Faults) {
    let radii = match (&table.source, &table.ratio) {
        (IlluminationSource::File(_), None) => return,
        (IlluminationSource::File(_), Some(ratios)) => {
            let place = ratios.first().map_or(&table.place, |first| &first.place);
            faults.add(
                ErrorCode::NoEffect,
                place,
                "\"ratio\" has no effect here, it belongs to \"radius_mm\"",
                "remove it",
            );
            return;
        }
        (IlluminationSource::Radii(_), None) => {
            faults.add(
                ErrorCode::MissingKey,
                &table.place,
                "the key \"ratio\" is missing",
                "add \"ratio\", one for each radius",
            );
            return;
        }
        (IlluminationSource::Radii(radii), Some(_)) => radii,
    };
    let ratios = table.ratio.as_deref().unwrap_or_default();
    if radii.len() != ratios.len() {
        let problem = format!("{} radii and {} ratios", radii.len(), ratios.len());
        faults.add(ErrorCode::WrongCount, &table.place, problem, "give as many of one as of the other");
    }
    if let Some(pair) = radii.windows(2).find(|pair| pair[1].value <= pair[0].value) {
        let problem = format!("{} does not lie beyond {}", pair[1].value, pair[0].value);
        faults.add(ErrorCode::WrongOrder, &pair[1].place, problem, "give rising radii");
    }
    for (list, start, name) in [(&radii[..], 0.0, "radius"), (ratios, 1.0, "ratio")] {
        if let Some(first) = list.first().filter(|first| first.value != start) {
            faults.add(
                ErrorCode::OutOfRange,
                &first.place,
                format!("the first {name} is {}", first.value),
                format!("begin with {start}"),
            );
        }
    }
}
