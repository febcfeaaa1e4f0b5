//! `[lens]`: from the scene to the sensor plane.

pub mod calibrated;
pub mod prescription;
pub mod projection;

use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{Number, Rule, choice, either, list, number, record, variant, variants};
pub use calibrated::Calibrated;
pub use prescription::Prescription;

variants! {
    /// A lens.
    pub enum Lens by "type" {
        /// A pupil so small that everything is sharp; "f_number" sets how much light comes through.
        "pinhole" => Pinhole(Pinhole),
        /// An ideal lens of no thickness.
        "thin" => Thin(Thin),
        /// A paraxial lens with two principal planes, two pupils and two rims that vignette.
        "thick" => Thick(Box<Thick>),
        /// A lens of surfaces and glasses, traced: aberrations, colours, vignetting as they are.
        "prescription" => Prescription(Box<Prescription>),
        /// A calibrated or ideal projection: each pixel looks where the calibration says.
        "calibrated" => Calibrated(Box<Calibrated>),
        /// Telecentric rays along the axis, as from an object-side telecentric lens; everything is sharp.
        "telecentric" => Telecentric(Telecentric),
    }
}

record! {
    /// A pinhole.
    pub struct Pinhole {
        /// Distance of the pinhole from the sensor, mm, above 0.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length divided by the pinhole's diameter, 0.5 or more: how much light comes through.
        required f_number: Placed<f64> = f_number();
        /// Share of light that the lens lets through, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
        /// Distortion. Default: none.
        optional distortion: Distortion = record();
        /// Image size by wavelength. Default: all colours alike.
        optional lateral_colour: LateralColour = record();
    }
}

record! {
    /// A thin lens.
    pub struct Thin {
        /// Focal length, mm, above 0.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length divided by the pupil's diameter, 0.5 or more.
        required f_number: Placed<f64> = f_number();
        /// Distance of the plane in focus from the entrance pupil, m, beyond the focal length, or "infinity".
        required focus_distance_m: FocusDistance = focus_distance();
        /// Share of light that the lens lets through, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
        /// Distortion. Default: none.
        optional distortion: Distortion = record();
        /// Image size by wavelength. Default: all colours alike.
        optional lateral_colour: LateralColour = record();
    }
}

record! {
    /// A thick lens. Positions are along the axis towards the sensor, from the front principal plane.
    pub struct Thick {
        /// Focal length, mm, above 0.
        required focal_length_mm: Placed<f64> = focal_length();
        /// Focal length divided by the entrance pupil's diameter, 0.5 or more.
        required f_number: Placed<f64> = f_number();
        /// Distance of the plane in focus from the entrance pupil, m, beyond the focal length, or "infinity".
        required focus_distance_m: FocusDistance = focus_distance();
        /// Share of light that the lens lets through, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
        /// Distortion. Default: none.
        optional distortion: Distortion = record();
        /// Image size by wavelength. Default: all colours alike.
        optional lateral_colour: LateralColour = record();
        /// The rear principal plane, from the front principal plane, mm; may be negative. Default: 0.
        optional principal_separation_mm: Placed<f64> = number("mm");
        /// The entrance pupil, from the front principal plane, mm; negative lies towards the scene. One statement about
        /// the pupils fixes the others; more than one must agree. Default: the pupils lie in the principal planes.
        optional entrance_pupil_mm: Placed<f64> = number("mm");
        /// The exit pupil, from the front principal plane, mm. See "entrance_pupil_mm".
        optional exit_pupil_mm: Placed<f64> = number("mm");
        /// Diameter of the exit pupil by that of the entrance pupil, above 0. See "entrance_pupil_mm".
        optional pupil_magnification: Placed<f64> = number("").above(0.0);
        /// Which pupil keeps its area over the field.
        required constant_pupil: Placed<Pupil> = choice();
        /// The rim in front of the pupil. Default: none.
        optional front_aperture: Rim = record();
        /// The rim behind the pupil. Default: none.
        optional rear_aperture: Rim = record();
    }
}

