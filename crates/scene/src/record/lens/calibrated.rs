//! A camera given by the viewing directions of its pixels.

use std::path::PathBuf;

use super::focus::{FocusDistance, focus_distance};
use super::lateral_colour::LateralColour;
use super::numbers::{f_number, fraction};
use super::projection::{CalibrationFile, Projection, TableSource};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, keyed, list, number, path, record, words};

record! {
    /// A calibrated or ideal projection with the photometry of a lens.
    pub struct CalibratedLens check(check) {
        /// Viewing directions of the pixels.
        inside view: PixelDirections;
        /// f-number: irradiance on the axis is E = π τ L/(4 N²). With "focus_distance_m" also the pupil's size.
        required f_number: Placed<f64> = f_number();
        /// Distance from the entrance pupil to the surface in focus, along the axis (flat) or ray (turning). Default: everything is sharp.
        optional focus_distance_m: FocusDistance = focus_distance();
        /// Orientation of the entrance pupil. Default: "flat" for less than 180°, otherwise "turning".
        optional pupil: Placed<Pupil> = choice();
        /// Measured relative illumination. Default: that of pupil and projection.
        optional relative_illumination: RelativeIllumination = record();
        /// Field angle beyond which the camera sees nothing. Default: the projection's end.
        optional greatest_angle_deg: Placed<f64> = number("degrees").above(0.0).at_most(180.0);
        /// Transmittance. Default: 1.
        optional transmittance: Placed<f64> = fraction();
        /// Image size by wavelength. Default: equal.
        optional lateral_colour: LateralColour = record();
    }
}

keyed! {
    /// Viewing directions of the pixels.
    pub enum PixelDirections {
        /// The projection.
        projection => Projection(Box<Projection>) = record();
        /// Calibration file of another program, for the sensor's image size.
        calibration => Calibration(Box<CalibrationFile>) = record();
    }
}

impl PixelDirections {
    /// File of a projection's table.
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
    /// Orientation of an entrance pupil to the rays.
    pub enum Pupil {
        /// A disc across the axis: foreshortened by cos θ, so light falls off as cos θ dΩ/dA; sees less than 180°.
        "flat" => Flat,
        /// Turned towards each direction, as in wide lenses: light falls off as dΩ/dA.
        "turning" => Turning,
    }
}

record! {
    /// Irradiance over that on the axis, linear between the points.
    pub struct RelativeIllumination check(check_illumination) {
        /// Source of the points.
        inside source: IlluminationSource;
        /// With "radius_mm": irradiance over that on the axis; the first is 1.
        optional ratio: Vec<Placed<f64>> = list(number("").at_least(0.0), 1);
    }
}

keyed! {
    /// Source of a relative illumination.
    pub enum IlluminationSource {
        /// Zemax "Relative Illumination" text, fields in degrees or mm, at least to the farthest corner.
        file => File(Placed<PathBuf>) = path(&["txt"]);
        /// Distances from the principal point, increasing from 0 to at least the farthest corner.
        radius_mm => Radii(Vec<Placed<f64>>) = list(number("mm").at_least(0.0), 1);
    }
}

fn check(lens: &CalibratedLens, errors: &mut DescriptionErrors) {
    if let (Some(pupil), Some(_), None) = (&lens.pupil, &lens.relative_illumination, &lens.focus_distance_m) {
        let problem = "\"pupil\" has no effect here: the relative illumination is measured, and there is no defocus";
        errors.add(ErrorCode::NoEffect, &pupil.place, problem, "remove it");
    }
}

fn check_illumination(table: &RelativeIllumination, errors: &mut DescriptionErrors) {
    let radii = match (&table.source, &table.ratio) {
        (IlluminationSource::File(_), None) => return,
        (IlluminationSource::File(_), Some(ratios)) => {
            let place = ratios.first().map_or(&table.place, |first| &first.place);
            errors.add(
                ErrorCode::NoEffect,
                place,
                "\"ratio\" has no effect here, it belongs to \"radius_mm\"",
                "remove it",
            );
            return;
        }
        (IlluminationSource::Radii(_), None) => {
            errors.add(
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
        let problem = format!("the numbers of radii ({}) and ratios ({}) differ", radii.len(), ratios.len());
        errors.add(ErrorCode::WrongCount, &table.place, problem, "give equal numbers");
    }
    if let Some(pair) = radii.windows(2).find(|pair| pair[1].value <= pair[0].value) {
        let problem = format!("{} is not above {}", pair[1].value, pair[0].value);
        errors.add(ErrorCode::WrongOrder, &pair[1].place, problem, "give increasing radii");
    }
    for (list, start, name) in [(&radii[..], 0.0, "radius"), (ratios, 1.0, "ratio")] {
        if let Some(first) = list.first().filter(|first| first.value != start) {
            errors.add(
                ErrorCode::OutOfRange,
                &first.place,
                format!("the first {name} is {}", first.value),
                format!("start with {start}"),
            );
        }
    }
}
