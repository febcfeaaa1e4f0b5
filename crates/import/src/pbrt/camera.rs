//! Cameras and films.

use std::rc::Rc;

use etendue_core::maths::f64 as maths;
use etendue_scene::record::Lens;
use glam::{DAffine3, DMat3, DVec3};

use super::lens_table::{FocusedLens, LensTable};
use super::parameters::Parameters;
use crate::scenery::{Graphics, ImportReport, SceneBuilder, above_zero, to_ours};
use crate::written::{ImportedCamera, View, pose_of};

/// Field of view of the substitute for an unsupported camera, degrees along the shorter side: that of a normal lens.
const FALLBACK_FOV_DEG: f64 = 40.0;

/// Image size.
pub(super) struct PbrtFilm {
    size_px: [u64; 2],
    diagonal_mm: f64,
}

impl Default for PbrtFilm {
    fn default() -> Self {
        Self { size_px: [1280, 720], diagonal_mm: 35.0 }
    }
}

impl PbrtFilm {
    pub(super) fn read(parameters: Parameters<'_>) -> Result<Self, String> {
        let pixels = |name: &str, default: f64| match parameters.number(name, default)? {
            n if (1.0..=65_536.0).contains(&n) && n.fract() == 0.0 => Ok(n as u64),
            n => Err(format!("\"{name}\" is {n}; expected an integer from 1 to 65536")),
        };
        let diagonal_mm = above_zero("diagonal", parameters.number("diagonal", 35.0)?)?;
        Ok(Self { size_px: [pixels("xresolution", 1280.0)?, pixels("yresolution", 720.0)?], diagonal_mm })
    }
}

/// Camera of the file.
pub(super) struct PbrtCamera {
    /// Transform from its axes (x right, y up, z forward) to pbrt's world.
    to_world: DAffine3,
    kind: PbrtProjection,
    /// Radius of the lens and focus distance, both above 0.
    lens: Option<[f64; 2]>,
    frame_aspect: Option<f64>,
    window: Option<[f64; 4]>,
    outside: Rc<str>,
}

enum PbrtProjection {
    Perspective { fov_deg: f64 },
    Orthographic,
    Realistic(LensTable, FocusedLens),
}

/// Camera, and the medium around it; empty for none.
pub(super) struct PlacedCamera {
    pub(super) camera: ImportedCamera,
    pub(super) outside: Rc<str>,
}

impl PbrtCamera {
    /// Default camera of a file without one.
    pub(super) fn at_origin() -> Self {
        let (lens, frame_aspect, window) = (None, None, None);
        let kind = PbrtProjection::Perspective { fov_deg: 90.0 };
        Self { to_world: DAffine3::IDENTITY, kind, lens, frame_aspect, window, outside: Rc::from("") }
    }

    fn read(
        kind: &str,
        parameters: Parameters<'_>,
        graphics: &Graphics,
        scenery: &mut SceneBuilder,
    ) -> Result<Self, String> {
        let own = match kind {
            "perspective" => {
                let fov_deg = parameters.number("fov", 90.0)?;
                if !(0.0..180.0).contains(&fov_deg) || fov_deg == 0.0 {
                    return Err(format!("the field of view is {fov_deg}°; expected an angle between 0° and 180°"));
                }
                PbrtProjection::Perspective { fov_deg }
            }
            "orthographic" => PbrtProjection::Orthographic,
            "realistic" => scenery.realistic(parameters)?,
            other => {
                parameters.0.iter().for_each(|p| p.used.set(true));
                scenery.report.note(format!(
                    "the camera \"{other}\" is not supported: a perspective camera of {FALLBACK_FOV_DEG}° at its position is used instead"
                ));
                PbrtProjection::Perspective { fov_deg: FALLBACK_FOV_DEG }
            }
        };
        let window = parameters.numbers("screenwindow")?.map(<[f64; 4]>::try_from).transpose();
        let window = window.map_err(|_| "\"screenwindow\": expected four numbers")?;
        let [radius, focus] = [parameters.number("lensradius", 0.0)?, parameters.number("focaldistance", 1e6)?];
        let frame_aspect =
            parameters.numbers("frameaspectratio")?.and_then(|n| n.first().copied()).filter(|a| *a > 0.0);
        for name in ["shutteropen", "shutterclose"] {
            if parameters.find(name).is_some() {
                scenery.report.note("the shutter of the camera is not used: the scene is static");
            }
        }
        let lens = (radius > 0.0 && focus > 0.0).then_some([radius, focus]);
        let outside = graphics.outside.clone();
        Ok(Self { to_world: graphics.to_world.inverse(), kind: own, lens, frame_aspect, window, outside })
    }

    /// Rotation from pbrt's world to ours.
    pub(super) fn to_ours(&self) -> DMat3 {
        to_ours(self.to_world.matrix3)
    }

