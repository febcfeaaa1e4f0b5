//! A lens by its surfaces.

use super::super::context::{Context, ErrorCode};
use super::super::spectrum::from_file;
use super::clear_apertures;
use super::lens_file::of_file;
use super::lens_file::{self, Stated};
use crate::compile::stated::focus_m;
use etendue_optics::prescription::coating::Coating;
use etendue_optics::prescription::coating::InterferenceFilter;
use etendue_optics::prescription::published::{LENSES, named};
use etendue_optics::prescription::surface::ASPHERE_TERMS;
use etendue_optics::prescription::{Focus, OtherRims, Surface};
use etendue_optics::{Lens, PRINCIPAL_NM, Prescribed, Prescription, PrescriptionError, PrescriptionParameters};
use etendue_projection::Raster;
use etendue_scene::asset::PrescriptionAsset;
use etendue_scene::record::lens::prescription::{self as record, Glass, GlassKnown, IrCutCurve, Source};
use etendue_scene::{Place, Placed};
use etendue_spectra::glass::{self, Dispersion, GlassError};
use etendue_spectra::{Outside, Spectrum};
use std::path::PathBuf;

/// Surfaces, and their source file, if any.
struct Given<'a> {
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
    let given = given(record, context);
    let filter = record.ir_cut.as_ref().map(|filter| ir_cut(filter, context));
    let given = given.map(|Given { surfaces, file }| Given { surfaces: coated(surfaces, record), file })?;
    let prescription = made(record, given, context).map_err(|error| refuse(record, &error, context)).ok()?;
    let filter = filter.map_or(Some(None), |filter| filter.map(Some))?;
    let lens = Prescribed::new(prescription, filter, film.max_radius_mm());
    let lens = context.accept(&record.place, lens)?;
    if lens.lit_radius_mm() < raster.max_radius_mm() * (1.0 - 1e-9) {
        let (lit, needed) = (lens.lit_radius_mm(), raster.max_radius_mm());
        let told = format!("the lens illuminates {lit:.3} mm around the axis, but the image extends to {needed:.3} mm");
        context.warn_on(&record.place, told);
    }
    Some(Lens::prescription(lens))
}

fn given<'a>(record: &record::Prescription, context: &mut Context<'a>) -> Option<Given<'a>> {
    match &record.source {
        Source::Published(name) => published(name, context),
        Source::File(file) => {
            let asset = context.assets.prescriptions.get(&file.value)?;
            from_lens_file(asset, record, file, context)
        }
        Source::Surfaces(surfaces) => {
            let made: Vec<_> = surfaces.iter().map(|s| surface(s, context)).collect();
            Some(Given { surfaces: made.into_iter().collect::<Option<_>>()?, file: None })
        }
    }
}

fn published<'a>(name: &Placed<String>, context: &mut Context<'a>) -> Option<Given<'a>> {
    let Some(lens) = named(&name.value) else {
        let known: Vec<_> = LENSES.iter().map(|lens| lens.name).collect();
        let problem = format!("no published lens is called \"{}\"", name.value);
        context.fault(ErrorCode::UnknownName, &name.place, problem, format!("give one of {}", known.join(", ")));
        return None;
    };
    Some(Given { surfaces: lens.surfaces(), file: None })
}

/// Surfaces of a lens file.
fn from_lens_file<'a>(
    asset: &'a PrescriptionAsset,
    record: &record::Prescription,
    file: &Placed<PathBuf>,
    context: &mut Context<'_>,
) -> Option<Given<'a>> {
    let place = &file.place;
    let apertures = apertures(asset, record, file, context)?;
    let surfaces = asset.surfaces.iter().zip(apertures).map(|(surface, semi_mm)| of_file(surface, semi_mm));
    let surfaces = context.accept(place, surfaces.collect::<Result<Vec<_>, _>>())?;
    Some(Given { surfaces, file: Some(asset) })
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
        context.fault(ErrorCode::WrongCount, place, problem, format!("give {count}"));
        return None;
    }
    if asset.surfaces.iter().all(|s| s.semi_aperture_mm.is_some()) {
        return asset.surfaces.iter().map(|s| s.semi_aperture_mm).collect();
    }
    match clear_apertures::found(asset) {
        Ok(found) => {
            context.remark(format!("{}: {}", file.display(), found.told));
            Some(found.semi_apertures_mm)
        }
        Err(reason) => {
            let without = asset.surfaces.iter().enumerate().filter(|(_, s)| s.semi_aperture_mm.is_none());
            let names: Vec<String> = without.map(|(i, s)| format!("{} (line {})", i + 1, s.line)).collect();
            let names = names.join(", ");
            let problem = format!("the file states no semi-aperture for its surfaces {names}, and {reason}");
            let remedy =
                format!("add them to the file (DIAM, CIR), or give \"semi_apertures_mm\" with {count} numbers");
            context.fault(ErrorCode::UnsuitableFile, place, problem, remedy);
            None
        }
    }
}

