//! Test points of a passing beam: class B headlamps for right-hand traffic, UN Regulation No. 112 (01 series), now part of UN Regulation No. 149; left-hand
//! traffic is the mirror image. Intensities in cd of the lamp as measured. Zones, the cut-off's sharpness and the aim are not checked: this is no approval.

use etendue_scene::asset::PhotometryAsset;

use super::FileReport;

/// Required intensity at a point, cd.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RequiredIntensity {
    /// Minimum.
    AtLeast(f64),
    /// Maximum.
    AtMost(f64),
}

/// Test point of a passing beam, for right-hand traffic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamTestPoint {
    /// Its name in the regulation.
    pub name: &'static str,
    /// Degrees to the right of the lamp's axis.
    pub right_deg: f64,
    /// Degrees up.
    pub up_deg: f64,
    /// Requirement.
    pub limit: RequiredIntensity,
}

const fn point(name: &'static str, right_deg: f64, up_deg: f64, limit: RequiredIntensity) -> BeamTestPoint {
    BeamTestPoint { name, right_deg, up_deg, limit }
}

/// Points for right-hand traffic.
pub const POINTS: [BeamTestPoint; 9] = [
    point("B50L", -3.43, 0.57, RequiredIntensity::AtMost(350.0)),
    point("BR", 2.5, 1.0, RequiredIntensity::AtMost(1750.0)),
    point("75R", 1.15, -0.57, RequiredIntensity::AtLeast(10_100.0)),
    point("75L", -3.43, -0.57, RequiredIntensity::AtMost(10_600.0)),
    point("50L", -3.43, -0.86, RequiredIntensity::AtMost(13_200.0)),
    point("50R", 1.72, -0.86, RequiredIntensity::AtLeast(10_100.0)),
    point("50V", 0.0, -0.86, RequiredIntensity::AtLeast(5_100.0)),
    point("25L", -9.0, -1.72, RequiredIntensity::AtLeast(1_700.0)),
    point("25R", 9.0, -1.72, RequiredIntensity::AtLeast(1_700.0)),
];

impl RequiredIntensity {
    /// Returns true if an intensity in cd meets the requirement.
    #[must_use]
    pub fn is_met(self, candela: f64) -> bool {
        match self {
            Self::AtLeast(limit) => candela >= limit,
            Self::AtMost(limit) => candela <= limit,
        }
    }

    fn words(self) -> String {
        match self {
            Self::AtLeast(limit) => format!("at least {limit} cd"),
            Self::AtMost(limit) => format!("at most {limit} cd"),
        }
    }
}

/// Adds the table to the report of a lamp whose grid has a forward direction.
pub(super) fn state(lamp: &PhotometryAsset, report: &mut FileReport) {
    let mut passed = [0, 0];
    for BeamTestPoint { name, right_deg: right, up_deg: up, limit } in POINTS {
        let (Some(here), Some(mirrored)) = (lamp.candela_ahead(right, up), lamp.candela_ahead(-right, up)) else {
            return;
        };
        let verdict = if limit.is_met(here) { "pass" } else { "FAIL" };
        let place = format!("passing beam {name}, {} {}", side(right, "R", "L"), side(up, "U", "D"));
        report.state(&place, format!("{here:.0} cd, {}: {verdict}", limit.words()));
        passed[0] += usize::from(limit.is_met(here));
        passed[1] += usize::from(limit.is_met(mirrored));
    }
    let count = POINTS.len();
    let message =
        format!("{} of {count} points pass for right-hand, {} of {count} for left-hand traffic", passed[0], passed[1]);
    report.state("passing beam, UN R112/R149 class B", message);
}

fn side(angle_deg: f64, positive: &str, negative: &str) -> String {
    match angle_deg {
        0.0 => "0°".to_owned(),
        _ => format!("{}° {}", angle_deg.abs(), if angle_deg > 0.0 { positive } else { negative }),
    }
}
