//! Tabulated spectra, illuminants, colour matching, colour spaces, refractive indices, reflectance upsampling.
