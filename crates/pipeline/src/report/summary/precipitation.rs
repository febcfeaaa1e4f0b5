//! Text on rain and snow.

use crate::plan::{CameraPlan, Plan, Precipitation};
use crate::render::change_over;
use etendue_core::maths::f64::{log10, pow};

/// The drops or flakes.
pub(super) fn field(precipitation: &Precipitation) -> String {
    let law = precipitation.field.law();
    let (what, number) = if law.is_snow() { ("snow", "flakes") } else { ("rain", "drops") };
    format!(
        "{what} of {} mm/h ({} mm/h by its size distribution), {} {number} per m³; meteorological visibility {} m (2 %) and \
         extinction {} 1/km, extinction in an image {} 1/km; falls from {} m",
        significant(law.rate_mm_h()),
        significant(law.water_rate_mm_h()),
        significant(law.number_per_m3()),
        significant(law.visibility_m()),
        significant(1e3 * law.meteorological_extinction_per_m()),
        significant(1e3 * precipitation.field.extinction_per_m()),
        significant(precipitation.field.top_m()),
    )
}

/// The part that a camera models individually.
pub(super) fn near(plan: &Plan, camera: &CameraPlan) -> Option<String> {
    let precipitation = plan.precipitation.as_ref()?;
    let change_over = change_over(plan, camera)?;
    let number = if precipitation.field.law().is_snow() { "flakes" } else { "drops" };
    let of = |diameter_m: f64| {
        let classes = precipitation.field.classes();
        let class = classes.iter().position(|class| class.diameter_m >= diameter_m).unwrap_or(classes.len() - 1);
        format!(
            "{} m (of {} mm)",
            significant(change_over.radii_m[class]),
            significant(1e3 * classes[class].diameter_m)
        )
    };
    if change_over.expected < 0.5 {
        return Some(format!("a participating medium at all distances: no {number} are resolved"));
    }
    Some(format!(
        "about {:.0} {number} at a time, resolved individually up to {}, {} and {}, a participating medium beyond",
        change_over.expected,
        of(1e-3),
        of(2e-3),
        of(4e-3)
    ))
}

/// A positive number to three significant digits.
fn significant(x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    let digits = (2.0 - log10(x).floor()).max(0.0);
    let scale = pow(10.0, digits).round();
    (x * scale).round() / scale
}
