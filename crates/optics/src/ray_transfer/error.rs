//! Errors of ray-transfer functions.

/// Ray-transfer functions that do not form a lens, or cannot be focused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RayTransferError {
    /// A polynomial with an invalid number.
    #[error("a polynomial has a coefficient that is not finite, or a power above 32")]
    Polynomial,
    /// An invalid region.
    #[error("the rays that pass are given by ellipses at heights that rise from 0, or by circles of radii above 0")]
    Pass,
    /// Wavelengths that do not rise.
    #[error("ray-transfer functions are of one or more rising wavelengths above 0 nm")]
    Wavelengths,
    /// A sensor behind the input plane.
    #[error(
        "the sensor stands {sensor_mm} mm behind the last surface, within the plane at {plane_mm} mm from which the file knows rays: \
         give a larger distance"
    )]
    SensorTooNear {
        /// Position of the sensor, mm.
        sensor_mm: f64,
        /// Position of the input plane, mm.
        plane_mm: f64,
    },
    /// A sensor at or behind the plane of the ray-pass function.
    #[error(
        "the plane on which the file says which rays pass lies at or behind a sensor {sensor_mm} mm behind the last surface: give a larger distance, or \
         correct \"intersectPlaneDistance\""
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
        "no place of the sensor makes {focus_m} m sharp: from {low_mm:.4} mm to {high_mm:.4} mm behind the last surface the lens is focused beyond \
         infinity or nearer than that; give \"sensor_distance_mm\", or a distance that the lens images"
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
        "rays along the axis are not bent towards it: these functions are of no lens that makes a real image from the film to the scene"
    )]
    Powerless,
}
