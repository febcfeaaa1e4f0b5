//! `[lens]` and the raster of `[sensor]`: from records to optics.

mod calibrated;
mod clear_apertures;
mod lens_file;
mod prescription;
mod projection;
mod projection_models;
mod ray_transfer;
#[cfg(test)]
mod tests;

use super::stated::{focus_m, transmittance};

use super::context::Context;
use super::effects::widest_film;
use etendue_optics::lens::{self, ConstantPupil, PinholeParameters, PupilParameters, ThickParameters, ThinParameters};
use etendue_optics::{LateralColour, Lens, OpticsError, TelecentricParameters};
use etendue_projection::{DistortionDirection, RadialDistortion, RadiusScales, RadiusUnit, Raster};
use etendue_scene::Placed;
use etendue_scene::record::{self, lens as description};
use glam::DVec2;
pub(super) use prescription::coating;
pub use projection_models::stated_projection;

const UM_PER_MM: f64 = 1000.0;

/// Lens of a camera, checked against its image, and the raster of its sensor.
pub(super) fn lens(camera: &record::Camera, context: &mut Context<'_>) -> Option<(Lens, Raster)> {
    let raster = raster(&camera.sensor, context)?;
    let lens = match &camera.lens {
        record::Lens::Calibrated(record) => {
            let (lens, raster) = calibrated::lens(record, &camera.sensor, &raster, context)?;
            return Some((coloured(lens, lateral_colour(&camera.lens), context)?, raster));
        }
        record::Lens::Prescription(record) => {
            let film = widest_film(camera.effects.as_ref(), &raster);
            prescription::lens(record, &raster, &film, context)
        }
        record::Lens::RayTransfer(record) => {
            let film = widest_film(camera.effects.as_ref(), &raster);
            ray_transfer::lens(record, &raster, &film, context)
        }
        record::Lens::Telecentric(record) => context.accept(&record.place, telecentric(record, &raster)),
        record::Lens::Pinhole(_) | record::Lens::Thin(_) | record::Lens::Thick(_) => {
            paraxial(&camera.lens, &raster, context)
        }
    };
    Some((coloured(lens?, lateral_colour(&camera.lens), context)?, raster))
}

/// Lateral colour added to a lens.
fn lateral_colour(record: &record::Lens) -> Option<&description::LateralColour> {
    match record {
        record::Lens::Pinhole(r) => r.lateral_colour.as_ref(),
        record::Lens::Thin(r) => r.lateral_colour.as_ref(),
        record::Lens::Thick(r) => r.lateral_colour.as_ref(),
        record::Lens::Calibrated(r) => r.lateral_colour.as_ref(),
        record::Lens::Prescription(_) | record::Lens::RayTransfer(_) | record::Lens::Telecentric(_) => None,
    }
}

fn coloured(lens: Lens, record: Option<&description::LateralColour>, context: &mut Context<'_>) -> Option<Lens> {
    let Some(record) = record else { return Some(lens) };
    let points = record.wavelength_nm.iter().zip(&record.magnification);
    let colour = LateralColour::new(points.map(|(nm, m)| (nm.value, m.value)).collect());
    context.accept(&record.place, colour.and_then(|colour| lens.with_lateral_colour(colour)))
}

fn telecentric(r: &description::Telecentric, raster: &Raster) -> Result<Lens, OpticsError> {
    Lens::telecentric(TelecentricParameters {
        metres_per_mm: r.field_width_m.value / raster.size_mm().x,
        f_number: r.f_number.value,
        transmittance: transmittance(r.transmittance.as_ref()),
    })
}

/// Raster of a sensor.
fn raster(sensor: &record::Sensor, context: &mut Context<'_>) -> Option<Raster> {
    let (width, height) = (sensor.width_px.value as usize, sensor.height_px.value as usize);
    let middle = [width as f64 / 2.0, height as f64 / 2.0];
    let principal = sensor.principal_point_px.as_ref().map_or(middle, |p| p.value);
    let pitch_mm = DVec2::splat(sensor.pixel_pitch_um.value / UM_PER_MM);
    context.accept(&sensor.place, Raster::new(width, height, pitch_mm, DVec2::from_array(principal)))
}

