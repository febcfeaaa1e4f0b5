//! Sensors and their films.

use etendue_core::maths::f64 as maths;
use etendue_io::Error;
use glam::{DAffine3, DMat3, DVec3};

use super::access::{all, find, number, stated, text};
use super::transform::transform_of;
use crate::scenery::{ImportReport, to_ours};
use crate::syntax::mitsuba::MitsubaElement;
use crate::written::{ImportedCamera, View, pose_of};

/// Camera of the file.
pub(super) struct MitsubaCamera {
    /// Transform from its axes (x left, y up, z forward) to Mitsuba's world.
    to_world: DAffine3,
    kind: MitsubaProjection,
    size_px: [u64; 2],
}

enum MitsubaProjection {
    Perspective {
        yfov_rad: f64,
    },
    /// Radius of the lens and focus distance.
    Lens {
        yfov_rad: f64,
        lens: [f64; 2],
    },
    Orthographic,
}

/// Reads a sensor. `None`, with a note, if it is no supported camera.
pub(super) fn read(sensor: &MitsubaElement, report: &mut ImportReport) -> Result<Option<MitsubaCamera>, Error> {
    let kind = sensor.kind();
    if !matches!(kind, "perspective" | "thinlens" | "orthographic") {
        report.note(format!(
            "the sensor \"{kind}\" is not supported and left out; expected perspective, thinlens or orthographic"
        ));
        return Ok(None);
    }
    let size_px = film_size(sensor, report)?;
    let to_world = transform_of(sensor, "to_world")?;
    for name in ["near_clip", "far_clip", "shutter_open", "shutter_close"] {
        if find(sensor, name).is_some() {
            report.note("near and far planes and shutters of cameras are not used");
        }
    }
    for name in ["principal_point_offset_x", "principal_point_offset_y"] {
        if number(sensor, name, 0.0)? != 0.0 {
            report.note("the principal point of a camera is centred");
        }
    }
    if all(sensor, "sampler").count() > 0 {
        report.note("samplers are not used: the job has its own sampling settings");
    }
    let kind = match kind {
        "orthographic" => MitsubaProjection::Orthographic,
        "thinlens" => {
            let radius = stated(sensor, "aperture_radius")?;
            let radius = radius.filter(|r| *r > 0.0).ok_or_else(|| {
                sensor
                    .error("a thinlens needs \"aperture_radius\" above 0 (use perspective for a camera without a lens)")
            })?;
            let focus = number(sensor, "focus_distance", 1e4)?;
            if focus <= 0.0 {
                return Err(sensor.error(format!("\"focus_distance\" is {focus}; expected a distance above 0")));
            }
            MitsubaProjection::Lens { yfov_rad: yfov_rad(sensor, size_px)?, lens: [radius, focus] }
        }
        _ => MitsubaProjection::Perspective { yfov_rad: yfov_rad(sensor, size_px)? },
    };
    Ok(Some(MitsubaCamera { to_world, kind, size_px }))
}

fn film_size(sensor: &MitsubaElement, report: &mut ImportReport) -> Result<[u64; 2], Error> {
    let Some(film) = all(sensor, "film").next() else { return Ok([768, 576]) };
    let pixels = |name: &str, default: f64| match number(film, name, default)? {
        n if (1.0..=65_536.0).contains(&n) && n.fract() == 0.0 => Ok(n as u64),
        n => Err(film.error(format!("\"{name}\" is {n}; expected an integer from 1 to 65536"))),
    };
    let size = [pixels("width", 768.0)?, pixels("height", 576.0)?];
    if ["crop_width", "crop_height", "crop_offset_x", "crop_offset_y"].iter().any(|name| find(film, name).is_some()) {
        report.note("the crop of a film is not used: the whole image is rendered");
    }
    report.note(format!("of the film \"{}\" only the image size is used", film.kind()));
    Ok(size)
}

