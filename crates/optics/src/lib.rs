//! Lenses, pupil sampling and image-space lens operators: radiance in, irradiance on the sensor plane out.