fn surface(s: &record::Surface, context: &mut Context<'_>) -> Option<Surface> {
    let number = |v: &Option<Placed<f64>>, default: f64| v.as_ref().map_or(default, |v| v.value);
    let glass = s.glass.as_ref().map_or(Some(Dispersion::AIR), |glass| dispersion(glass, context))?;
    let mut asphere = [0.0; ASPHERE_TERMS];
    asphere.iter_mut().zip(s.asphere.iter().flatten()).for_each(|(to, from)| *to = from.value);
    let radius_mm = number(&s.radius_mm, f64::INFINITY);
    Some(Surface {
        conic: number(&s.conic, 0.0),
        asphere,
        coating: s.coating.as_ref().map_or(Coating::Uncoated, coating),
        stop: s.stop.as_ref().is_some_and(|stop| stop.value),
        ..Surface::sphere(radius_mm, number(&s.thickness_mm, 0.0), glass, s.semi_aperture_mm.value)
    })
}

/// Applies the lens's coating to the surfaces against air that state none.
fn coated(mut surfaces: Vec<Surface>, record: &record::Prescription) -> Vec<Surface> {
    let Some(coating) = record.coating.as_ref().map(coating) else { return surfaces };
    let own = |i: usize| match &record.source {
        Source::Surfaces(list) => list[i].coating.is_some(),
        Source::Published(_) | Source::File(_) => false,
    };
    let mut before = Dispersion::AIR;
    for (i, surface) in surfaces.iter_mut().enumerate() {
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
        record::Coating::Share(share) => Coating::Constant(share.value),
        record::Coating::QuarterWave(nm) => Coating::QuarterWave { design_nm: nm.value },
    }
}

fn dispersion(glass: &Glass, context: &mut Context<'_>) -> Option<Dispersion> {
    let (place, made) = match glass {
        Glass::Named(name) => (&name.place, glass::named(&name.value).map(|glass| glass.dispersion)),
        Glass::Numbers(numbers) => (&numbers.place, of_numbers(numbers)),
    };
    context.accept(place, made)
}

fn of_numbers(numbers: &record::GlassNumbers) -> Result<Dispersion, GlassError> {
    match (&numbers.known, &numbers.abbe, &numbers.sellmeier_c_um2) {
        (GlassKnown::Index(n), Some(v), _) => Dispersion::of_abbe(n.value, v.value),
        (GlassKnown::Index(n), None, _) => Ok(Dispersion::Constant { n: n.value }),
        (GlassKnown::Sellmeier(b), _, c) => {
            let c_um2 = c.as_ref().map_or([0.0; 3], |c| c.value);
            Dispersion::Sellmeier { b: b.value, c_um2 }.checked()
        }
    }
}

fn ir_cut(record: &record::IrCut, context: &mut Context<'_>) -> Option<InterferenceFilter> {
    let (place, normal) = match &record.normal {
        IrCutCurve::Spectrum(file) => (&file.place, from_file(file, Outside::Hold, context)?),
        IrCutCurve::Edge(edge) => {
            let half = 0.5 * record.edge_width_nm.as_ref().map_or(0.0, |w| w.value);
            let flank = [(edge.value - half, 1.0), (edge.value + half, 0.0)];
            (&edge.place, context.accept(&edge.place, Spectrum::from_points(&flank, Outside::Hold))?)
        }
    };
    context.accept(place, InterferenceFilter::new(normal, record.effective_index.value))
}

