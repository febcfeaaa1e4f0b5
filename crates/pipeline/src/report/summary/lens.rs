//! Text of a plan on a lens: figures, distortion, field of view, and omissions.

use super::{figure, front, line, list};
use crate::plan::{CameraPlan, Route};
use etendue_optics::DepthOfField;
use etendue_optics::effects::Effect;
use etendue_optics::{Effects, Lens, PupilOrientation, PupilProjection};
use etendue_projection::DistortionDirection;
use std::fmt::{self, Formatter};

pub(super) fn lens(camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let lens = &camera.body.lens;
    let focus = match lens.focus_distance_m() {
        None => "everything in focus".to_owned(),
        Some(m) if m.is_infinite() => "focused at infinity".to_owned(),
        Some(m) => format!("focused at {m} m"),
    };
    let (kind, n, t) = (lens.kind(), figure(lens.f_number()), lens.t_number());
    let length = match lens {
        Lens::Telecentric(_) => String::new(),
        _ => format!(" {} mm", figure(lens.focal_length_mm())),
    };
    let obscured = match lens.obscured_ratio() {
        0.0 => String::new(),
        ratio => format!(", {:.1} % of the pupil obscured", 100.0 * ratio * ratio),
    };
    let wavelength = lens.first_order_nm().map_or_else(String::new, |nm| format!(" at {nm} nm"));
    line(
        f,
        "lens",
        format!("{kind},{length} f/{n}{wavelength} (T {t:.3}){obscured}, {focus}, {}", field_of_view(camera)),
    )?;
    line(f, "distortion", distortion(lens))?;
    if let Some(colour) = lens.lateral_colour() {
        let size = |nm: f64| format!("{:.5} at {nm} nm", colour.at(nm));
        let text = format!(
            "relative image size {}, {}, {}: each path carries one wavelength through the lens",
            size(450.0),
            size(550.0),
            size(650.0)
        );
        line(f, "lateral colour", text)?;
    }
    for (i, text) in camera.body.front.iter().flat_map(front::front).enumerate() {
        line(f, if i == 0 { "in front" } else { "" }, text)?;
    }
    match &camera.settings.route {
        Route::Lens => line(f, "route", "through the lens: each sample's ray gives vignetting, defocus and distortion"),
        Route::Pupil(p) => {
            let views = match p {
                PupilProjection::Rectilinear(_) => String::new(),
                PupilProjection::Cube(cube) => {
                    format!(" in {} cube faces of {} px", p.views().count(), cube.face_px())
                }
            };
            let size = format!(
                "at the pupil: radiance of {} × {} px{views}, then the lens is applied to the image",
                p.width(),
                p.height()
            );
            line(f, "route", format!("{size}; {}", depth_of_field(camera)))
        }
    }?;
    line(f, "left out", omitted_effects(lens, &camera.body.effects))
}

fn omitted_effects(lens: &Lens, effects: &Effects) -> String {
    let missing = |words: &[&'static str]| {
        let models = |effect| effects.status(effect).is_modelled();
        let effect = |word: &str| match word {
            "glare" => Some(Effect::Glare),
            "diffraction" => Some(Effect::PointSpread),
            "ghosts" => Some(Effect::Ghosts),
            _ => None,
        };
        let modelled = |word: &&&str| effect(word).is_some_and(models);
        list(&words.iter().filter(|word| !modelled(word)).copied().collect::<Vec<_>>())
    };
    match lens {
        Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) | Lens::Calibrated(_) if lens.lateral_colour().is_some() => {
            format!(
                "{}: not modelled",
                missing(&["aberrations except lateral colour", "diffraction", "glare", "ghosts"])
            )
        }
        Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) | Lens::Telecentric(_) => {
            let missing = missing(&["aberrations", "diffraction", "glare", "ghosts"]);
            format!("{missing}: not modelled; dispersion: the lens has none")
        }
        Lens::Prescription(_) => {
            format!("{}: not modelled", missing(&["diffraction", "glare", "ghosts", "absorption in glass"]))
        }
        Lens::RayTransfer(lens) => {
            let missing = missing(&[
                "diffraction",
                "glare",
                "ghosts",
                "absorption and reflection by wavelength",
                "errors of the fit",
            ]);
            let colours =
                if lens.disperses() { "" } else { "; dispersion: the ray transfer functions cover one wavelength" };
            format!("{missing}: not modelled{colours}")
        }
        Lens::Calibrated(lens) => {
            let pupil = match (lens.parameters().relative_illumination.is_some(), lens.pupil()) {
                (true, _) => "illumination as measured",
                (false, PupilOrientation::Flat) => "illumination of a flat pupil, cos θ dΩ/dA",
                (false, PupilOrientation::Oriented) => "illumination of a pupil that faces the light, dΩ/dA",
            };
            let missing = missing(&["aberrations", "dispersion", "diffraction", "glare", "ghosts"]);
            format!("{missing}: not modelled; {pupil}")
        }
    }
}

