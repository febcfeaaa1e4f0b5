//! A lens by its surfaces.

use super::super::context::{Context, ErrorCode};
use super::super::spectrum::from_file;
use super::clear_apertures;
use super::lens_file::surface_from_file;
use super::lens_file::{self, FileAperture};
use crate::compile::stated::focus_m;
use etendue_optics::prescription::coating::Coating;
use etendue_optics::prescription::coating::InterferenceFilter;
use etendue_optics::prescription::published::{LENSES, named};
use etendue_optics::prescription::surface::ASPHERE_TERMS;
use etendue_optics::prescription::{AxialClipping, Focus, Surface, SurfaceKind};
use etendue_optics::{Lens, PRINCIPAL_NM, Prescription, PrescriptionError, PrescriptionLens, PrescriptionParameters};
use etendue_projection::Raster;
use etendue_scene::asset::PrescriptionAsset;
use etendue_scene::record::lens::prescription::{self as record, Glass, GlassConstants, IrCutCurve, SurfaceListSource};
use etendue_scene::{Place, Placed};
use etendue_spectra::glass::{self, Dispersion, GlassError};
use etendue_spectra::{Extrapolation, Spectrum};
use std::path::PathBuf;

/// Surfaces, and their source file, if any.
struct LensSurfaces<'a> {
    surfaces: Vec<Surface>,
    file: Option<&'a PrescriptionAsset>,
}

/// Lens for an image, and for the film around it.
pub(super) fn lens(
    record: &record::Prescription,
    raster: &Raster,
    film: &Raster,
    context: &mut Context<'_>,
) -> Option<Lens> {
    let source_surfaces = lens_surfaces(record, context);
    let filter = record.ir_cut.as_ref().map(|filter| ir_cut(filter, context));
    let source_surfaces = source_surfaces
        .map(|LensSurfaces { surfaces, file }| LensSurfaces { surfaces: coated(surfaces, record), file })?;
    let prescription = build(record, source_surfaces, context).map_err(|error| refuse(record, &error, context)).ok()?;
    let filter = filter.map_or(Some(None), |filter| filter.map(Some))?;
    let lens = PrescriptionLens::new(prescription, filter, film.max_radius_mm());
    let lens = context.accept(&record.place, lens)?;
    if lens.lit_radius_mm() < raster.max_radius_mm() * (1.0 - 1e-9) {
        let (lit_mm, needed) = (lens.lit_radius_mm(), raster.max_radius_mm());
        let problem =
            format!("the lens illuminates {lit_mm:.3} mm around the axis, but the image extends to {needed:.3} mm");
        context.warn_on(&record.place, problem);
    }
    Some(Lens::prescription(lens))
}

fn lens_surfaces<'a>(record: &record::Prescription, context: &mut Context<'a>) -> Option<LensSurfaces<'a>> {
    match &record.source {
        SurfaceListSource::Published(name) => published_surfaces(name, context),
        SurfaceListSource::File(file) => {
            let asset = context.assets.prescriptions.get(&(file.value.clone(), record.glass_files()))?;
            from_lens_file(asset, record, file, context)
        }
        SurfaceListSource::Surfaces(surfaces) => {
            let compiled: Vec<_> = surfaces.iter().map(|s| surface(s, record, context)).collect();
            Some(LensSurfaces { surfaces: compiled.into_iter().collect::<Option<_>>()?, file: None })
        }
    }
}

fn published_surfaces<'a>(name: &Placed<String>, context: &mut Context<'a>) -> Option<LensSurfaces<'a>> {
    let Some(lens) = named(&name.value) else {
        let known: Vec<_> = LENSES.iter().map(|lens| lens.name).collect();
        let problem = format!("no published lens is called \"{}\"", name.value);
        context.error(ErrorCode::UnknownName, &name.place, problem, format!("give one of {}", known.join(", ")));
        return None;
    };
    Some(LensSurfaces { surfaces: lens.surfaces(), file: None })
}

