//! Cameras inside glass or water, where light is absorbed and radiance is n² times as high, and media inside glass or water, which have no effect.

use super::context::Context;
use super::frames::Frames;
use super::medium::inner_points;
use crate::plan::CameraPlan;
use etendue_core::TimeInterval;
use etendue_scene::record::Scene;
use etendue_tracer::MaterialId;
use etendue_tracer::accel::World;
use etendue_tracer::integrator::Surroundings;
use etendue_tracer::materials::MaterialTable;

/// Reports cameras inside a transparent solid, and those for which this is uncertain.
pub(super) fn note_enclosed_cameras(
    cameras: &[CameraPlan],
    world: &World,
    material_table: &MaterialTable,
    materials: &[String],
    context: &mut Context<'_>,
) {
    if !material_table.has_solids() {
        return;
    }
    let name = |id: MaterialId| &materials[id.0 as usize];
    for camera in cameras {
        let start_s = camera.timing.frame_start_s(0);
        let around = Surroundings::from_view(
            &world.render_space_for_few(
                camera.path.at(start_s).position_m,
                TimeInterval::at(start_s).unwrap_or_default(),
            ),
            material_table,
        );
        if let Some(solid) = around.solid {
            context.note_on(
                format!("camera \"{}\"", camera.name),
                format!(
                    "is inside \"{}\": its entrance pupil is in that medium, which absorbs from there on; radiance, \
                 irradiance and electrons are n² times those of the same light in air; to model a port, leave a hollow \
                 around the camera",
                    name(solid)
                ),
            );
        }
        if let Some(open) = around.open_solid {
            let side = if around.solid == Some(open) { "inside" } else { "outside" };
            context.note_on(
                format!("camera \"{}\"", camera.name),
                format!(
                    "whether it is inside \"{}\" depends on the viewing direction, as the surface is not closed; it is \
                     assumed to be {side}; close the mesh",
                    name(open)
                ),
            );
        }
    }
}

/// Warns of media all of whose tested points are inside a transparent solid.
pub(super) fn warn_of_enclosed_media(
    scene: &Scene,
    frames: &Frames<'_>,
    world: &World,
    material_table: &MaterialTable,
    context: &mut Context<'_>,
) {
    if !material_table.has_solids() {
        return;
    }
    let is_enclosed = |point| {
        let view = world.render_space_for_few(point, TimeInterval::default());
        Surroundings::from_view(&view, material_table).solid.is_some()
    };
    for medium in &scene.media {
        let points = inner_points(medium, frames, context);
        if !points.is_empty() && points.into_iter().all(is_enclosed) {
            let text = "it has no effect: it is inside a transparent solid, which displaces media; absorption in a \
                        solid is set by the transmittance of its material, and scattering inside it is not modelled";
            context.warn_on(format!("medium \"{}\"", medium.name.value), text);
        }
    }
}
