//! `[effects]`: from the record to the optical effects.

use super::context::{Context, ErrorCode};
use super::picture::grey;
use super::point_spread_files;
use crate::plan::Route;
use etendue_optics::effects::{
    Glare, GlareParameters, PointSpread, Psf, PsfParameters, SpreadImage, SpreadImageParameters, spread_of_modulation,
};
use etendue_optics::effects::{MAX_MARGIN, SpreadMethod, Zernike, ZernikeTerm};
use etendue_optics::ghosts::GhostSettings;
use etendue_optics::{Effects, EffectsError, EffectsParameters, Lens};
use etendue_projection::Raster;
use etendue_scene::Placed;
use etendue_scene::asset::LensQuantity;
use etendue_scene::record::effects::{ModulationSource, TermSize, ZernikeIndex};
use etendue_scene::record::{self, effects as description};
use std::path::PathBuf;

const NM_PER_UM: f64 = 1000.0;
const UM_PER_MM: f64 = 1000.0;

/// Effects on the irradiance of an image; none for an empty record.
pub(super) fn effects(
    record: Option<&record::Effects>,
    lens: &Lens,
    image_raster: &Raster,
    context: &mut Context<'_>,
) -> Option<Effects> {
    let Some(record) = record else { return Some(Effects::default()) };
    let psf = match &record.psf {
        Some(record) => Some(point_spread(record, lens, image_raster, context)?),
        None => None,
    };
    let glare = match &record.glare {
        Some(record) => Some(context.accept(&record.place, glare(record))?),
        None => None,
    };
    let ghosts = match &record.ghosts {
        Some(requested) if requested.value => Some(ghosts(record, requested, lens, context)?),
        _ => None,
    };
    let requested = record.psf.as_ref().and_then(|psf| psf.spread_by.as_ref());
    let spread_by = requested.map(|requested| match requested.value {
        description::PsfMethod::Film => SpreadMethod::Film,
        description::PsfMethod::Samples => SpreadMethod::Samples,
    });
    let margin = record.margin.as_ref().map(|m| m.value);
    let effects = Effects::new(EffectsParameters { psf, spread_by, glare, ghosts, margin }, image_raster);
    let place = match (&effects, requested) {
        (Err(EffectsError::WideCore { .. }), Some(requested)) => &requested.place,
        _ => record.margin.as_ref().map_or(&record.place, |m| &m.place),
    };
    context.accept(place, effects)
}

/// Refuses displaced samples on a route other than through the lens.
pub(super) fn check_spread_by(record: Option<&record::Effects>, route: &Route, context: &mut Context<'_>) {
    let requested = record.and_then(|effects| effects.psf.as_ref()).and_then(|psf| psf.spread_by.as_ref());
    if let (Some(requested), Route::Pupil(_)) = (requested, route)
        && requested.value == description::PsfMethod::Samples
    {
        let problem = "samples are displaced on the sensor, but route = \"pupil\" has no samples there";
        context.error(
            ErrorCode::NotModelled,
            &requested.place,
            problem,
            "remove the key, or render with route = \"lens\"",
        );
    }
}

fn ghosts(
    record: &record::Effects,
    requested: &Placed<bool>,
    lens: &Lens,
    context: &mut Context<'_>,
) -> Option<GhostSettings> {
    if !matches!(lens, Lens::Prescription(_)) {
        let problem =
            format!("ghosts are reflections between the surfaces of a prescription; the lens is a {}", lens.kind());
        context.error(
            ErrorCode::NotModelled,
            &requested.place,
            problem,
            "give a lens with type = \"prescription\", or remove the key",
        );
        return None;
    }
    let reflectance = record.sensor_reflectance.as_ref();
    let place = reflectance.map_or(&requested.place, |r| &r.place);
    context.accept(place, GhostSettings::new(reflectance.map_or(0.0, |r| r.value)))
}

/// Largest possible film of a camera's effects.
pub(super) fn widest_film(record: Option<&record::Effects>, image_raster: &Raster) -> Raster {
    let Some(record) = record else { return *image_raster };
    let margin = record.margin.as_ref().map_or(MAX_MARGIN, |m| m.value);
    let pixels = |count: usize| (margin * count as f64).ceil() as usize;
    image_raster.widened([pixels(image_raster.width()), pixels(image_raster.height())])
}

fn glare(record: &description::Glare) -> Result<Glare, EffectsError> {
    Glare::new(GlareParameters {
        scatter: record.scatter.value,
        core_um: record.core_um.value,
        exponent: record.exponent.value,
        reach_mm: record.reach_mm.as_ref().map(|r| r.value),
    })
}