/// Surfaces of a lens file.
fn from_lens_file<'a>(
    asset: &'a PrescriptionAsset,
    record: &record::Prescription,
    file: &Placed<PathBuf>,
    context: &mut Context<'_>,
) -> Option<LensSurfaces<'a>> {
    let place = &file.place;
    let apertures = apertures(asset, record, file, context)?;
    let surfaces = asset.surfaces.iter().zip(apertures).map(|(surface, semi_mm)| surface_from_file(surface, semi_mm));
    let surfaces = context.accept(place, surfaces.collect::<Result<Vec<_>, _>>())?;
    Some(LensSurfaces { surfaces, file: Some(asset) })
}

fn apertures(
    asset: &PrescriptionAsset,
    record: &record::Prescription,
    Placed { value: file, place }: &Placed<PathBuf>,
    context: &mut Context<'_>,
) -> Option<Vec<f64>> {
    let count = asset.surfaces.len();
    if let Some(list) = &record.semi_apertures_mm {
        if list.len() == count {
            return Some(list.iter().map(|semi| semi.value).collect());
        }
        let place = list.first().map_or(place, |first| &first.place);
        let problem = format!("found {} semi-apertures for the {count} surfaces of the file", list.len());
        context.error(ErrorCode::WrongCount, place, problem, format!("give {count}"));
        return None;
    }
    if asset.surfaces.iter().all(|s| s.semi_aperture_mm.is_some()) {
        return asset.surfaces.iter().map(|s| s.semi_aperture_mm).collect();
    }
    match clear_apertures::find(asset) {
        Ok(clear) => {
            context.note(format!("{}: {}", file.display(), clear.note));
            Some(clear.semi_apertures_mm)
        }
        Err(reason) => {
            let without = asset.surfaces.iter().enumerate().filter(|(_, s)| s.semi_aperture_mm.is_none());
            let names: Vec<String> = without.map(|(i, s)| format!("{} (line {})", i + 1, s.line)).collect();
            let names = names.join(", ");
            let problem = format!("the file states no semi-aperture for its surfaces {names}, and {reason}");
            let remedy =
                format!("add them to the file (DIAM, CIR), or give \"semi_apertures_mm\" with {count} numbers");
            context.error(ErrorCode::UnsuitableFile, place, problem, remedy);
            None
        }
    }
}

fn surface(s: &record::Surface, lens: &record::Prescription, context: &mut Context<'_>) -> Option<Surface> {
    let number = |v: &Option<Placed<f64>>, default: f64| v.as_ref().map_or(default, |v| v.value);
    let glass = s.glass.as_ref().map_or(Some(Dispersion::AIR), |glass| dispersion(glass, lens, context))?;
    let mut asphere = [0.0; ASPHERE_TERMS];
    asphere.iter_mut().zip(s.asphere.iter().flatten()).for_each(|(to, from)| *to = from.value);
    let radius_mm = number(&s.radius_mm, f64::INFINITY);
    let is_set = |flag: &Option<Placed<bool>>| flag.as_ref().is_some_and(|flag| flag.value);
    Some(Surface {
        kind: if is_set(&s.mirror) { SurfaceKind::Mirror } else { SurfaceKind::Refracting },
        obscured_radius_mm: number(&s.obscured_radius_mm, 0.0),
        conic: number(&s.conic, 0.0),
        asphere,
        coating: s.coating.as_ref().map_or(Coating::Uncoated, coating),
        stop: is_set(&s.stop),
        ..Surface::sphere(radius_mm, number(&s.thickness_mm, 0.0), glass, s.semi_aperture_mm.value)
    })
}

/// Applies the lens's coating to the refracting surfaces against air that state none.
fn coated(mut surfaces: Vec<Surface>, record: &record::Prescription) -> Vec<Surface> {
    let Some(coating) = record.coating.as_ref().map(coating) else { return surfaces };
    let own = |i: usize| match &record.source {
        SurfaceListSource::Surfaces(list) => list[i].coating.is_some(),
        SurfaceListSource::Published(_) | SurfaceListSource::File(_) => false,
    };
    let mut before = Dispersion::AIR;
    for (i, surface) in surfaces.iter_mut().enumerate() {
        if surface.is_mirror() {
            continue;
        }
        let sides = [core::mem::replace(&mut before, surface.glass), surface.glass];
        if sides[0] != sides[1] && sides.contains(&Dispersion::AIR) && !own(i) {
            surface.coating = coating;
        }
    }
    surfaces
}

