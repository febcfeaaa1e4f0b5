//! How one capture of a frame is taken: the figures that exposure control and captures change.

/// The figures of one capture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Operation {
    /// Time of collection, s.
    pub(crate) exposure_s: f64,
    /// Factor on the mean electrons, which are those of the described exposure.
    pub(crate) light: f64,
    /// Electrons that a pixel can hold.
    pub(crate) full_well_e: f64,
    /// Digital numbers an electron, analogue gain included.
    pub(crate) gain_dn_e: f64,
    /// Standard deviation of a pixel's read noise, e⁻.
    pub(crate) read_noise_e: f64,
}
