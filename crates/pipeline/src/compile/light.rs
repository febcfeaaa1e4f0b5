//! Suns and the environment: from records to the tracer's lights.

use super::context::{Context, ErrorCode};
use super::frames::Frames;
use super::lamp::Lamps;
use super::opening::OpenLamp;
use super::picture::linear;
use super::spectrum::{bright, emitted, powered, relative};
use super::{lamp, sky};
use crate::plan::SkyFacts;
use etendue_scene::record::environment::EnvironmentImage;
use etendue_scene::record::{self, Light, Scene, SunLevel};
use etendue_spectra::Spectrum;
use etendue_tracer::lights::{BRIGHTEST, Environment, ImageEnvironment, SUN_ANGULAR_DIAMETER_DEG, Sources, Sun};

/// Light sources other than emissive surfaces, lamps with openings that are still to be placed in the world, and the plan's facts of a sky.
pub(super) fn sources(
    scene: &Scene,
    frames: &Frames<'_>,
    context: &mut Context<'_>,
) -> (Sources, Vec<OpenLamp>, Option<SkyFacts>) {
    let mut sources = Sources::default();
    let mut open_lamps = Vec::new();
    for light in &scene.lights {
        match light {
            Light::Sun(record) => sources.suns.extend(sun(record, context)),
            lamp => match lamp::lamps(lamp, frames, context) {
                None => {}
                Some(Lamps::Points(lamps)) => sources.lamps.extend(lamps),
                Some(Lamps::Open(lamps)) => open_lamps.push(lamps),
            },
        }
    }
    let mut facts = None;
    sources.environment = scene.environment.as_ref().and_then(|record| match record {
        record::Environment::Uniform(emission) => uniform(emission, context).map(Environment::Uniform),
        record::Environment::Image(record) => image(record, context).map(Environment::Image),
        record::Environment::Sky(record) => {
            let made = sky::sky(record, context)?;
            sources.suns.extend(made.sun);
            facts = Some(made.facts);
            Some(Environment::Sky(Box::new(made.environment)))
        }
    });
    (sources, open_lamps, facts)
}

fn sun(record: &record::Sun, context: &mut Context<'_>) -> Option<Sun> {
    let elevation_rad = record.elevation_deg.value.to_radians();
    let irradiance = match &record.level {
        SunLevel::Illuminance(lux) => {
            bright(&relative(record.colour.as_ref()?, context)?, lux.value, &lux.place, context)?
        }
        SunLevel::Irradiance(total) => powered(&relative(record.colour.as_ref()?, context)?, total.value),
        SunLevel::Turbidity(turbidity) => {
            sky::normal_irradiance(turbidity, elevation_rad, &record.elevation_deg.place, context)?
        }
    };
    if record.elevation_deg.value < 0.0 {
        context.warn(format!("the sun \"{}\" is below the horizon", record.name.value));
    }
    let direction = sky::direction(elevation_rad, record.azimuth_deg.value.to_radians());
    let diameter_deg = record.angular_diameter_deg.as_ref().map_or(SUN_ANGULAR_DIAMETER_DEG, |d| d.value);
    let sun = context.accept(&record.place, Sun::of_irradiance(direction, diameter_deg, &irradiance))?;
    let by_model = matches!(record.level, SunLevel::Turbidity(_));
    let darkens = record.limb_darkening.as_ref().map_or(by_model, |l| l.value);
    Some(if darkens { sun.with_limb() } else { sun })
}

/// Radiance of uniform surroundings; reports an error if it is brighter than can be traced.
fn uniform(emission: &record::Emission, context: &mut Context<'_>) -> Option<Spectrum> {
    let radiance = emitted(emission, context)?;
    let brightest = radiance.max_value();
    if brightest > BRIGHTEST || brightest.is_nan() {
        let problem = format!("the environment has a radiance of {brightest:e} W·m⁻²·sr⁻¹·nm⁻¹; the maximum is 1e30");
        context.fault(ErrorCode::OutOfRange, emission.level.place(), problem, "reduce the level");
    }
    Some(radiance)
}

fn image(record: &EnvironmentImage, context: &mut Context<'_>) -> Option<ImageEnvironment> {
    let Some(picture) = context.assets.images.get(&record.file.value) else {
        context.fault(
            ErrorCode::UnreadableFile,
            &record.file.place,
            "the image was not loaded",
            "give a readable file",
        );
        return None;
    };
    let (width, height) = (picture.width as usize, picture.height as usize);
    let rotation_rad = record.rotation_deg.as_ref().map_or(0.0, |r| r.value.to_radians());
    let scale = record.luminance_cd_m2_per_unit.value;
    let texels = light_only(linear(picture), record, context);
    context.accept(&record.file.place, ImageEnvironment::new(width, height, texels, scale, rotation_rad))
}

/// Texels without negative components. If there are any, the record must permit it; they are counted.
fn light_only(mut texels: Vec<[f32; 3]>, record: &EnvironmentImage, context: &mut Context<'_>) -> Vec<[f32; 3]> {
    let negative = texels.iter().filter(|t| t.iter().any(|v| *v < 0.0)).count();
    let file = record.file.value.display();
    match (negative, &record.negative_texels) {
        (0, _) => return texels,
        (_, Some(_)) => {
            context.remark_on(file, format!("{negative} texels with a component below 0 set to 0, as requested"));
        }
        (_, None) => {
            let problem = format!("{negative} texels of {file} have a component below 0; light cannot be negative");
            context.fault(
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
