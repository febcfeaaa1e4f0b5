//! Lamps: from records to the tracer's lamps.

use super::context::{Context, ErrorCode};
use super::frames::Frames;
use super::lamp_motion::lamp_motions;
use super::modulation;
use super::opening::LampWithOpening;
use super::opening::opening;
use super::picture::linear;
use super::spectrum::{relative, scaled_to_luminance, scaled_to_power};
use etendue_core::{Motion, Waveform};
use etendue_scene::Place;
use etendue_scene::asset::{PhotometryAsset, PhotometryAxes};
use etendue_scene::record::light::placement::MainAxis;
use etendue_scene::record::light::{
    Beam, HeadLamp, LampInstance, LampOpening, LampPlacement, LampStrength, Mask, MeasuredLamp, MeasuredStrength,
    Modulation, PointLamp, SpotLamp, Traffic,
};
use etendue_scene::record::transform::yaw_pitch_roll;
use etendue_scene::record::{Light, LightColour};
use etendue_spectra::{Spectrum, colour};
use etendue_tracer::lights::{Cone, Lamp, MaskImage, PhotometricAxes, PhotometricGrid, Profile, head_lamp};
use glam::DMat3;
use std::sync::Arc;

/// A lamp with all its instances.
pub(super) enum CompiledLamps {
    /// As points.
    Points(Vec<Lamp>),
    /// With an opening that is still to be placed in the world.
    Open(LampWithOpening),
}

/// Properties that the lamps of a kind share, except their intensity.
struct LampKind<'a> {
    name: &'a str,
    placement: &'a LampPlacement,
    main_axis: MainAxis,
    /// Rotation in their own frame.
    rotation: DMat3,
    opening: Option<&'a LampOpening>,
    modulation: Option<&'a Modulation>,
    file: Option<&'a PhotometryAsset>,
    place: &'a Place,
}

/// Lamps of a light; `None` if it is invalid, or a sun.
pub(super) fn lamps(light: &Light, frames: &Frames<'_>, context: &mut Context<'_>) -> Option<CompiledLamps> {
    match light {
        Light::Sun(_) => None,
        Light::Point(lamp) => point(lamp, frames, context),
        Light::Spot(lamp) => spot(lamp, frames, context),
        Light::Measured(lamp) => measured(lamp, frames, context),
        Light::HeadLamp(lamp) => head_lamp(lamp, frames, context),
    }
}

fn point(lamp: &PointLamp, frames: &Frames<'_>, context: &mut Context<'_>) -> Option<CompiledLamps> {
    let intensity = intensity(&lamp.strength, &lamp.colour, &Profile::Isotropic, context)?;
    let profile = masked(Profile::Isotropic, lamp.mask.as_ref(), context)?;
    let kind = LampKind {
        name: &lamp.name.value,
        placement: &lamp.placement,
        main_axis: MainAxis::Forward,
        rotation: DMat3::IDENTITY,
        opening: lamp.opening.as_ref(),
        modulation: lamp.modulation.as_ref(),
        file: None,
        place: &lamp.place,
    };
    lamp_instances(&kind, intensity, profile, frames, context)
}

fn spot(lamp: &SpotLamp, frames: &Frames<'_>, context: &mut Context<'_>) -> Option<CompiledLamps> {
    let outer = lamp.field_angle_deg.value;
    let inner = lamp.inner_angle_deg.as_ref().map_or(outer, |a| a.value);
    let half_rad = |full_deg: f64| 0.5 * full_deg.to_radians();
    let cone = context.accept(&lamp.field_angle_deg.place, Cone::new(half_rad(inner), half_rad(outer)))?;
    let profile = Profile::Cone(cone);
    let intensity = intensity(&lamp.strength, &lamp.colour, &profile, context)?;
    let profile = masked(profile, lamp.mask.as_ref(), context)?;
    let kind = LampKind {
        name: &lamp.name.value,
        placement: &lamp.placement,
        main_axis: MainAxis::Forward,
        rotation: DMat3::IDENTITY,
        opening: lamp.opening.as_ref(),
        modulation: lamp.modulation.as_ref(),
        file: None,
        place: &lamp.place,
    };
    lamp_instances(&kind, intensity, profile, frames, context)
}