fn field_of_view(camera: &CameraPlan) -> String {
    if let Lens::Telecentric(lens) = &camera.body.lens {
        return format!("{} m wide", figure(lens.parameters().metres_per_mm * camera.body.raster.size_mm().x));
    }
    match field_of_view_rad(camera) {
        Some(angle) => format!("{:.2}° wide", angle.to_degrees()),
        None => "wider than the lens covers".to_owned(),
    }
}

/// Angle across the image in its principal row, rad; `None` if the lens does not see all of it.
pub(in crate::report) fn field_of_view_rad(camera: &CameraPlan) -> Option<f64> {
    let size = camera.body.raster.size_mm();
    let middle = camera.body.raster.principal_px() * camera.body.raster.pitch_mm();
    let left = glam::DVec2::new(-middle.x, 0.0);
    let right = glam::DVec2::new(size.x - middle.x, 0.0);
    let lens = &camera.body.lens;
    // Above 180° the angle between two directions is not that across the image.
    match lens {
        Lens::Calibrated(_) => lens
            .angle_between_rad(left, glam::DVec2::ZERO)
            .and_then(|half| Some(half + lens.angle_between_rad(glam::DVec2::ZERO, right)?)),
        _ => lens.angle_between_rad(left, right),
    }
}

fn distortion(lens: &Lens) -> String {
    match (lens.distortion(), lens) {
        (None, Lens::Prescription(_)) => "given by the lens surfaces".to_owned(),
        (None, Lens::RayTransfer(_)) => "given by the ray transfer functions".to_owned(),
        (None, Lens::Calibrated(_)) => {
            "given by the calibrated projection; pixels outside it are dark and have no ray".to_owned()
        }
        (None, _) => "none".to_owned(),
        (Some(d), _) => {
            let [k1, k2] = d.coefficients();
            let sense = match d.sense() {
                DistortionDirection::IdealToObserved => "ideal to observed",
                DistortionDirection::ObservedToIdeal => "observed to ideal",
            };
            format!("radial, {sense}, k1 {k1}, k2 {k2}, radius in units of {:.4} mm", d.unit_mm())
        }
    }
}

/// Treatment of defocus on the pupil route.
pub(super) fn depth_of_field(camera: &CameraPlan) -> String {
    match &camera.depth_of_field {
        DepthOfField::None => format!("defocus is left out ({})", blur(camera)),
        DepthOfField::Physical => {
            let margin = camera.body.blur_margin_px(&camera.depth_of_field);
            format!(
                "defocus by the pupil's outline, applied in order of depth ({}; {margin} px around the image); content \
                 hidden behind edges is estimated from its surroundings",
                blur(camera)
            )
        }
        DepthOfField::Fast(blend) => {
            let p = blend.parameters();
            format!(
                "approximate defocus: sharp from {} to {} m, blended with a copy blurred by {} px, fully before {} m \
                 and beyond {} m (blur of the lens itself: {})",
                p.sharp_near_m,
                p.sharp_far_m,
                p.blur_px,
                p.blurred_near_m,
                p.blurred_far_m,
                blur(camera)
            )
        }
    }
}

/// The blur of the lens.
pub(super) fn blur(camera: &CameraPlan) -> String {
    let pixels = |depth_m: f64| camera.body.lens.circle_of_confusion_mm(depth_m) / camera.body.raster.pitch_mm().x;
    format!("{:.2} px diameter at 1 m, {:.2} px at infinity", pixels(1.0), pixels(f64::INFINITY))
}
