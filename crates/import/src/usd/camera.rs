//! Cameras of UsdGeom.

use etendue_core::maths::f64 as maths;
use glam::DVec3;

use super::access::{number, text, tuple};
use super::importer::{Importer, TraversalState};
use crate::syntax::usd::UsdPrim;
use crate::written::{ImportedCamera, View, pose_of, size_of};

/// Plausible focal lengths, mm.
const PLAUSIBLE_MM: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

impl<'a> Importer<'a> {
    /// Converts a camera. Focal length and apertures are in tenths of the stage's unit; it looks along −z.
    pub(super) fn camera(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>) -> Result<(), String> {
        let above_zero = |name: &str, usual: f64| match number(prim, name, usual) {
            v if v > 0.0 && v.is_finite() => Ok(v),
            v => Err(format!("{}: \"{name}\" is {v}; expected a number above 0", prim.path)),
        };
        let (width, height) = (above_zero("horizontalAperture", 20.955)?, above_zero("verticalAperture", 15.2908)?);
        let focal = above_zero("focalLength", 50.0)?;
        let (stop, focus) = (number(prim, "fStop", 0.0), number(prim, "focusDistance", 0.0));
        let metres = self.stage.metres_per_unit;
        let _ = tuple::<2>(prim, "clippingRange");
        let name = self.scenery.names.take(prim.name(), "camera");
        for offset in ["horizontalApertureOffset", "verticalApertureOffset"] {
            if number(prim, offset, 0.0) != 0.0 {
                self.scenery
                    .report
                    .note(format!("camera \"{name}\": its principal point is centred; \"{offset}\" is not used"));
            }
        }
        let yfov_rad = 2.0 * maths::atan2(0.5 * height, focal);
        let focal_mm = 100.0 * metres * focal;
        let axis = |v: DVec3| self.scenery.to_ours * (state.to_world.matrix3 * v);
        let view = match text(prim, "projection") {
            "orthographic" => {
                let width_m = 0.1 * width * axis(DVec3::X).length();
                self.scenery.report.note(format!("camera \"{name}\": orthographic, {width_m} m wide"));
                View::Orthographic { width_m }
            }
            _ if stop > 0.0 && focus > 0.0 => {
                let (radius_m, focus_m) = (5e-4 * focal_mm / stop, focus * metres);
                self.scenery.report.note(format!(
                    "camera \"{name}\": {focal_mm} mm at f/{stop}, perspective, vertical field of view {:.4}°, focused at {focus_m} m",
                    yfov_rad.to_degrees()
                ));
                View::Lens { yfov_rad, radius_m, focus_m }
            }
            _ => {
                self.scenery.report.note(format!(
                    "camera \"{name}\": {focal_mm} mm, perspective, vertical field of view {:.4}°, everything in focus",
                    yfov_rad.to_degrees()
                ));
                View::Perspective { yfov_rad }
            }
        };
        if !PLAUSIBLE_MM.contains(&focal_mm) && text(prim, "projection") != "orthographic" {
            self.scenery.report.note(format!(
                "camera \"{name}\": a focal length of {focal_mm} mm is unusual: check metersPerUnit (focal lengths are in tenths of a unit)"
            ));
        }
        let pose = pose_of(self.scenery.to_ours * state.to_world.translation, axis(DVec3::NEG_Z), axis(DVec3::Y));
        self.cameras.push(ImportedCamera { name, pose, view, size_px: size_of(width / height) });
        Ok(())
    }
}
