//! Suns and the environment: from records to the tracer's lights.

use super::context::{Context, ErrorCode};
use super::frames::Frames;
use super::lamp::CompiledLamps;
use super::opening::LampWithOpening;
use super::picture::linear;
use super::spectrum::{emitted, relative, scaled_to_luminance, scaled_to_power};
use super::{lamp, sky};
use crate::plan::SkyFacts;
use etendue_scene::record::environment::EnvironmentImage;
use etendue_scene::record::{self, Light, Scene, SunLevel};
use etendue_spectra::Spectrum;
use etendue_tracer::lights::{Environment, ImageEnvironment, MAX_LIGHT_VALUE, SUN_ANGULAR_DIAMETER_DEG, Sources, Sun};

/// Light sources other than emissive surfaces, lamps with openings that are still to be placed in the world, and the plan's facts of a sky.
pub(super) fn sources(
    scene: &Scene,
    frames: &Frames<'_>,
    context: &mut Context<'_>,
) -> (Sources, Vec<LampWithOpening>, Option<SkyFacts>) {
    let mut sources = Sources::default();
    let mut lamps_with_opening = Vec::new();
    for light in &scene.lights {
        match light {
            Light::Sun(record) => sources.suns.extend(sun(record, context)),
            lamp => match lamp::lamps(lamp, frames, context) {
                None => {}
                Some(CompiledLamps::Points(lamps)) => sources.lamps.extend(lamps),
                Some(CompiledLamps::Open(lamps)) => lamps_with_opening.push(lamps),
            },
        }
    }
    let mut facts = None;
    sources.environment = scene.environment.as_ref().and_then(|record| match record {
        record::Environment::Uniform(emission) => uniform(emission, context).map(Environment::Uniform),
        record::Environment::Image(record) => image(record, context).map(Environment::Image),
        record::Environment::Sky(record) => {
            let sky = sky::sky(record, context)?;
            sources.suns.extend(sky.sun);
            facts = Some(sky.facts);
            Some(Environment::Sky(Box::new(sky.environment)))
        }
    });
    (sources, lamps_with_opening, facts)
}

fn sun(record: &record::Sun, context: &mut Context<'_>) -> Option<Sun> {
    let elevation_rad = record.elevation_deg.value.to_radians();
    let irradiance = match &record.level {
        SunLevel::Illuminance(lux) => {
            scaled_to_luminance(&relative(record.colour.as_ref()?, context)?, lux.value, &lux.place, context)?
        }
        SunLevel::Irradiance(total) => scaled_to_power(&relative(record.colour.as_ref()?, context)?, total.value),
        SunLevel::Turbidity(turbidity) => {
            sky::normal_irradiance(turbidity, elevation_rad, &record.elevation_deg.place, context)?
        }
    };
    if record.elevation_deg.value < 0.0 {
        context.warn(format!("the sun \"{}\" is below the horizon", record.name.value));
    }
    let direction = sky::direction(elevation_rad, record.azimuth_deg.value.to_radians());
    let diameter_deg = record.angular_diameter_deg.as_ref().map_or(SUN_ANGULAR_DIAMETER_DEG, |d| d.value);
    let sun = context.accept(&record.place, Sun::from_irradiance(direction, diameter_deg, &irradiance))?;
    let by_model = matches!(record.level, SunLevel::Turbidity(_));
    let darkens = record.limb_darkening.as_ref().map_or(by_model, |l| l.value);
    Some(if darkens { sun.with_limb() } else { sun })
}

/// Radiance of uniform surroundings; reports an error if it is brighter than can be traced.
fn uniform(emission: &record::Emission, context: &mut Context<'_>) -> Option<Spectrum> {
    let radiance = emitted(emission, context)?;
    let brightest = radiance.max_value();
    if brightest > MAX_LIGHT_VALUE || brightest.is_nan() {
        let problem = format!("the environment has a radiance of {brightest:e} W·m⁻²·sr⁻¹·nm⁻¹; the maximum is 1e30");
        context.error(ErrorCode::OutOfRange, emission.level.place(), problem, "reduce the level");
    }
    Some(radiance)
}

fn image(record: &EnvironmentImage, context: &mut Context<'_>) -> Option<ImageEnvironment> {
    let Some(asset) = context.assets.images.get(&record.image_key()) else {
        context.error(
            ErrorCode::UnreadableFile,
            &record.file.place,
            "the image was not loaded",
            "give a readable file",
        );
        return None;
    };
    let (width, height) = (asset.width as usize, asset.height as usize);
    let rotation_rad = record.rotation_deg.as_ref().map_or(0.0, |r| r.value.to_radians());
    let scale = record.luminance_cd_m2_per_unit.value;
    let texels = without_negative_texels(linear(asset), record, context);
    context.accept(&record.file.place, ImageEnvironment::new(width, height, texels, scale, rotation_rad))
}

/// Texels without negative components. If there are any, the record must permit it; they are counted.
fn without_negative_texels(
    mut texels: Vec<[f32; 3]>,
    record: &EnvironmentImage,
    context: &mut Context<'_>,
) -> Vec<[f32; 3]> {
    let negative = texels.iter().filter(|t| t.iter().any(|v| *v < 0.0)).count();
    let file = record.file.value.display();
    match (negative, &record.negative_texels) {
        (0, _) => return texels,
        (_, Some(_)) => {
            context.note_on(file, format!("{negative} texels with a component below 0 set to 0, as requested"));
        }
        (_, None) => {
            let problem = format!("{negative} texels of {file} have a component below 0; light cannot be negative");
            context.error(
                ErrorCode::UnsuitableFile,
                &record.file.place,
                problem,
                "correct the image, or set negative_texels = \"zero\"",
            );
        }
    }
    texels.iter_mut().flatten().for_each(|v| *v = v.max(0.0));
    texels
}
