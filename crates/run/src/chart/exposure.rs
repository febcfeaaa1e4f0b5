//! How bright a chart's light is, and how long its cameras expose.

use super::{ChartRequest, Series};
use etendue_charts::{ChartError, Drawing, Light, Meter};

impl ChartRequest {
    /// The light: as bright as asked for, or as fills the sensor as far as asked for.
    pub(super) fn light(&self, meter: Option<&Meter<'_>>, otherwise_cd_m2: f64) -> Result<Light, ChartError> {
        let named = |luminance_cd_m2| Light::named(&self.illuminant, luminance_cd_m2);
        if let Some(luminance_cd_m2) = self.luminance_cd_m2 {
            return named(luminance_cd_m2);
        }
        let white = self.white;
        if !(white.is_finite() && white > 0.0) {
            return Err(ChartError::option("white", white, "expected a share of saturation above 0"));
        }
        let unit = named(1.0)?;
        let share = meter.map(|meter| meter.share(unit.radiance())).filter(|share| *share > 0.0);
        named(share.map_or(otherwise_cd_m2, |share| white / share))
    }

    /// The exposures of the series, s; none where there is no series.
    pub(super) fn exposures_s(
        &self,
        light: &Light,
        drawing: &Drawing,
        meter: Option<&Meter<'_>>,
    ) -> Result<Vec<f64>, ChartError> {
        let Some(Series { exposures, required }) = &self.series else { return Ok(Vec::new()) };
        let share = meter.map(|meter| meter.share(&drawing.inks[0].radiance(light))).filter(|share| *share > 0.0);
        let (Some(meter), Some(share)) = (meter, share) else {
            let told = || {
                "this camera has no electronics that respond to the light; give one with a sensor of its own".to_owned()
            };
            return match required {
                false => Ok(Vec::new()),
                true => Err(ChartError::Camera(format!("`exposures`, `levels`: {}", told()))),
            };
        };
        let exposures_s: Vec<f64> = exposures.shares.iter().map(|s| meter.exposure_s * s / share).collect();
        let longest_s = exposures_s.iter().copied().fold(0.0, f64::max);
        match meter.longest_s {
            Some(limit_s) if longest_s > limit_s => Err(ChartError::Camera(format!(
                "the longest exposure would be {longest_s:.3e} s, more than the camera's frame period of {limit_s} s: give more light \
                 by `luminance_cd_m2` or `white`, or a lower `highest`"
            ))),
            _ => Ok(exposures_s),
        }
    }
}