/// Lens with aperture and focus, and notes on its file.
fn made(
    record: &record::Prescription,
    given: Given<'_>,
    context: &mut Context<'_>,
) -> Result<Prescription, PrescriptionError> {
    let Given { mut surfaces, file } = given;
    let Some(asset) = file else { return focused(record, surfaces, &Defaults::WITHOUT_FILE) };
    let stated = Stated::of(asset, &surfaces)?;
    let stop = surfaces.iter().position(|surface| surface.stop);
    let own_mm = stop.map_or(0.0, |i| surfaces[i].semi_aperture_mm);
    if let (Some(i), Some(stop_mm)) = (stop, stated.stop_mm) {
        // An f-number of the description may open the stop as far as either of the file's statements.
        let open_mm = if record.f_number.is_some() { stop_mm.max(own_mm) } else { stop_mm };
        surfaces[i].semi_aperture_mm = if asset.surfaces[i].rim { open_mm.min(own_mm) } else { open_mm };
    }
    let defaults = Defaults {
        distance_m: stated.distance_m,
        defocus_mm: stated.defocus_mm.unwrap_or(asset.defocus_mm),
        reference_nm: lens_file::reference_nm(asset),
        other_rims: OtherRims::Clip,
    };
    let lens = focused(record, surfaces, &defaults)?;
    lens_file::remarks(record, asset, own_mm, &stated, &lens, context);
    Ok(lens)
}

/// Values where the description states nothing.
struct Defaults {
    distance_m: f64,
    defocus_mm: f64,
    reference_nm: f64,
    other_rims: OtherRims,
}

impl Defaults {
    const WITHOUT_FILE: Self =
        Self { distance_m: f64::INFINITY, defocus_mm: 0.0, reference_nm: PRINCIPAL_NM, other_rims: OtherRims::Refused };
}

/// Lens with the description's aperture and focus, otherwise with the defaults.
fn focused(
    record: &record::Prescription,
    surfaces: Vec<Surface>,
    defaults: &Defaults,
) -> Result<Prescription, PrescriptionError> {
    let Defaults { reference_nm, other_rims, .. } = *defaults;
    let distance_m = record.focus_distance_m.as_ref().map_or(defaults.distance_m, focus_m);
    let focus = match &record.focus_by {
        None | Some(record::FocusBy::Sensor) => Focus::Sensor { distance_m },
        Some(record::FocusBy::Group(group)) => {
            let [first, last] = group.value.map(|number| number as usize - 1);
            Focus::Group { distance_m, first, last }
        }
    };
    let defocus_mm = record.defocus_mm.as_ref().map_or(defaults.defocus_mm, |d| d.value);
    let f_number = record.f_number.as_ref().map(|n| n.value);
    Prescription::new(PrescriptionParameters { surfaces, f_number, focus, defocus_mm, reference_nm, other_rims })
}

/// Records, at the place of the cause, why the surfaces do not form a lens.
fn refuse(record: &record::Prescription, error: &PrescriptionError, context: &mut Context<'_>) {
    let whole =
        |place: &Place, context: &mut Context<'_>| context.fault(ErrorCode::UnusableLens, place, error.to_string(), "");
    match (error, &record.source) {
        (PrescriptionError::TooFast { .. }, _) if record.f_number.is_some() => {
            record.f_number.iter().for_each(|n| whole(&n.place, context));
        }
        (PrescriptionError::Group { .. } | PrescriptionError::GroupRange { .. }, _) => match &record.focus_by {
            Some(record::FocusBy::Group(group)) => whole(&group.place, context),
            _ => whole(&record.place, context),
        },
        (_, Source::Surfaces(surfaces)) => {
            let at = error.surface().and_then(|number| surfaces.get(number - 1));
            whole(at.map_or(&record.place, |surface| &surface.place), context);
        }
        (_, Source::File(file)) => {
            let assets = context.assets;
            let asset = assets.prescriptions.get(&file.value);
            let at = error.surface().and_then(|number| asset?.surfaces.get(number - 1)).map(|surface| surface.line);
            let opening = asset.filter(|_| matches!(error, PrescriptionError::Cone { .. })).map(|a| a.opening_line);
            let at = at.or(opening);
            let line = at.map_or(String::new(), |line| format!(" (line {line} of {})", file.value.display()));
            context.fault(ErrorCode::UnusableLens, &file.place, format!("{error}{line}"), "");
        }
        (_, Source::Published(name)) => whole(&name.place, context),
    }
}
