//! Materials from a mesh's own file.

use super::super::context::{Context, ErrorCode};
use super::picture::Pictures;
use etendue_scene::Place;
use etendue_scene::asset::{SlotMaterial, SlotReflectance, SlotSurface};
use etendue_spectra::upsample;
use etendue_tracer::materials::{CoatedDiffuse, Reflectance, Surface};
use std::path::Path;

/// Reflection of a slot. Records an error at `place` if the file does not state it.
pub(super) fn surface(
    file: &Path,
    slot: &SlotMaterial,
    place: &Place,
    images: &mut Pictures,
    context: &mut Context<'_>,
) -> Option<Surface> {
    let Some(surface) = &slot.surface else {
        let problem = format!("{} states no reflectance for its material \"{}\"", file.display(), slot.name);
        let remedy = match slot.name.is_empty() {
            true => "name a material of the scene: material = …".to_owned(),
            false => format!("name a material of the scene: material = …, or materials = {{ \"{}\" = … }}", slot.name),
        };
        context.error(ErrorCode::UnsuitableFile, place, problem, remedy);
        return None;
    };
    let (SlotSurface::Diffuse { reflectance } | SlotSurface::Coated { reflectance, .. }) = surface else { return None };
    let base = match reflectance {
        SlotReflectance::LinearSrgb(rgb) => {
            Reflectance::Spectrum(upsample::reflectance_spectrum(rgb.map(|v| v as f32)))
        }
        SlotReflectance::Image(image) => Reflectance::Texture(images.slot_texture(image, place, context)?),
    };
    match surface {
        SlotSurface::Diffuse { .. } | SlotSurface::Layers(_) => Some(base.into()),
        SlotSurface::Coated { index, alpha, .. } => {
            context.accept(place, CoatedDiffuse::new(base, *index, *alpha)).map(Surface::from)
        }
    }
}

/// Returns true if a slot's file gives it an image.
pub(in super::super) fn has_picture(slot: &SlotMaterial) -> bool {
    slot.surface.as_ref().is_some_and(|surface| match surface {
        SlotSurface::Layers(layers) => layers.has_picture(),
        _ => !surface.files().is_empty(),
    })
}