fn measured(lamp: &MeasuredLamp, frames: &Frames<'_>, context: &mut Context<'_>) -> Option<CompiledLamps> {
    let Some(asset) = context.assets.photometry.get(&lamp.file.value) else {
        context.error(
            ErrorCode::UnreadableFile,
            &lamp.file.place,
            "the photometric file was not loaded",
            "give a readable file",
        );
        return None;
    };
    asset.report.iter().for_each(|line| context.note(line));
    let (axes, main) = match asset.axes {
        PhotometryAxes::A => (PhotometricAxes::A, MainAxis::Forward),
        PhotometryAxes::B => (PhotometricAxes::B, MainAxis::Forward),
        PhotometryAxes::C => (PhotometricAxes::C, MainAxis::Downward),
    };
    if let (Some(mask), MainAxis::Downward) = (&lamp.mask, main) {
        let problem = "a mask shapes light along +x, but this light (photometry of type C) emits downwards";
        context.error(ErrorCode::UnsuitableFile, &mask.place, problem, "remove it, or give a file of type A or B");
        return None;
    }
    let floats = |values: &[f64]| values.iter().map(|v| *v as f32).collect::<Vec<_>>();
    let photometric_grid =
        PhotometricGrid::new(axes, floats(&asset.vertical_deg), floats(&asset.horizontal_deg), floats(&asset.candela));
    let profile = Profile::PhotometricGrid(context.accept(&lamp.file.place, photometric_grid)?);
    let intensity = scale_from_candela(lamp.strength.as_ref(), &lamp.colour, &profile, context)?;
    let profile = masked(profile, lamp.mask.as_ref(), context)?;
    let kind = LampKind {
        name: &lamp.name.value,
        placement: &lamp.placement,
        main_axis: main,
        rotation: DMat3::IDENTITY,
        opening: lamp.opening.as_ref(),
        modulation: lamp.modulation.as_ref(),
        file: Some(asset),
        place: &lamp.place,
    };
    lamp_instances(&kind, intensity, profile, frames, context)
}

fn head_lamp(lamp: &HeadLamp, frames: &Frames<'_>, context: &mut Context<'_>) -> Option<CompiledLamps> {
    let profile = Profile::PhotometricGrid(match (lamp.beam.value, lamp.traffic.as_ref().map(|t| t.value)) {
        (Beam::High, _) => head_lamp::high_beam(),
        (Beam::Low, Some(Traffic::Left)) => head_lamp::low_beam(head_lamp::Traffic::Left),
        (Beam::Low, Some(Traffic::Right) | None) => head_lamp::low_beam(head_lamp::Traffic::Right),
    });
    let intensity = scale_from_candela(lamp.strength.as_ref(), &lamp.colour, &profile, context)?;
    let profile = masked(profile, lamp.mask.as_ref(), context)?;
    let down_deg = lamp.aim_down_deg.as_ref().map_or(0.0, |d| d.value);
    let turn = yaw_pitch_roll([0.0, down_deg, 0.0]);
    let kind = LampKind {
        name: &lamp.name.value,
        placement: &lamp.placement,
        main_axis: MainAxis::Forward,
        rotation: turn,
        opening: lamp.opening.as_ref(),
        modulation: lamp.modulation.as_ref(),
        file: None,
        place: &lamp.place,
    };
    lamp_instances(&kind, intensity, profile, frames, context)
}

/// A profile with its mask.
fn masked(profile: Profile, mask: Option<&Mask>, context: &mut Context<'_>) -> Option<Profile> {
    let Some(mask) = mask else { return Some(profile) };
    let Some(asset) = context.assets.images.get(&mask.file.value) else {
        context.error(ErrorCode::UnreadableFile, &mask.file.place, "the image was not loaded", "give a readable file");
        return None;
    };
    let (width, height) = (asset.width as usize, asset.height as usize);
    let texels = linear(asset).into_iter().map(luminance).collect();
    let [horizontal_rad, vertical_rad] = mask.field_deg.value.map(f64::to_radians);
    let image =
        context.accept(&mask.file.place, MaskImage::new(width, height, texels, horizontal_rad, vertical_rad))?;
    Some(Profile::masked(profile, Profile::MaskImage(image)))
}

/// Luminance of a linear colour, 1 for white.
fn luminance([r, g, b]: [f32; 3]) -> f32 {
    let [wr, wg, wb] = colour::XYZ_FROM_SRGB[1].map(|w| w as f32);
    // Greys remain unchanged.
    if r == g && g == b { r } else { wr * r + wg * g + wb * b }
}