pub(in super::super) fn coating(record: &record::Coating) -> Coating {
    match record {
        record::Coating::Uncoated => Coating::Uncoated,
        record::Coating::Share(transmittance) => Coating::Constant(transmittance.value),
        record::Coating::QuarterWave(nm) => Coating::QuarterWave { design_nm: nm.value },
    }
}

fn dispersion(glass: &Glass, lens: &record::Prescription, context: &mut Context<'_>) -> Option<Dispersion> {
    let (place, dispersion) = match glass {
        Glass::Named(name) => return named_glass(name, lens, context),
        Glass::Numbers(numbers) => (&numbers.place, dispersion_from_numbers(numbers)),
    };
    context.accept(place, dispersion)
}

/// A glass by its name: of the lens's catalogues, in their order, or built in.
fn named_glass(name: &Placed<String>, lens: &record::Prescription, context: &mut Context<'_>) -> Option<Dispersion> {
    let assets = context.assets;
    for file in &lens.glasses {
        let catalogue = assets.glass_catalogues.get(&file.value)?;
        match catalogue.find(&name.value) {
            Ok(Some(glass)) => return Some(glass.dispersion),
            Ok(None) => {}
            Err(error) => {
                let problem = format!("{} (line {} of {})", error.problem, error.line, file.value.display());
                context.error(ErrorCode::UnsuitableFile, &name.place, problem, "give another glass");
                return None;
            }
        }
    }
    match glass::find(&name.value, &[]) {
        Some(matched) => Some(matched.glass.dispersion),
        None => context.accept(&name.place, glass::by_name(&name.value).map(|glass| glass.dispersion)),
    }
}

fn dispersion_from_numbers(numbers: &record::GlassNumbers) -> Result<Dispersion, GlassError> {
    match (&numbers.known, &numbers.abbe, &numbers.sellmeier_c_um2) {
        (GlassConstants::Index(n), Some(v), _) => Dispersion::from_abbe(n.value, v.value),
        (GlassConstants::Index(n), None, _) => Ok(Dispersion::Constant { n: n.value }),
        (GlassConstants::Sellmeier(b), _, c) => {
            let c_um2 = c.as_ref().map_or([0.0; 3], |c| c.value);
            Dispersion::Sellmeier { b: b.value, c_um2 }.checked()
        }
    }
}

fn ir_cut(record: &record::IrCut, context: &mut Context<'_>) -> Option<InterferenceFilter> {
    let (place, normal) = match &record.normal {
        IrCutCurve::Spectrum(file) => (&file.place, from_file(file, Extrapolation::Hold, context)?),
        IrCutCurve::Edge(edge) => {
            let half = 0.5 * record.edge_width_nm.as_ref().map_or(0.0, |w| w.value);
            let flank = [(edge.value - half, 1.0), (edge.value + half, 0.0)];
            (&edge.place, context.accept(&edge.place, Spectrum::from_points(&flank, Extrapolation::Hold))?)
        }
    };
    context.accept(place, InterferenceFilter::new(normal, record.effective_index.value))
}

