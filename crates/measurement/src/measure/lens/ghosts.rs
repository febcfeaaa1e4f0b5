//! The strongest ghosts of each field point.

use etendue_optics::PrescriptionLens;
use etendue_optics::ghosts::{GhostReport, GhostSettings, strongest};
use serde_json::{Value, json};

use crate::report::fixed;

/// Number of ghosts reported per field point.
const MAX_REPORTED: usize = 3;

fn ghost_reports(lens: &PrescriptionLens, height_mm: f64) -> Vec<GhostReport> {
    strongest(lens, height_mm, GhostSettings::default(), MAX_REPORTED)
}

/// Surfaces from 1, nearer to the scene first.
fn surfaces(ghost: &GhostReport) -> [usize; 2] {
    [ghost.pair.front + 1, ghost.pair.rear + 1]
}

pub(crate) fn json(lens: &PrescriptionLens, height_mm: f64) -> Value {
    let ghost = |g: &GhostReport| {
        json!({
            "surfaces": surfaces(g),
            "light": g.light,
            "height_mm": g.height_mm + 0.0,
            "radius_mm": g.radius_mm,
            "sun_irradiance": g.sun_irradiance,
        })
    };
    ghost_reports(lens, height_mm).iter().map(ghost).collect()
}

pub(crate) fn text(lens: &PrescriptionLens, heights: impl Iterator<Item = f64>) -> String {
    let mut text = "\nghosts of a far point: the brightest pairs of surfaces\n\
                    height   surfaces  light     at        radius    irradiance\n\
                    mm                 of image  mm        mm        of the sun's image\n"
        .to_owned();
    for height_mm in heights {
        for ghost in ghost_reports(lens, height_mm) {
            let [front, rear] = surfaces(&ghost);
            let pair = format!("{front} {rear}");
            let (at, radius) = (fixed(ghost.height_mm, 3), fixed(ghost.radius_mm, 3));
            let (light, sun) = (ghost.light, ghost.sun_irradiance);
            text += &format!("{height_mm:<8.3} {pair:<9} {light:<9.2e} {at:<9} {radius:<9} {sun:.2e}\n");
        }
    }
    text
}
