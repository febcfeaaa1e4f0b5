//! Errors of ray-transfer functions.

/// Ray-transfer functions that do not form a lens, or cannot be focused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RayTransferError {
    /// A polynomial with an invalid number.
    #[error("a polynomial has a coefficient that is not finite, or a power above 32: correct it")]
    Polynomial,
    /// An invalid region.
    #[error(
        "transmitted rays must be given by ellipses at heights that increase from 0, or by circles of radii above 0"
    )]
    Pass,
    /// Wavelengths that do not increase.
    #[error("ray-transfer functions need one or more increasing wavelengths above 0 nm")]
    Wavelengths,
    /// A sensor behind the input plane.
    #[error(
        "the sensor is {sensor_mm} mm behind the last surface, closer than the plane at {plane_mm} mm from which the file describes rays: give a \
         larger distance"
    )]
    SensorTooNear {
        /// Position of the sensor, mm.
        sensor_mm: f64,
        /// Position of the input plane, mm.
        plane_mm: f64,
    },
    /// A sensor at or behind the plane of the ray-pass function.
    #[error(
        "the plane on which the file states which rays pass is at or behind the sensor, {sensor_mm} mm behind the last surface: give a larger \
         distance, or correct \"intersectPlaneDistance\""
    )]
    PassPlane {
        /// Position of the sensor, mm.
        sensor_mm: f64,
    },
    /// A dark sensor centre.
    #[error(
        "no light reaches the middle of the sensor {sensor_mm:.4} mm behind the last surface: check the distance, and which rays pass"
    )]
    Dark {
        /// Position of the sensor, mm.
        sensor_mm: f64,
    },
    /// A distance that is not sharp at any sensor position.
    #[error(
        "no sensor position focuses the lens at {focus_m} m: from {low_mm:.4} mm to {high_mm:.4} mm behind the last surface it is focused beyond \
         infinity or nearer than that; give \"sensor_distance_mm\", or a distance at which the lens can focus"
    )]
    Focus {
        /// The distance, m.
        focus_m: f64,
        /// The smallest distance tried, mm.
        low_mm: f64,
        /// The largest distance tried, mm.
        high_mm: f64,
    },
    /// A lens without refractive power.
    #[error(
        "rays along the axis are not bent towards it: these functions do not describe a lens that forms a real image; expected functions from the \
         film to the scene"
    )]
    Powerless,
}