record! {
    /// A parallel (orthographic) camera.
    pub struct Telecentric {
        /// Width of what is seen, m, above 0: the picture's width in the scene.
        required field_width_m: Placed<f64> = number("m").above(0.0);
        /// f-number on the sensor's side, 0.5 or more: how much light comes through.
        required f_number: Placed<f64> = f_number();
        /// Share of light that the lens lets through, above 0 and at most 1. Default: 1.
        optional transmittance: Placed<f64> = share();
    }
}

choice! {
    /// One of the two pupils of a lens.
    pub enum Pupil {
        /// The pupil as seen from the scene.
        "entrance" => Entrance,
        /// The pupil as seen from the sensor.
        "exit" => Exit,
    }
}

record! {
    /// A round rim that stops light.
    pub struct Rim {
        /// Position along the axis, from the front principal plane, mm.
        required position_mm: Placed<f64> = number("mm");
        /// Radius, mm, above 0.
        required radius_mm: Placed<f64> = number("mm").above(0.0);
    }
}

/// Where a lens is focused.
#[derive(Clone, Debug)]
pub enum FocusDistance {
    /// At a distance, m.
    Metres(Placed<f64>),
    /// At infinity.
    Infinity,
}

choice! {
    /// The word for a distance without end.
    pub enum Endless {
        /// Infinitely far.
        "infinity" => Infinity,
    }
}

record! {
    /// Radial distortion r′ = r·(1 + k1·r² + k2·r⁴) about the principal point.
    pub struct Distortion {
        /// Coefficient of r².
        required k1: Placed<f64> = number("");
        /// Coefficient of r⁴. Default: 0.
        optional k2: Placed<f64> = number("");
        /// Whether r is the radius of the ideal picture and r′ the observed one, or the other way round.
        required direction: Placed<Direction> = choice();
        /// The unit of r and r′.
        required radius_unit: Placed<RadiusUnit> = choice();
    }
}

record! {
    /// Lateral colour: the image's size about the principal point, by wavelength. Linear between the points, the end values
    /// hold beyond them.
    pub struct LateralColour check(check_colour) {
        /// Wavelengths, nm, rising; two or more.
        required wavelength_nm: Vec<Placed<f64>> = list(number("nm").above(0.0), 1);
        /// Image size over that at 587.56 nm (only ratios count), above 0; a good lens keeps within 0.999 and 1.001.
        required magnification: Vec<Placed<f64>> = list(number("").above(0.0), 1);
    }
}

fn check_colour(table: &LateralColour, faults: &mut Faults) {
    let (wavelengths, sizes) = (&table.wavelength_nm, &table.magnification);
    if wavelengths.len() != sizes.len() {
        let problem = format!("{} wavelengths and {} magnifications", wavelengths.len(), sizes.len());
        faults.add(&table.place, problem, "give as many of one as of the other");
    }
    if let Some(pair) = wavelengths.windows(2).find(|pair| pair[1].value <= pair[0].value) {
        let problem = format!("{} does not lie beyond {}", pair[1].value, pair[0].value);
        faults.add(&pair[1].place, problem, "give rising wavelengths");
    }
}

choice! {
    /// Which way a distortion polynomial maps.
    pub enum Direction {
        /// From the undistorted picture to the distorted one (OpenCV).
        "ideal_to_observed" => IdealToObserved,
        /// From the distorted picture to the undistorted one.
        "observed_to_ideal" => ObservedToIdeal,
    }
}

choice! {
    /// The unit of a radius on the sensor.
    pub enum RadiusUnit {
        /// Millimetres.
        "mm" => Millimetres,
        /// Focal lengths (OpenCV).
        "focal_lengths" => FocalLengths,
        /// Half the diagonal of the picture.
        "half_diagonals" => HalfDiagonals,
        /// Pixels.
        "pixels" => Pixels,
    }
}

fn focal_length() -> Number {
    number("mm").above(0.0)
}

/// No lens in air is faster than f/0.5: its cone fills the half space.
fn f_number() -> Number {
    number("").at_least(0.5)
}

fn share() -> Number {
    number("").above(0.0).at_most(1.0)
}

fn focus_distance() -> impl Rule<Out = FocusDistance> {
    let metres = variant!(number("m").above(0.0), FocusDistance::Metres);
    either(metres, variant!(choice::<Endless>(), Endless::Infinity == FocusDistance::Infinity))
}