/// Lens with aperture and focus, and notes on its file.
fn build(
    record: &record::Prescription,
    surfaces_of_lens: LensSurfaces<'_>,
    context: &mut Context<'_>,
) -> Result<Prescription, PrescriptionError> {
    let LensSurfaces { mut surfaces, file } = surfaces_of_lens;
    let Some(asset) = file else { return focused(record, surfaces, &Defaults::WITHOUT_FILE) };
    let file_aperture = FileAperture::new(asset, &surfaces)?;
    let stop = surfaces.iter().position(|surface| surface.stop);
    let own_mm = stop.map_or(0.0, |i| surfaces[i].semi_aperture_mm);
    if let (Some(i), Some(stop_mm)) = (stop, file_aperture.stop_mm) {
        // An f-number of the description may open the stop as far as either of the file's statements.
        let open_mm = if record.f_number.is_some() { stop_mm.max(own_mm) } else { stop_mm };
        surfaces[i].semi_aperture_mm = if asset.surfaces[i].clips_light { open_mm.min(own_mm) } else { open_mm };
    }
    let defaults = Defaults {
        distance_m: file_aperture.distance_m,
        defocus_mm: file_aperture.defocus_mm.unwrap_or(asset.defocus_mm),
        reference_nm: lens_file::reference_nm(asset),
        other_apertures: AxialClipping::Clip,
    };
    let lens = focused(record, surfaces, &defaults)?;
    lens_file::note_differences(record, asset, own_mm, &file_aperture, &lens, context);
    Ok(lens)
}

/// Values where the description states nothing.
struct Defaults {
    distance_m: f64,
    defocus_mm: f64,
    reference_nm: f64,
    other_apertures: AxialClipping,
}

impl Defaults {
    const WITHOUT_FILE: Self = Self {
        distance_m: f64::INFINITY,
        defocus_mm: 0.0,
        reference_nm: PRINCIPAL_NM,
        other_apertures: AxialClipping::Refused,
    };
}

/// Lens with the description's aperture and focus, otherwise with the defaults.
fn focused(
    record: &record::Prescription,
    surfaces: Vec<Surface>,
    defaults: &Defaults,
) -> Result<Prescription, PrescriptionError> {
    let Defaults { reference_nm, other_apertures, .. } = *defaults;
    let distance_m = record.focus_distance_m.as_ref().map_or(defaults.distance_m, focus_m);
    let focus = match &record.focus_by {
        None | Some(record::FocusingPart::Sensor) => Focus::Sensor { distance_m },
        Some(record::FocusingPart::Group(group)) => {
            let [first, last] = group.value.map(|number| number as usize - 1);
            Focus::Group { distance_m, first, last }
        }
    };
    let defocus_mm = record.defocus_mm.as_ref().map_or(defaults.defocus_mm, |d| d.value);
    let f_number = record.f_number.as_ref().map(|n| n.value);
    Prescription::new(PrescriptionParameters {
        surfaces,
        f_number,
        focus,
        defocus_mm,
        reference_nm,
        axial_clipping: other_apertures,
    })
}

/// Records, at the place of the cause, why the surfaces do not form a lens.
fn refuse(record: &record::Prescription, error: &PrescriptionError, context: &mut Context<'_>) {
    let refuse_lens =
        |place: &Place, context: &mut Context<'_>| context.error(ErrorCode::UnusableLens, place, error.to_string(), "");
    match (error, &record.source) {
        (PrescriptionError::TooFast { .. }, _) if record.f_number.is_some() => {
            record.f_number.iter().for_each(|n| refuse_lens(&n.place, context));
        }
        (PrescriptionError::Group { .. } | PrescriptionError::GroupRange { .. }, _) => match &record.focus_by {
            Some(record::FocusingPart::Group(group)) => refuse_lens(&group.place, context),
            _ => refuse_lens(&record.place, context),
        },
        (_, SurfaceListSource::Surfaces(surfaces)) => {
            let at = error.surface().and_then(|number| surfaces.get(number - 1));
            refuse_lens(at.map_or(&record.place, |surface| &surface.place), context);
        }
        (_, SurfaceListSource::File(file)) => {
            let assets = context.assets;
            let asset = assets.prescriptions.get(&(file.value.clone(), record.glass_files()));
            let at = error.surface().and_then(|number| asset?.surfaces.get(number - 1)).map(|surface| surface.line);
            let opening = asset.filter(|_| matches!(error, PrescriptionError::Cone { .. })).map(|a| a.opening_line);
            let at = at.or(opening);
            let line = at.map_or(String::new(), |line| format!(" (line {line} of {})", file.value.display()));
            context.error(ErrorCode::UnusableLens, &file.place, format!("{error}{line}"), "");
        }
        (_, SurfaceListSource::Published(name)) => refuse_lens(&name.place, context),
    }
}
