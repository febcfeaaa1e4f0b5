//! Errors of a lens, alone or for an image.

pub(crate) mod front;
mod prescription;

use etendue_projection::{CalibrationError, DistortionError};

use crate::ray_transfer::RayTransferError;

pub use front::FrontError;
pub use prescription::PrescriptionError;

/// An error of a lens or of a stored radiance image.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OpticsError {
    /// A length or number that must be positive.
    #[error("{name} is {value}; it must be positive and finite")]
    NotPositive {
        /// The key.
        name: &'static str,
        value: f64,
    },
    /// An f-number below the limit for a lens in air.
    #[error(
        "f_number is {value}; no lens in air is faster than f/0.5, where the light on the axis comes from the whole half space: \
         give 0.5 or more"
    )]
    Faster { value: f64 },
    /// An image mostly at the edge of the field.
    #[error(
        "the image extends {radius_mm:.6} mm from the principal point, {:.3e} focal lengths of {focal_length_mm:e} mm: nearly all of it would look \
         sideways and be black; give a longer focal length (a narrower field)",
        radius_mm / focal_length_mm
    )]
    TooWide {
        /// Distance from the axis to the image's farthest point, mm.
        radius_mm: f64,
        /// Principal distance, mm.
        focal_length_mm: f64,
    },
    /// A distortion beyond that of any real lens.
    #[error(
        "the distortion moves a point at {radius_mm:.6} mm from the principal point to {:.3e} times that distance or to no finite position; no \
         lens does this: check the coefficients and the unit of their radius",
        ratio
    )]
    WildDistortion {
        /// Distance on the sensor, mm.
        radius_mm: f64,
        /// Ideal over observed distance.
        ratio: f64,
    },
    /// A position that is not a number.
    #[error("{name} is {value}; it must be a finite number")]
    NotFinite {
        /// The key.
        name: &'static str,
        value: f64,
    },
    /// A transmittance outside its range.
    #[error("transmittance is {value}; it must be above 0 and at most 1")]
    Transmittance { value: f64 },
    /// No real image is formed.
    #[error(
        "a focus distance of {focus_m} m gives no real image: it must be more than {least_m} m from the entrance pupil"
    )]
    FocusTooNear {
        /// The focus distance, m.
        focus_m: f64,
        /// The distance whose image lies at infinity, m.
        least_m: f64,
    },
    /// Two contradictory statements about the pupils.
    #[error(
        "{first} = {first_value} means {second} = {expected}, because both pupils are images of one stop; {second} = \
         {second_value} contradicts it: give one of them"
    )]
    Pupils {
        /// The key taken first.
        first: &'static str,
        first_value: f64,
        /// The key that contradicts it.
        second: &'static str,
        /// The value given.
        second_value: f64,
        /// The value that follows from the first.
        expected: f64,
    },
    /// A pupil beyond the focal point.
    #[error(
        "{name} = {value} means a pupil magnification of {magnification}: it must be positive and finite (a pupil at or \
         beyond a focal point, a telecentric or hypercentric lens, is not modelled)"
    )]
    PupilBeyondFocus {
        /// The key.
        name: &'static str,
        value: f64,
        /// The resulting pupil magnification.
        magnification: f64,
    },
    /// An aperture that clips the bundle on the axis and so acts as the stop in place of the f-number.
    #[error(
        "{rim} has a radius of {radius_mm} mm, but the axial bundle of this f-number needs {needed_mm:.6} mm there: this aperture would be the \
         stop; enlarge it or raise f_number"
    )]
    RimIsStop {
        /// Name of the aperture.
        rim: &'static str,
        radius_mm: f64,
        /// The radius of the bundle on the axis, mm.
        needed_mm: f64,
    },
    /// An aperture that is not between the plane in focus and the sensor.
    #[error("{rim} at {position_mm} mm is beyond the {plane}, which is at {plane_mm:.6} mm")]
    RimMisplaced {
        /// Name of the aperture.
        rim: &'static str,
        /// Its position on the axis, mm.
        position_mm: f64,
        /// The plane that it lies beyond.
        plane: &'static str,
        /// That plane's position on the axis, mm.
        plane_mm: f64,
    },
    /// An invalid prescription.
    #[error(transparent)]
    Prescription(#[from] PrescriptionError),
    /// Invalid ray-transfer functions.
    #[error(transparent)]
    RayTransfer(#[from] RayTransferError),
    /// A filter with an invalid effective index.
    #[error("effective_index is {value}; an interference filter's is above 1 (1.5 to 2.2)")]
    FilterIndex { value: f64 },
    /// A filter transmittance outside 0 to 1.
    #[error("the filter's transmittance is {value} at some wavelength; it must stay within 0 and 1")]
    FilterTransmittance { value: f64 },
    /// A distortion for a lens that has its own.
    #[error(
        "prescriptions, ray-transfer functions, calibrated and telecentric cameras have their own distortion: remove that of the lens"
    )]
    OwnDistortion,
    /// A lateral colour for a lens that does not accept one.
    #[error(
        "a {kind} accepts no \"lateral_colour\": a prescription's glasses already determine it, a telecentric camera has none; remove it"
    )]
    OwnColour {
        /// Kind of the lens.
        kind: &'static str,
    },
    /// An invalid lateral colour.
    #[error("a lateral colour is a list of two or more increasing wavelengths (nm) and of magnifications above 0")]
    LateralColour,
    /// An invalid calibration.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// A calibration for another image size.
    #[error(
        "the sensor has {got_width} × {got_height} pixels but the calibration is of {width} × {height}: give the sensor the calibration's size, or \
         give a calibration of this image size"
    )]
    CalibratedSize {
        /// The sensor's width.
        got_width: usize,
        /// The sensor's height.
        got_height: usize,
        /// The calibration's width.
        width: usize,
        /// The calibration's height.
        height: usize,
    },
    /// A calibration without a direction at its own principal point.
    #[error(
        "the calibration has no ray at its principal point ({x}, {y}) px, where the focal length is computed: correct the calibration"
    )]
    BlindCentre {
        /// cx, px.
        x: f64,
        /// cy, px.
        y: f64,
    },
    /// An invalid relative illumination.
    #[error(
        "a relative illumination is a list of increasing radii or angles from 0 and of ratios of at least 0 that begin with 1"
    )]
    Falloff,
    /// A relative illumination that ends inside the image.
    #[error(
        "the relative illumination is given up to {end}{unit}, but the image extends to {needed:.4}{unit}: extend it"
    )]
    FalloffEnds {
        /// End of the table.
        end: f64,
        /// Extent of the image.
        needed: f64,
        /// Unit of both, and their origin.
        unit: &'static str,
    },
    /// A sensor reflectance outside 0 to 1.
    #[error("the sensor's reflectance is {value}; it must be at least 0 and below 1")]
    SensorReflectance { value: f64 },
    /// Invalid optics in front of the lens.
    #[error(transparent)]
    Front(#[from] FrontError),
    /// Front optics that cannot be applied to stored radiance.
    #[error(
        "route = \"pupil\" does not support a camera with a {what} in front of its lens: render it with route = \"lens\""
    )]
    FrontNeedsLens {
        /// Kind of the front optics.
        what: &'static str,
    },
    /// A lens unsuitable for the at-the-pupil route.
    #[error(
        "route = \"pupil\" needs one known viewpoint, which a {kind} does not have: render it with route = \"lens\""
    )]
    NoPupilRoute {
        /// Kind of the lens.
        kind: &'static str,
    },
    /// A distortion that does not cover the image.
    #[error(transparent)]
    Distortion(#[from] DistortionError),
    /// A stored radiance image without all directions that an image needs.
    #[error(
        "the stored radiance image lacks directions that the image needs: {:.4}° beyond its {edge} edge; render it with more overscan or use a \
         narrower lens or a smaller sensor",
        missing_rad.to_degrees()
    )]
    MissingDirections {
        /// The edge with the largest gap.
        edge: &'static str,
        /// Angle by which the image reaches beyond the edge, rad.
        missing_rad: f64,
    },
    /// Distances of a blend in the wrong order.
    #[error(
        "fully blurred up to {blurred_near_m} m, sharp from {sharp_near_m} m to {sharp_far_m} m, fully blurred from {blurred_far_m} m on: these \
         distances must increase"
    )]
    SharpRange {
        /// Fully blurred from here to the camera, m.
        blurred_near_m: f64,
        /// Sharp from here, m.
        sharp_near_m: f64,
        /// Sharp to here, m.
        sharp_far_m: f64,
        /// Fully blurred from here on, m.
        blurred_far_m: f64,
    },
    /// Radiance that is not a finite number.
    #[error(
        "the radiance at column {x}, row {y} is not a finite number: depth of field would spread it; render the image again"
    )]
    RadianceNotFinite {
        /// Column.
        x: usize,
        /// Row.
        y: usize,
    },
    /// A stored radiance image lacks a whole view that an image needs.
    #[error(
        "the stored radiance image lacks its {view} view, which the image needs; render it with a lens that sees it, or use a narrower lens"
    )]
    MissingView {
        /// Name of the view.
        view: &'static str,
    },
    /// A stored radiance image without views, or with empty ones.
    #[error("a stored radiance image needs at least one view, and pixels in each")]
    NoViews,
    /// An image without a single ray.
    #[error("no pixel of the image has a ray: the lens sees nothing there")]
    SeesNothing,
    /// A cube whose size is not that of its stated geometry.
    #[error(
        "the image has {got_width} × {got_height} pixels but its stated geometry has {width} × {height}: give the image as it was rendered"
    )]
    Size {
        /// Columns found.
        got_width: usize,
        /// Rows found.
        got_height: usize,
        /// Columns stated.
        width: usize,
        /// Rows stated.
        height: usize,
    },
}
