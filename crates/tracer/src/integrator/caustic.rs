//! Caustics of lamps: light that a smooth surface throws on a matt one, or a mirror on what blurs what it mirrors.
//!
//! Seen from the camera: a path scatters at a matt surface, then at a smooth one, and then meets a sun or a glowing
//! surface; or it scatters at a glossy surface (a wet road), then at one that is much smoother (car paint). Unidirectional paths find such light only by chance, in a few very bright samples. Where a caller leaves it
//! out ([`super::PathSettings::caustics`]), the picture is darker by exactly that light: light of suns and glowing
//! surfaces that arrives by a scattering of more than [`SMOOTH_PER_SR`] after one of less, or by one of more than [`SHARPER`] times
//! the density of one before it. What smooth surfaces reflect
//! of the surroundings is kept. In fog the light of a sun comes from a bright patch about it, which is found as seldom; without caustics light
//! that a medium's forward peak scatters counts as not scattered, behind the first matt surface and the first scattering in a medium (`crate::media`). The rule looks at densities alone, so both ways of finding light obey it alike.

/// Density of scattering, 1/sr, above which a surface counts as smooth: that of the highlight of a GGX surface of α ≈ 0.14.
const SMOOTH_PER_SR: f32 = 4.0;

/// How many times as dense a scattering is whose light of lamps a glossy surface before it finds by luck alone: that of an eighth to a quarter of its α.
const SHARPER: f32 = 16.0;

/// What a path has scattered at so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct History {
    matt: bool,
    caustic: bool,
    /// The least density of any scattering, 1/sr; infinite where all were mirrors.
    least: f32,
}

impl Default for History {
    fn default() -> Self {
        Self { matt: false, caustic: false, least: f32::INFINITY }
    }
}

impl History {
    /// Notes a scattering of density `pdf`, 1/sr; `None` for a mirror.
    pub(super) fn scatter(&mut self, pdf: Option<f32>) {
        let density = pdf.unwrap_or(f32::INFINITY);
        self.caustic = self.would_be_caustic(density);
        self.matt |= !is_smooth(density);
        self.least = self.least.min(density);
    }

    /// The least density of any scattering so far, 1/sr; infinite where all were mirrors.
    pub(super) fn least_density(self) -> f32 {
        self.least
    }

    /// Whether the path comes straight from the camera, or by mirrors alone.
    pub(super) fn is_seen(self) -> bool {
        self.least == f32::INFINITY
    }

    /// Whether the path has been scattered by anything but smooth surfaces.
    pub(super) fn is_matt(self) -> bool {
        self.matt
    }

    /// Whether it has, once it goes on by a scattering of density `pdf`, 1/sr.
    pub(super) fn would_be_matt(self, pdf: f32) -> bool {
        self.matt || !is_smooth(pdf)
    }

    /// Whether light of a lamp that is met now is part of a caustic.
    pub(super) fn is_caustic(self) -> bool {
        self.caustic
    }

    /// Whether light of a lamp would be part of a caustic if it arrived by a scattering of density `pdf`, 1/sr.
    pub(super) fn would_be_caustic(self, pdf: f32) -> bool {
        is_smooth(pdf) && (self.matt || pdf > SHARPER * self.least)
    }
}

fn is_smooth(pdf: f32) -> bool {
    pdf > SMOOTH_PER_SR
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caustic_is_smooth_after_matt() {
        let after = |events: &[Option<f32>]| {
            let mut history = History::default();
            events.iter().for_each(|pdf| history.scatter(*pdf));
            history.is_caustic()
        };
        assert!(!after(&[]) && !after(&[None]) && !after(&[Some(0.3)]) && !after(&[Some(50.0), Some(0.3)]));
        assert!(after(&[Some(0.3), None]) && after(&[Some(0.3), Some(50.0)]) && after(&[Some(0.3), None, None]));
        let mut matt = History::default();
        matt.scatter(Some(0.3));
        assert!(matt.would_be_caustic(50.0) && !matt.would_be_caustic(0.3));
        assert!(!History::default().would_be_caustic(50.0));
        assert!(!after(&[Some(20.0), Some(300.0)]) && after(&[Some(20.0), Some(330.0)]) && after(&[Some(20.0), None]));
        // Scattering in a medium is told as of no density.
        assert!(!after(&[Some(0.0), Some(0.3)]) && after(&[Some(0.0), Some(5.0)]));
        assert!(!after(&[Some(5000.0), Some(20.0)]) && !after(&[None, None]) && !after(&[None, Some(20.0)]));
    }
}
