//! Suns and the environment: from records to the tracer's lights.

use super::context::Context;
use super::spectrum::{bright, emitted, relative};
use etendue_core::maths::f64::sin_cos;
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_scene::record::environment::EnvironmentImage;
use etendue_scene::record::{self, Light, Scene, SunLevel};
use etendue_spectra::{Spectrum, colour};
use etendue_tracer::lights::{Environment, ImageEnvironment, SUN_ANGULAR_DIAMETER_DEG, Sources, Sun};
use glam::DVec3;

/// The lights of a scene that are no surfaces.
pub(super) fn sources(scene: &Scene, context: &mut Context<'_>) -> Sources {
    let suns = scene.lights.iter().filter_map(|Light::Sun(record)| sun(record, context)).collect();
    Sources { suns, lamps: vec![], environment: environment(scene, context) }
}

fn sun(record: &record::Sun, context: &mut Context<'_>) -> Option<Sun> {
    let relative = relative(&record.colour, context)?;
    let irradiance = match &record.level {
        SunLevel::Illuminance(lux) => bright(&relative, lux.value, &lux.place, context)?,
        SunLevel::Irradiance(total) => powered(&relative, total.value),
    };
    if record.elevation_deg.value < 0.0 {
        context.remark(format!("the sun \"{}\" stands below the horizon", record.name.value));
    }
    let (sin_e, cos_e) = sin_cos(record.elevation_deg.value.to_radians());
    let (sin_a, cos_a) = sin_cos(record.azimuth_deg.value.to_radians());
    let direction = DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
    let diameter_deg = record.angular_diameter_deg.as_ref().map_or(SUN_ANGULAR_DIAMETER_DEG, |d| d.value);
    context.accept(&record.place, Sun::of_irradiance(direction, diameter_deg, &irradiance))
}

/// A relative spectrum scaled to a power summed over all legal wavelengths.
fn powered(relative: &Spectrum, total: f64) -> Spectrum {
    use etendue_core::wavelength::{LONGEST_NM, SHORTEST_NM};
    relative.scaled(total / relative.integral(SHORTEST_NM, LONGEST_NM))
}

/// What surrounds the scene; `None` where nothing does or it is faulty.
fn environment(scene: &Scene, context: &mut Context<'_>) -> Option<Environment> {
    match scene.environment.as_ref()? {
        record::Environment::Uniform(emission) => emitted(emission, context).map(Environment::Uniform),
        record::Environment::Image(record) => image(record, context).map(Environment::Image),
    }
}

fn image(record: &EnvironmentImage, context: &mut Context<'_>) -> Option<ImageEnvironment> {
    let Some(picture) = context.assets.images.get(&record.file.value) else {
        context.fault(&record.file.place, "the picture was not loaded", "give a readable file");
        return None;
    };
    let size = (picture.width as usize, picture.height as usize);
    let rotation_rad = record.rotation_deg.as_ref().map_or(0.0, |r| r.value.to_radians());
    let scale = record.luminance_cd_m2_per_unit.value;
    let texels = light_only(linear(picture), record, context);
    context.accept(&record.file.place, ImageEnvironment::new(size, texels, scale, rotation_rad))
}

/// Texels without negative components. Where there are any, the record must ask for it, and they are counted.
fn light_only(mut texels: Vec<[f32; 3]>, record: &EnvironmentImage, context: &mut Context<'_>) -> Vec<[f32; 3]> {
    let negative = texels.iter().filter(|t| t.iter().any(|v| *v < 0.0)).count();
    let file = record.file.value.display();
    match (negative, &record.negative_texels) {
        (0, _) => return texels,
        (_, Some(_)) => context.remark(format!("{file}: {negative} texels with a component below 0 made 0, as asked")),
        (_, None) => {
            let problem = format!("{negative} texels of {file} have a component below 0, which no light has");
            context.fault(&record.file.place, problem, "correct the picture, or say negative_texels = \"zero\"");
        }
    }
    texels.iter_mut().flatten().for_each(|v| *v = v.max(0.0));
    texels
}

/// Linear sRGB of a picture; bytes are taken as sRGB-encoded.
fn linear(picture: &ImageAsset) -> Vec<[f32; 3]> {
    match &picture.pixels {
        ImagePixels::Gray8(p) => p.iter().map(|g| [colour::decode_byte(*g); 3]).collect(),
        ImagePixels::Gray16(p) => p.iter().map(|g| [f32::from(*g) / 65_535.0; 3]).collect(),
        ImagePixels::Rgb8(p) => p.iter().map(|c| c.map(colour::decode_byte)).collect(),
        ImagePixels::Rgba8(p) => p.iter().map(|[r, g, b, _]| [*r, *g, *b].map(colour::decode_byte)).collect(),
        ImagePixels::Rgb32F(p) => p.clone(),
        ImagePixels::Rgba32F(p) => p.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect(),
    }
}