/// Spectral intensity (W·sr⁻¹·nm⁻¹) where the profile is 1.
fn intensity(
    strength: &LampStrength,
    colour: &LightColour,
    profile: &Profile,
    context: &mut Context<'_>,
) -> Option<Spectrum> {
    let relative = relative(colour, context)?;
    match strength {
        LampStrength::LuminousFlux(lm) => {
            scaled_to_luminance(&relative, lm.value / profile.flux_sr(), &lm.place, context)
        }
        LampStrength::Intensity(cd) => scaled_to_luminance(&relative, cd.value, &cd.place, context),
        LampStrength::RadiantFlux(w) => Some(scaled_to_power(&relative, w.value / profile.flux_sr())),
    }
}

/// Spectral intensity per candela of the profile, scaled as requested.
fn scale_from_candela(
    strength: Option<&MeasuredStrength>,
    colour: &LightColour,
    profile: &Profile,
    context: &mut Context<'_>,
) -> Option<Spectrum> {
    let relative = relative(colour, context)?;
    let factor = match strength {
        None => 1.0,
        Some(MeasuredStrength::Scale(scale)) => scale.value,
        Some(MeasuredStrength::LuminousFlux(lm)) if profile.flux_sr() > 0.0 => lm.value / profile.flux_sr(),
        Some(MeasuredStrength::LuminousFlux(lm)) => {
            context.error(
                ErrorCode::UnsuitableFile,
                &lm.place,
                "the distribution is zero everywhere, so it cannot be scaled to a flux",
                "remove it",
            );
            return None;
        }
    };
    scaled_to_luminance(&relative, factor, colour.place(), context)
}

/// A lamp with all its instances.
fn lamp_instances(
    kind: &LampKind<'_>,
    intensity: Spectrum,
    profile: Profile,
    frames: &Frames<'_>,
    context: &mut Context<'_>,
) -> Option<CompiledLamps> {
    let opening = match kind.opening {
        None => None,
        Some(record) => Some(opening(record, kind.main_axis, kind.file, &profile, context)?),
    };
    let motions = lamp_motions(kind.placement, kind.main_axis, kind.rotation, frames, context)?;
    let (intensity, profile) = (Arc::new(intensity), Arc::new(profile));
    let attenuation = kind.placement.attenuation_per_m.as_ref().map_or(0.0, |a| a.value);
    let waveform = match kind.modulation {
        None => None,
        Some(record) => Some((record, modulation::waveform(record, context)?)),
    };
    let lamp = |(number, to_world): (usize, Motion)| {
        let moving_lamp = Lamp::moving(to_world, intensity.clone(), profile.clone());
        let lamp = context.accept(kind.place, moving_lamp.and_then(|lamp| lamp.attenuated(attenuation)))?;
        let Some((record, waveform)) = &waveform else { return Some(lamp) };
        let waveform = waveform.clone().later(delay_s(kind, record, waveform, number));
        context.accept(record.place(), lamp.modulated(waveform))
    };
    let lamps: Vec<Lamp> = motions.into_iter().enumerate().map(lamp).collect::<Option<_>>()?;
    Some(match opening {
        None => CompiledLamps::Points(lamps),
        Some(opening) => {
            let named_lamps = names(kind).into_iter().zip(lamps).collect();
            CompiledLamps::Open(LampWithOpening { lamps: named_lamps, opening, place: kind.place.clone() })
        }
    })
}

/// Additional delay of the modulation of the lamp's instance `number` relative to its record, s.
fn delay_s(kind: &LampKind<'_>, record: &Modulation, waveform: &Waveform, number: usize) -> f64 {
    let instance = kind.placement.instances.get(number);
    let own_s = instance.and_then(|instance| instance.modulation_delay_s.as_ref()).map_or(0.0, |delay| delay.value);
    let random = modulation::has_random_phases(record);
    let name = || format!("{} {}", kind.name, number + 1);
    own_s + if random { modulation::random_delay_s(waveform, &name()) } else { 0.0 }
}

/// Names of a lamp's instances: the stated ones, or the lamp's with a number if there are several.
fn names(kind: &LampKind<'_>) -> Vec<String> {
    match &kind.placement.instances[..] {
        [] => vec![kind.name.to_owned()],
        many => {
            let numbered = |(i, instance): (usize, &LampInstance)| match &instance.name {
                Some(name) => name.value.clone(),
                None => format!("{} {}", kind.name, i + 1),
            };
            many.iter().enumerate().map(numbered).collect()
        }
    }
}
