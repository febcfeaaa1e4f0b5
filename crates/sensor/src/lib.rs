//! Irradiance to electrons to digital numbers, every noise with a cause.
