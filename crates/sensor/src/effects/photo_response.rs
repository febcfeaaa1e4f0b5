//! Photo-response non-uniformity (PRNU): pixels differ in their response to light.
//!
//! μ ← μ max(1 + d, 0), d normal with a white, a row and a column part, each as a fraction (EMVA 1288 states them in per cent). The pattern belongs
//! to the unit: the same in every frame. Random numbers: `PixelResponse`, `RowResponse`, `ColumnResponse`. Left out: differences that depend on
//! wavelength; patterns of lower frequency (shading).

use etendue_core::{EffectStatus, KeyChange, KnownError, quantity::MeanElectrons, random::NoiseDraw};

use crate::effect::{Action, Context, Effect, Memory, QuantityEffect, Row, RowEffect, SensorFacts, SignalLevels};
use crate::random::pattern::{Deviations, Sigmas};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// Standard deviations of the response, as fractions of it, 0 to 1; 0: none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhotoResponse {
    /// From pixel to pixel.
    pub white: f64,
    /// From row to row.
    pub row: f64,
    /// From column to column.
    pub column: f64,
}

impl PhotoResponse {
    fn sigmas(self) -> Sigmas {
        Sigmas { white: self.white, row: self.row, column: self.column }
    }
}

impl Effect for PhotoResponse {
    const NAME: &'static str = "photo-response non-uniformity";
    const KEY: &'static str = "sensor.non_uniformity.prnu";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        checks.fraction("non_uniformity.prnu", self.white);
        checks.fraction("non_uniformity.prnu_row", self.row);
        checks.fraction("non_uniformity.prnu_column", self.column);
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        let sigmas = self.sigmas();
        if sigmas.is_zero() {
            return EffectStatus::NotDescribed;
        }
        EffectStatus::Modelled(format!("relative standard deviation of the response: {}", sigmas.described("")))
    }

    fn left_out_by(&self) -> Vec<KeyChange> {
        KeyChange::zeros([
            (Self::KEY, self.white),
            ("sensor.non_uniformity.prnu_row", self.row),
            ("sensor.non_uniformity.prnu_column", self.column),
        ])
    }

    fn errors_without(&self, _: &SensorFacts, _: &SignalLevels) -> Vec<KnownError> {
        let value = 100.0 * (self.white * self.white + self.row * self.row + self.column * self.column).sqrt();
        vec![KnownError { quantity: "missing PRNU", value, unit: "%" }]
    }
}

impl QuantityEffect for PhotoResponse {
    type Signal = MeanElectrons;
    const COMPONENT: SignalComponent = SignalComponent::FixedPattern;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<MeanElectrons> {
        let purposes = [NoiseDraw::PixelResponse, NoiseDraw::RowResponse, NoiseDraw::ColumnResponse];
        let key = |purpose| context.pattern(purpose);
        Action::rows(ResponsePattern { deviations: Deviations::new(self.sigmas(), purposes, key, context.width) })
    }
}

/// Photo-response non-uniformity, prepared.
#[derive(Clone, Debug, PartialEq)]
struct ResponsePattern {
    deviations: Deviations,
}

impl RowEffect<MeanElectrons> for ResponsePattern {
    fn apply(&self, row: &mut Row<'_, MeanElectrons>) {
        let means = &mut *row.values;
        self.deviations.for_row(row.y, means.len(), |x, d| means[x] *= (1.0 + d).max(0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::FrameAddress;
    use crate::frame::tests::{ADDRESS, covariance, quiet, run};
    use crate::parameters::SensorParameters;
    use etendue_core::Plane;

    fn patterned() -> SensorParameters {
        let mut p = quiet();
        p.light.photo_response = PhotoResponse { white: 0.01, row: 0.0, column: 0.0 };
        p
    }

    #[test]
    fn the_spread_is_the_stated_one_and_grows_with_the_light() {
        for mean in [1e3, 1e4, 1e6] {
            let raw = run(&patterned(), &Plane::filled(512, 512, mean), ADDRESS);
            let sigma = 0.01 * f64::from(mean);
            let expected = sigma * sigma + 1.0 / 12.0;
            // A variance of 512² numbers is known to 0.28 %; tolerance: four of those.
            assert!((covariance(&raw, 0, 0) / expected - 1.0).abs() < 0.0112, "{mean}");
        }
    }

    #[test]
    fn the_pattern_is_the_specimen_s_not_the_frame_s() {
        let means = Plane::filled(32, 32, 1e4);
        let with = |seed, address| {
            let mut p = patterned();
            p.unit = seed;
            run(&p, &means, address).plane
        };
        let first = with(None, ADDRESS);
        assert_eq!(first, with(None, FrameAddress { frame: 9, seed: 77, capture: 1, ..ADDRESS }));
        assert_ne!(first, with(None, FrameAddress { camera: 7, ..ADDRESS }));
        assert_ne!(first, with(Some(3), ADDRESS));
        assert_eq!(with(Some(3), FrameAddress { camera: 7, ..ADDRESS }), with(Some(3), ADDRESS));
    }
}