/// Full vertical angle. A focal length refers to a film of 36 mm by 24 mm, by its diagonal.
fn yfov_rad(sensor: &MitsubaElement, [width, height]: [u64; 2]) -> Result<f64, Error> {
    let [w, h] = [width as f64, height as f64];
    let diagonal = (w * w + h * h).sqrt();
    let half_of = |tangent: f64| 2.0 * maths::atan2(tangent, 1.0);
    let Some(fov_deg) = stated(sensor, "fov")? else {
        let stated = text(sensor, "focal_length")?.unwrap_or("50mm").trim();
        let focal_mm: f64 = match stated.trim_end_matches("mm").trim().parse() {
            Ok(mm) if mm > 0.0 && f64::is_finite(mm) => mm,
            _ => {
                return Err(
                    sensor.error(format!("\"focal_length\" is \"{stated}\"; expected a length such as \"50mm\""))
                );
            }
        };
        return Ok(half_of(0.5 * (36.0_f64 * 36.0 + 24.0 * 24.0).sqrt() / focal_mm * h / diagonal));
    };
    if !(0.0..180.0).contains(&fov_deg) || fov_deg == 0.0 {
        return Err(sensor.error(format!("the field of view is {fov_deg}°; expected an angle between 0° and 180°")));
    }
    let extent = match text(sensor, "fov_axis")?.unwrap_or("x").to_ascii_lowercase().as_str() {
        "x" => w,
        "y" => h,
        "diagonal" => diagonal,
        "smaller" => w.min(h),
        "larger" => w.max(h),
        other => {
            let message = format!("unknown \"fov_axis\" \"{other}\"; expected x, y, diagonal, smaller or larger");
            return Err(sensor.error(message));
        }
    };
    Ok(half_of(maths::tan(0.5 * fov_deg.to_radians()) * h / extent))
}

impl MitsubaCamera {
    /// Default camera of a file without one.
    pub(super) fn at_origin() -> Self {
        let yfov_rad = 2.0 * maths::atan2(0.5, 1.0);
        Self { to_world: DAffine3::IDENTITY, kind: MitsubaProjection::Perspective { yfov_rad }, size_px: [768, 576] }
    }

    /// Rotation from Mitsuba's world to ours.
    pub(super) fn to_ours(&self) -> DMat3 {
        let own = self.to_world.matrix3;
        to_ours(DMat3::from_cols(-own.x_axis, own.y_axis, own.z_axis))
    }

    pub(super) fn into_imported(self, name: &str, to_ours: DMat3, report: &mut ImportReport) -> ImportedCamera {
        let [width, height] = self.size_px;
        let axis = |v: DVec3| to_ours * (self.to_world.matrix3 * v);
        // Only the first camera may mirror the world.
        if axis(DVec3::X).cross(axis(DVec3::Y)).dot(axis(DVec3::Z)) < 0.0 {
            report.note(format!(
                "the image of camera \"{name}\" is mirrored in the file, unlike that of the first camera; here it is not"
            ));
        }
        let view = match self.kind {
            MitsubaProjection::Perspective { yfov_rad } => {
                report.note(format!(
                    "camera \"{name}\": perspective, vertical field of view {:.4}°",
                    yfov_rad.to_degrees()
                ));
                View::Perspective { yfov_rad }
            }
            MitsubaProjection::Lens { yfov_rad, lens: [radius_m, focus_m] } => {
                report.note(format!(
                    "camera \"{name}\": perspective, vertical field of view {:.4}°, lens radius {radius_m} m, focused at {focus_m} m",
                    yfov_rad.to_degrees()
                ));
                View::Lens { yfov_rad, radius_m, focus_m }
            }
            MitsubaProjection::Orthographic => {
                let width_m = 2.0 * axis(DVec3::X).length();
                let height_m = width_m * height as f64 / width as f64;
                report.note(format!("camera \"{name}\": orthographic, {width_m} m by {height_m} m"));
                View::Orthographic { width_m }
            }
        };
        let pose = pose_of(to_ours * self.to_world.translation, axis(DVec3::Z), axis(DVec3::Y));
        ImportedCamera { name: name.to_owned(), pose, view, size_px: self.size_px }
    }
}