/// A pinhole, thin or thick lens; the other kinds have no added distortion.
fn paraxial(record: &record::Lens, raster: &Raster, context: &mut Context<'_>) -> Option<Lens> {
    let (place, focus, lens, distortion) = match record {
        record::Lens::Pinhole(r) => (&r.place, None, pinhole(r), &r.distortion),
        record::Lens::Thin(r) => (&r.place, Some(&r.focus_distance_m), thin(r), &r.distortion),
        record::Lens::Thick(r) => (&r.place, Some(&r.focus_distance_m), thick(r), &r.distortion),
        record::Lens::Prescription(_)
        | record::Lens::RayTransfer(_)
        | record::Lens::Calibrated(_)
        | record::Lens::Telecentric(_) => return None,
    };
    let place = match (&lens, focus) {
        (Err(OpticsError::FocusTooNear { .. }), Some(description::FocusDistance::Metres(metres))) => &metres.place,
        _ => place,
    };
    let lens = context.accept(place, lens)?;
    let Some(distortion) = distortion else {
        context.accept(place, lens.check(raster))?;
        return Some(lens);
    };
    let radial = context.accept(&distortion.place, radial(distortion, &lens, raster))?;
    let lens = context.accept(&distortion.place, lens.with_distortion(radial))?;
    context.accept(&distortion.place, lens.check(raster))?;
    Some(lens)
}

fn pinhole(r: &description::Pinhole) -> Result<Lens, OpticsError> {
    Lens::pinhole(PinholeParameters {
        focal_length_mm: r.focal_length_mm.value,
        f_number: r.f_number.value,
        transmittance: transmittance(r.transmittance.as_ref()),
    })
}

fn thin(r: &description::Thin) -> Result<Lens, OpticsError> {
    Lens::thin(ThinParameters {
        focal_length_mm: r.focal_length_mm.value,
        f_number: r.f_number.value,
        focus_distance_m: focus_m(&r.focus_distance_m),
        transmittance: transmittance(r.transmittance.as_ref()),
    })
}

fn thick(r: &description::Thick) -> Result<Lens, OpticsError> {
    let number = |v: &Option<Placed<f64>>| v.as_ref().map(|v| v.value);
    let aperture = |aperture: &Option<description::ClearAperture>| {
        aperture
            .as_ref()
            .map(|r| lens::ClippingAperture { position_mm: r.position_mm.value, radius_mm: r.radius_mm.value })
    };
    Lens::thick(ThickParameters {
        focal_length_mm: r.focal_length_mm.value,
        f_number: r.f_number.value,
        focus_distance_m: focus_m(&r.focus_distance_m),
        transmittance: transmittance(r.transmittance.as_ref()),
        principal_separation_mm: number(&r.principal_separation_mm).unwrap_or(0.0),
        pupils: PupilParameters {
            entrance_pupil_mm: number(&r.entrance_pupil_mm),
            exit_pupil_mm: number(&r.exit_pupil_mm),
            pupil_magnification: number(&r.pupil_magnification),
        },
        constant_pupil: match r.constant_pupil.value {
            description::Pupil::Entrance => ConstantPupil::Entrance,
            description::Pupil::Exit => ConstantPupil::Exit,
        },
        front_aperture: aperture(&r.front_aperture),
        rear_aperture: aperture(&r.rear_aperture),
    })
}

fn radial(r: &description::Distortion, lens: &Lens, raster: &Raster) -> Result<RadialDistortion, OpticsError> {
    let scales = RadiusScales {
        principal_distance_mm: lens.principal_distance_mm(),
        half_diagonal_mm: raster.half_diagonal_mm(),
        pixel_pitch_mm: raster.pitch_mm().x,
    };
    let sense = match r.direction.value {
        description::Direction::IdealToObserved => DistortionDirection::IdealToObserved,
        description::Direction::ObservedToIdeal => DistortionDirection::ObservedToIdeal,
    };
    let unit = match r.radius_unit.value {
        description::RadiusUnit::Millimetres => RadiusUnit::Millimetres,
        description::RadiusUnit::FocalLengths => RadiusUnit::FocalLengths,
        description::RadiusUnit::HalfDiagonals => RadiusUnit::HalfDiagonals,
        description::RadiusUnit::Pixels => RadiusUnit::Pixels,
    };
    let k2 = r.k2.as_ref().map_or(0.0, |k| k.value);
    Ok(RadialDistortion::new(sense, r.k1.value, k2, unit.length_mm(&scales))?)
}