fn point_spread(
    record: &description::Psf,
    lens: &Lens,
    image_raster: &Raster,
    context: &mut Context<'_>,
) -> Option<PointSpread> {
    if let Some(table) = &record.mtf {
        return modulation(table, image_raster, context).map(PointSpread::Image);
    }
    if !record.files.is_empty() {
        let patches = record.patches.as_ref().map(counts);
        return point_spread_files::table(&record.files, patches, lens, image_raster, context).map(PointSpread::Table);
    }
    match (&record.image, &record.image_pitch_um) {
        (Some(file), Some(pitch)) => {
            let wavelength = record.image_wavelength_nm.as_ref();
            image(file, pitch, wavelength, image_raster, context).map(PointSpread::Image)
        }
        _ => context.accept(&record.place, psf(record, lens, image_raster)).map(PointSpread::Aperture),
    }
}

/// A point spread from an image; errors in its distances are reported at the distance.
fn image(
    file: &Placed<PathBuf>,
    pitch: &Placed<f64>,
    wavelength: Option<&Placed<f64>>,
    image_raster: &Raster,
    context: &mut Context<'_>,
) -> Option<SpreadImage> {
    let (width, light) = grey(file, context)?;
    let (pitch_um, wavelength_nm) = (pitch.value, wavelength.map(|nm| nm.value));
    let image = SpreadImage::new(
        SpreadImageParameters { width, light, pitch_um, wavelength_nm, deviation: None },
        image_raster,
    );
    let of_pitch = matches!(image, Err(EffectsError::Coarse { .. }));
    context.accept(if of_pitch { &pitch.place } else { &file.place }, image)
}

/// A point spread from a table of modulation, with notes on the conversion of a file.
fn modulation(
    table: &description::ModulationTable,
    image_raster: &Raster,
    context: &mut Context<'_>,
) -> Option<SpreadImage> {
    let (place, points) = match &table.source {
        ModulationSource::Frequencies(frequencies) => {
            let points = frequencies.iter().zip(table.modulation.iter().flatten());
            (&table.place, points.map(|(f, m)| (f.value, m.value)).collect())
        }
        ModulationSource::File(file) => {
            let assets = context.assets;
            let asset = assets.lens_tables.get(&(file.value.clone(), LensQuantity::Modulation))?;
            asset.notes.iter().for_each(|note| context.note_on(file.value.display(), note));
            (&file.place, asset.points.clone())
        }
    };
    let pixel_um = image_raster.pitch_mm().min_element() * UM_PER_MM;
    let image = spread_of_modulation(&points, pixel_um).and_then(|samples| SpreadImage::new(samples, image_raster));
    context.accept(place, image)
}

fn psf(record: &description::Psf, lens: &Lens, image_raster: &Raster) -> Result<Psf, EffectsError> {
    let number = |key: &Option<etendue_scene::Placed<f64>>| key.as_ref().map_or(0.0, |v| v.value);
    let parameters = PsfParameters {
        blades: record.blades.as_ref().map_or(0, |b| b.value as u32),
        curvature: number(&record.blade_curvature),
        rotation_rad: number(&record.rotation_deg).to_radians(),
        obstruction: record.obstruction.as_ref().map_or(lens.obscured_ratio(), |ratio| ratio.value),
        wavefront: record.wavefront.iter().map(term).collect(),
        reach_mm: record.reach_mm.as_ref().map(|r| r.value),
        patches: record.patches.as_ref().map(counts),
    };
    Psf::new(parameters, lens, image_raster)
}

/// Number of patches, columns and rows.
fn counts(patches: &Placed<[Placed<u64>; 2]>) -> [usize; 2] {
    [patches.value[0].value as usize, patches.value[1].value as usize]
}

/// A term whose index has been checked by the record.
fn term(record: &description::ZernikeTerm) -> ZernikeTerm {
    let zernike = match &record.index {
        ZernikeIndex::Noll(index) => Zernike::noll(index.value as u32),
        ZernikeIndex::Osa(index) => Zernike::osa(index.value as u32),
    };
    let (sizes, um) = match &record.size {
        TermSize::Micrometres(sizes) => (sizes, 1.0),
        TermSize::Waves(sizes) => (sizes, record.wavelength_nm.as_ref().map_or(0.0, |nm| nm.value / NM_PER_UM)),
    };
    ZernikeTerm {
        zernike: zernike.expect("an index that was read is one of the known"),
        field_mm: record.field_radius_mm.iter().map(|r| r.value).collect(),
        rms_um: sizes.iter().map(|s| s.value * um).collect(),
    }
}
