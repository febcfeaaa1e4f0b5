//! Response of the micro-lenses over the angle of the chief ray.
//!
//! μ ← μ g(θ), g a table over the angle θ between the chief ray of a pixel and the sensor's normal, 1 at 0, linear in θ² between its points and
//! constant beyond the last. The response is symmetric about the normal and smooth across it, so it is a function of θ² (straight lines in θ would
//! put a cusp on the axis). θ = atan(r / d), r the pixel's distance from the principal point, d that of the exit pupil (manufacturers state g as "CRA
//! response"; the geometry is that of Catrysse, Liu and El Gamal 2000). Left out: dependence on wavelength, channel, azimuth and the spread of the
//! light cone.

use etendue_core::{EffectStatus, maths::f64::atan, quantity::MeanElectrons};

use crate::effect::{Action, Context, Effect, Memory, QuantityEffect, Row, RowEffect, SensorFacts};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// Response over angle, and the geometry of the incident light.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleResponse {
    /// Angle (degrees) and response, angles increasing from 0.
    pub table: Vec<[f64; 2]>,
    /// Distance of the exit pupil from the sensor, mm.
    pub exit_pupil_mm: f64,
    /// Intersection of the optical axis with the array, px.
    pub principal_px: [f64; 2],
}

impl AngleResponse {
    /// The response at an angle, degrees.
    #[must_use]
    pub fn at(&self, angle_deg: f64) -> f64 {
        let above = self.table.partition_point(|[angle, _]| *angle <= angle_deg);
        let [low, before] = self.table[above - 1];
        match self.table.get(above) {
            None => before,
            Some([high, after]) => {
                before + (after - before) * (angle_deg * angle_deg - low * low) / (high * high - low * low)
            }
        }
    }
}

impl Effect for AngleResponse {
    const NAME: &'static str = "angle response";
    const KEY: &'static str = "sensor.angle_response";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        checks.positive("angle_response.exit_pupil_mm", self.exit_pupil_mm);
        let rising = self.table.len() > 1 && self.table.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        let starts = self.table.first().is_some_and(|[angle, response]| *angle == 0.0 && *response == 1.0);
        let ends = self.table.last().is_some_and(|[angle, _]| *angle < 90.0);
        checks.agree("angle_response", rising && starts && ends, || {
            "expected two or more angles that increase from 0 (where the response is 1) to less than 90 degrees"
                .to_owned()
        });
        self.table.iter().for_each(|[_, response]| checks.fraction("angle_response", *response));
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        EffectStatus::Modelled(format!("the exit pupil is {} mm from the sensor", self.exit_pupil_mm))
    }
}

impl QuantityEffect for AngleResponse {
    type Signal = MeanElectrons;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<MeanElectrons> {
        Action::rows(AngleFactors {
            response: self.clone(),
            pitch_mm: 1e-3 * context.facts.pitch_um,
            origin_px: context.facts.first_lit.map(|pixels| pixels as f64),
        })
    }
}

/// Angle response, prepared: factors by the square of the radius.
#[derive(Clone, Debug, PartialEq)]
struct AngleFactors {
    response: AngleResponse,
    pitch_mm: f64,
    /// Columns and rows before the first active pixel.
    origin_px: [f64; 2],
}

impl RowEffect<MeanElectrons> for AngleFactors {
    fn apply(&self, row: &mut Row<'_, MeanElectrons>) {
        let [cx, cy] = self.response.principal_px;
        let dy = f64::from(row.y) + 0.5 - self.origin_px[1] - cy;
        for (x, mean) in row.values.iter_mut().enumerate() {
            let dx = x as f64 + 0.5 - self.origin_px[0] - cx;
            let radius_mm = self.pitch_mm * (dx * dx + dy * dy).sqrt();
            *mean *= self.response.at(atan(radius_mm / self.response.exit_pupil_mm).to_degrees());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::tests::{ADDRESS, quiet, run};

    #[test]
    fn a_pixel_sees_the_response_at_its_angle() {
        let mut p = quiet();
        p.pixel.pitch_um = 100.0;
        let table = vec![[0.0, 1.0], [45.0, 0.5], [60.0, 0.2]];
        p.light.angle_response = Some(AngleResponse { table, exit_pupil_mm: 1.0, principal_px: [0.5, 0.5] });
        let raw = run(&p, &etendue_core::Plane::filled(31, 1, 1000.0), ADDRESS);
        let dn: Vec<u32> = raw.plane.samples().to_vec();
        // On the axis; at tan θ = 1; at tan θ = 3, beyond the table. One DN per electron.
        assert_eq!((dn[0], dn[10], dn[30]), (1000, 500, 200));
        let angle = atan(0.5).to_degrees() / 45.0;
        assert!((f64::from(dn[5]) - 1000.0 * (1.0 - 0.5 * angle * angle)).abs() <= 0.5);
    }
}
