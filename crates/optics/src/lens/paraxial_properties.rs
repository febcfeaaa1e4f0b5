//! Properties common to paraxial lenses: a transmittance, and optionally a radial distortion and lateral colour.
//!
//! Statements about the pupils of a thick lens.
//!
//! Both pupils are images of one stop, so each is the image of the other and one statement determines all (`thick.rs`).
//!
//! First-order focusing: the sensor position, and the blur of a point out of focus.
//!
//! With focal length f, pupil magnification m_p (exit over entrance diameter) and the plane in focus at F from the **entrance pupil**, the image's
//! magnification is |m| = 1/(F/f − 1/m_p). The principal distance, the factor from tangents in object space to lengths on the sensor, is c = f (1 +
//! |m|/m_p). The exit pupil is at m_p c from the sensor. For pupils in the principal planes m_p = 1 and these are the lens equation.
//!
//! Lateral colour: variation of the image size with the wavelength.
//!
//! At the wavelength λ the image is m(λ) times as large as at 587.56 nm, about the principal point: the light of λ at a sensor point s comes from the
//! direction that 587.56 nm has at s/m(λ), before any distortion. m is interpolated linearly between the points of the table and clamped beyond; only
//! ratios matter, so the table is divided by its value at 587.56 nm. Weights stay those of the sensor point itself. Typical lenses keep |m − 1| below
//! 0.002. Left out: displacements that are not proportional to the distance from the axis (a prescription has its own).

use core::fmt::{self, Debug, Formatter};
use std::sync::Arc;

use etendue_projection::RadialDistortion;
use glam::DVec2;

use crate::overlap::{PRINCIPAL_NM, finite, positive};
use crate::{error::OpticsError, pupil::MM};

/// Transmittance, distortion and lateral colour of a lens.
#[derive(Clone, PartialEq)]
pub(crate) struct ParaxialProperties {
    /// Transmittance τ, the same at every wavelength.
    pub(crate) transmittance: f64,
    /// Radial distortion; `None` for a rectilinear lens.
    pub(crate) distortion: Option<RadialDistortion>,
    /// Image size by wavelength; `None` if it is the same at all wavelengths.
    pub(crate) lateral_colour: Option<Arc<LateralColour>>,
}

/// A lens without lateral colour omits the field.
impl Debug for ParaxialProperties {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("ParaxialProperties");
        text.field("transmittance", &self.transmittance).field("distortion", &self.distortion);
        if let Some(colour) = &self.lateral_colour {
            text.field("lateral_colour", colour);
        }
        text.finish()
    }
}

impl ParaxialProperties {
    pub(crate) fn new(transmittance: f64) -> Result<Self, OpticsError> {
        if transmittance > 0.0 && transmittance <= 1.0 {
            Ok(Self { transmittance, distortion: None, lateral_colour: None })
        } else {
            Err(OpticsError::Transmittance { value: transmittance })
        }
    }

    /// The ideal point of an observed one, mm, at 587.56 nm.
    pub(crate) fn ideal(&self, observed_mm: DVec2) -> Option<DVec2> {
        self.distortion.map_or(Some(observed_mm), |d| d.ideal(observed_mm))
    }

    /// The ideal point of an observed one, mm, at a wavelength.
    pub(crate) fn ideal_at(&self, observed_mm: DVec2, nm: f64) -> Option<DVec2> {
        self.ideal(self.lateral_colour.as_ref().map_or(observed_mm, |colour| observed_mm / colour.at(nm)))
    }

    /// The observed point of an ideal one, mm.
    pub(crate) fn observed(&self, ideal_mm: DVec2) -> Option<DVec2> {
        self.distortion.map_or(Some(ideal_mm), |d| d.observed(ideal_mm))
    }

    /// Ideal area for one unit of observed area at an observed point.
    pub(crate) fn ideal_area_per_observed(&self, observed_mm: DVec2) -> Option<f64> {
        self.distortion.map_or(Some(1.0), |d| d.ideal_area_per_observed(observed_mm.length()))
    }
}

/// Statements about the pupils: none (pupils in the principal planes), one, or several that agree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PupilParameters {
    /// Position of the entrance pupil, mm.
    pub entrance_pupil_mm: Option<f64>,
    /// Position of the exit pupil, mm.
    pub exit_pupil_mm: Option<f64>,
    /// Exit over entrance diameter.
    pub pupil_magnification: Option<f64>,
}

/// Maximum relative difference between two statements of the pupil magnification.
const PUPIL_AGREEMENT: f64 = 1e-6;