    pub(super) fn into_imported(self, film: &PbrtFilm, to_ours: DMat3, report: &mut ImportReport) -> PlacedCamera {
        let [width, height] = film.size_px;
        if let PbrtProjection::Realistic(table, focused) = &self.kind {
            let camera = self.with_table(table, *focused, film, to_ours);
            return PlacedCamera { camera, outside: self.outside };
        }
        let aspect = self.frame_aspect.unwrap_or(width as f64 / height as f64);
        let [half_x, half_y] = match self.window {
            Some([x0, x1, y0, y1]) => {
                if x0 + x1 != 0.0 || y0 + y1 != 0.0 {
                    report.note("an off-centre \"screenwindow\" is centred");
                }
                [0.5 * (x1 - x0).abs(), 0.5 * (y1 - y0).abs()]
            }
            None if aspect > 1.0 => [aspect, 1.0],
            None => [1.0, 1.0 / aspect],
        };
        if ((half_x / half_y) * (height as f64 / width as f64) - 1.0).abs() > 1e-3 {
            report.note("non-square pixels become square; the height of the image is unchanged");
        }
        let axis = |v: DVec3| to_ours * (self.to_world.matrix3 * v);
        let yfov_rad = |fov_deg: f64| 2.0 * maths::atan2(half_y * maths::tan(0.5 * fov_deg.to_radians()), 1.0);
        let view = match (self.kind, self.lens) {
            (PbrtProjection::Perspective { fov_deg }, Some([radius_m, focus_m])) => {
                let yfov_rad = yfov_rad(fov_deg);
                let field = yfov_rad.to_degrees();
                report.note(format!(
                    "camera: perspective, vertical field of view {field:.4}°, lens radius {radius_m} m, focused at {focus_m} m"
                ));
                View::Lens { yfov_rad, radius_m, focus_m }
            }
            (PbrtProjection::Perspective { fov_deg }, None) => {
                let yfov_rad = yfov_rad(fov_deg);
                report.note(format!("camera: perspective, vertical field of view {:.4}°", yfov_rad.to_degrees()));
                View::Perspective { yfov_rad }
            }
            (PbrtProjection::Orthographic | PbrtProjection::Realistic(..), lens) => {
                if lens.is_some() {
                    report.note("the lens of an orthographic camera is not used: everything is in focus");
                }
                let width_m = 2.0 * half_x * axis(DVec3::X).length();
                report.note(format!("camera: orthographic, {width_m} m wide"));
                View::Orthographic { width_m }
            }
        };
        let pose = pose_of(to_ours * self.to_world.translation, axis(DVec3::Z), axis(DVec3::Y));
        let camera = ImportedCamera { name: "camera".to_owned(), pose, view, size_px: film.size_px };
        PlacedCamera { camera, outside: self.outside }
    }

    /// Camera of a lens table. pbrt's camera is at the film, ours at the entrance pupil.
    fn with_table(&self, table: &LensTable, focused: FocusedLens, film: &PbrtFilm, to_ours: DMat3) -> ImportedCamera {
        let [width, height] = film.size_px;
        let aspect = width as f64 / height as f64;
        let axis = |v: DVec3| to_ours * (self.to_world.matrix3 * v);
        let ahead = axis(DVec3::Z).normalize_or(DVec3::X);
        let position = to_ours * self.to_world.translation + focused.film_to_pupil_m * ahead;
        let lens = Lens::Prescription(Box::new(table.prescription(focused.focus_m)));
        let sensor_mm = film.diagonal_mm / (1.0 + aspect * aspect).sqrt();
        ImportedCamera {
            name: "camera".to_owned(),
            pose: pose_of(position, ahead, axis(DVec3::Y)),
            view: View::Prescription { lens: Box::new(lens), sensor_mm },
            size_px: film.size_px,
        }
    }
}

impl SceneBuilder {
    pub(super) fn pbrt_camera(
        &mut self,
        kind: &str,
        parameters: Parameters<'_>,
        graphics: &Graphics,
    ) -> Result<PbrtCamera, String> {
        PbrtCamera::read(kind, parameters, graphics, self)
    }

    /// Lens of the camera `realistic`, in focus.
    fn realistic(&mut self, parameters: Parameters<'_>) -> Result<PbrtProjection, String> {
        let name = parameters.text("lensfile")?.ok_or("\"lensfile\" is missing")?;
        let opened_mm = above_zero("aperturediameter", parameters.number("aperturediameter", 1.0)?)?;
        let focus_m = above_zero("focusdistance", parameters.number("focusdistance", 10.0)?)?;
        let table = LensTable::read(&self.find_file(name), opened_mm)?;
        let stop_mm = table.stop_diameter_mm();
        if stop_mm < opened_mm {
            self.report.note(format!("\"aperturediameter\" of {opened_mm} mm is limited to the table's {stop_mm} mm"));
        }
        if table.has_stop_in_glass() {
            self.report.note("the stop of the lens lies in glass, which goes on behind it; pbrt-v4 has air there");
        }
        if parameters.text("aperture")?.is_some_and(|shape| !shape.is_empty()) {
            self.report.note("the shape of the aperture is not used: the stop is a disc");
        }
        let first_order = table.first_order()?;
        let focused = first_order.focused(focus_m).ok_or_else(|| {
            format!(
                "the lens of focal length {:.3} mm cannot focus {focus_m} m before the film",
                first_order.focal_length
            )
        })?;
        self.report.note(format!(
            "camera: lens of {} surfaces, focal length {:.4} mm, stop of {stop_mm} mm, focused {focus_m} m before the film, {:.4} m before its entrance pupil",
            table.surface_count(),
            first_order.focal_length,
            focused.focus_m
        ));
        Ok(PbrtProjection::Realistic(table, focused))
    }
}