impl PupilParameters {
    /// The pupil magnification given by the statements; 1 if there is none.
    pub(super) fn magnification(&self, focal_mm: f64, separation_mm: f64) -> Result<f64, OpticsError> {
        let position = |m: f64| separation_mm + focal_mm * (1.0 - m);
        let entrance = self.entrance_pupil_mm.map(|p| ("entrance_pupil_mm", p, focal_mm / (focal_mm + p)));
        let exit = self.exit_pupil_mm.map(|q| ("exit_pupil_mm", q, 1.0 - (q - separation_mm) / focal_mm));
        let ratio = self.pupil_magnification.map(|m| ("pupil_magnification", m, m));
        let mut stated = [entrance, exit, ratio].into_iter().flatten();
        let Some((first, first_value, m)) = stated.next() else { return Ok(1.0) };
        positive_magnification(first, first_value, m)?;
        for (second, second_value, other) in stated {
            positive_magnification(second, second_value, other)?;
            if (other / m - 1.0).abs() > PUPIL_AGREEMENT {
                let expected = if second == "exit_pupil_mm" { position(m) } else { m };
                return Err(OpticsError::Pupils { first, first_value, second, second_value, expected });
            }
        }
        Ok(m)
    }
}

fn positive_magnification(name: &'static str, value: f64, magnification: f64) -> Result<(), OpticsError> {
    finite(name, value)?;
    if magnification.is_finite() && magnification > 0.0 {
        return Ok(());
    }
    Err(OpticsError::PupilBeyondFocus { name, value, magnification })
}

/// Plane in focus and sensor plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Conjugates {
    /// Image size over object size, positive; 0 at infinity focus.
    pub(crate) magnification: f64,
    /// c, mm.
    pub(crate) principal_distance_mm: f64,
    /// Inverse distance of the plane in focus from the entrance pupil, 1/mm; 0 at infinity.
    pub(crate) inverse_focus_per_mm: f64,
}

impl Conjugates {
    pub(crate) fn new(focal_mm: f64, pupil_magnification: f64, focus_m: f64) -> Result<Self, OpticsError> {
        let inverse_focus_per_mm = MM / focus_m;
        let min_mm = focal_mm / pupil_magnification;
        // Written with the inverse so that infinity needs no special case: |m| = f/F / (1 − f/(m_p F)).
        let room = 1.0 - min_mm * inverse_focus_per_mm;
        if focus_m.is_nan() || focus_m <= 0.0 || room <= 0.0 {
            return Err(OpticsError::FocusTooNear { focus_m, least_m: min_mm * MM });
        }
        let magnification = focal_mm * inverse_focus_per_mm / room;
        let principal_distance_mm = focal_mm * (1.0 + magnification / pupil_magnification);
        Ok(Self { magnification, principal_distance_mm, inverse_focus_per_mm })
    }

    /// Diameter (mm on the sensor, on the axis) of the blur of a point at depth `depth_m` through an entrance pupil:
    /// 2 a c |1/z − 1/F|.
    pub(crate) fn circle_of_confusion_mm(&self, entrance_radius_mm: f64, depth_m: f64) -> f64 {
        2.0 * entrance_radius_mm * self.principal_distance_mm * (MM / depth_m - self.inverse_focus_per_mm).abs()
    }
}

/// The entrance pupil of an f-number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PupilSize {
    /// Radius f/2N, mm.
    pub(crate) entrance_radius_mm: f64,
}

impl PupilSize {
    pub(crate) fn new(focal_length_mm: f64, f_number: f64) -> Result<Self, OpticsError> {
        let focal_mm = positive("focal_length_mm", focal_length_mm)?;
        Ok(Self { entrance_radius_mm: focal_mm / (2.0 * crate::overlap::f_number(f_number)?) })
    }

    /// The focus distance at which a point at infinity blurs to `circle_mm`, m from the entrance pupil:
    /// f (2a/C + 1/m_p); everything from about half of it to infinity blurs less.
    pub(crate) fn hyperfocal_m(&self, focal_mm: f64, pupil_magnification: f64, circle_mm: f64) -> f64 {
        focal_mm * (2.0 * self.entrance_radius_mm / circle_mm + 1.0 / pupil_magnification) * MM
    }
}

/// The argument of a relative illumination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FalloffArgument {
    /// The distance from the principal point, mm.
    Radius,
    /// The angle from the axis in front of the lens, degrees.
    Angle,
}

impl FalloffArgument {
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Radius => " mm from the principal point",
            Self::Angle => "° from the axis",
        }
    }
}

/// A table of relative illumination: linear interpolation, the end value beyond.
#[derive(Clone, PartialEq)]
pub struct Falloff {
    argument: FalloffArgument,
    points: Vec<(f64, f64)>,
}

/// A table by radius keeps the text (and plans keep the hashes) of versions without other arguments.
impl Debug for Falloff {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Falloff");
        if self.argument != FalloffArgument::Radius {
            text.field("by", &self.argument);
        }
        text.field("points", &self.points).finish()
    }
}

impl Falloff {
    /// Creates the table of distances (mm, increasing from 0) and ratios (0 or more, from 1).
    ///
    /// # Errors
    /// If the points violate this.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, OpticsError> {
        Self::over(FalloffArgument::Radius, points)
    }

    /// Creates the table of distances (mm) or angles (degrees), increasing from 0, and ratios (0 or more, from 1).
    ///
    /// # Errors
    /// If the points violate this.
    pub fn over(by: FalloffArgument, points: Vec<(f64, f64)>) -> Result<Self, OpticsError> {
        let rising = points.windows(2).all(|pair| pair[1].0 > pair[0].0);
        let legal = points.iter().all(|(r, ratio)| r.is_finite() && ratio.is_finite() && *ratio >= 0.0);
        if points.first() == Some(&(0.0, 1.0)) && rising && legal {
            Ok(Self { argument: by, points })
        } else {
            Err(OpticsError::Falloff)
        }
    }

    /// The argument of the table.
    #[must_use]
    pub fn by(&self) -> FalloffArgument {
        self.argument
    }

    /// Refuses an image that reaches beyond the table.
    pub(super) fn check(&self, needed: f64) -> Result<(), OpticsError> {
        let end = self.points.last().map_or(0.0, |(r, _)| *r);
        if end >= needed { Ok(()) } else { Err(OpticsError::FalloffEnds { end, needed, unit: self.argument.unit() }) }
    }

    /// The ratio at a distance (mm) or an angle (degrees).
    #[must_use]
    pub fn at(&self, field: f64) -> f64 {
        let after = self.points.partition_point(|(r, _)| *r <= field);
        match (self.points.get(after.wrapping_sub(1)), self.points.get(after)) {
            (Some((r0, a)), Some((r1, b))) => a + (b - a) * (field - r0) / (r1 - r0),
            (Some((_, end)), None) => *end,
            (None, _) => 1.0,
        }
    }
}

/// Image size by wavelength over that at 587.56 nm.
#[derive(Clone, Debug, PartialEq)]
pub struct LateralColour {
    points: Vec<(f64, f64)>,
}

impl LateralColour {
    /// Creates the table of wavelengths (nm, increasing) and magnifications (above 0).
    ///
    /// # Errors
    /// If the points violate this or are fewer than two.
    pub fn new(mut points: Vec<(f64, f64)>) -> Result<Self, OpticsError> {
        let rising = points.windows(2).all(|pair| pair[1].0 > pair[0].0);
        let legal = points.iter().all(|(nm, m)| nm.is_finite() && m.is_finite() && *nm > 0.0 && *m > 0.0);
        if points.len() < 2 || !rising || !legal {
            return Err(OpticsError::LateralColour);
        }
        let principal = interpolated(&points, PRINCIPAL_NM);
        points.iter_mut().for_each(|(_, m)| *m /= principal);
        Ok(Self { points })
    }

    /// The magnification at a wavelength; 1 at 587.56 nm.
    #[must_use]
    pub fn at(&self, nm: f64) -> f64 {
        if nm == PRINCIPAL_NM { 1.0 } else { interpolated(&self.points, nm) }
    }
}

fn interpolated(points: &[(f64, f64)], nm: f64) -> f64 {
    let after = points.partition_point(|(at, _)| *at <= nm);
    match (points.get(after.wrapping_sub(1)), points.get(after)) {
        (Some((a, m)), Some((b, n))) => m + (n - m) * (nm - a) / (b - a),
        (Some((_, m)), None) | (None, Some((_, m))) => *m,
        (None, None) => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_linear_between_its_points_and_refuses_what_is_no_table() {
        let table = Falloff::new(vec![(0.0, 1.0), (2.0, 0.5), (4.0, 0.4)]).expect("a table");
        for (r, ratio) in [(0.0, 1.0), (1.0, 0.75), (2.0, 0.5), (3.0, 0.45), (4.0, 0.4), (9.0, 0.4)] {
            assert!((table.at(r) - ratio).abs() < 1e-15, "{r}");
        }
        assert!(table.check(4.0).is_ok() && table.check(4.1).is_err());
        for wrong in [vec![], vec![(0.0, 0.9)], vec![(0.0, 1.0), (0.0, 0.5)], vec![(0.0, 1.0), (1.0, -0.1)]] {
            assert!(Falloff::new(wrong).is_err());
        }
    }

    #[test]
    fn it_is_linear_between_its_points_and_one_at_the_d_line() {
        let table = LateralColour::new(vec![(450.0, 1.002), (550.0, 1.001), (650.0, 0.999)]).expect("a table");
        let d = 1.001 - 0.002 * (PRINCIPAL_NM - 550.0) / 100.0;
        for (nm, m) in [(300.0, 1.002), (450.0, 1.002), (500.0, 1.0015), (600.0, 1.0), (650.0, 0.999), (900.0, 0.999)] {
            assert!((table.at(nm) - m / d).abs() < 1e-15, "{nm}");
        }
        assert_eq!(table.at(PRINCIPAL_NM), 1.0);
        let wrong = [vec![], vec![(500.0, 1.0)], vec![(500.0, 1.0), (500.0, 1.1)], vec![(500.0, 1.0), (600.0, 0.0)]];
        assert!(wrong.into_iter().all(|points| LateralColour::new(points).is_err()));
    }
}
