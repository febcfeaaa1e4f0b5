//! A lens by its surfaces.

use super::super::context::Context;
use super::super::spectrum::from_file;
use super::focus_m;
use etendue_optics::prescription::coating::Coating;
use etendue_optics::prescription::filter::InterferenceFilter;
use etendue_optics::prescription::published::{LENSES, named};
use etendue_optics::prescription::surface::ASPHERE_TERMS;
use etendue_optics::prescription::{Focus, Surface};
use etendue_optics::{Lens, Prescribed, Prescription, PrescriptionError, PrescriptionParameters};
use etendue_projection::Raster;
use etendue_scene::asset::{GlassAsset, LensOpening, PrescriptionAsset, SurfaceAsset};
use etendue_scene::record::lens::prescription::{self as record, Glass, GlassKnown, IrCutCurve, Source};
use etendue_scene::{Place, Placed};
use etendue_spectra::glass::{self, Dispersion, GlassError};
use etendue_spectra::{Outside, Spectrum};

/// Surfaces, and how far the lens opens where nothing else is said.
struct Given {
    surfaces: Vec<Surface>,
    opening: Option<LensOpening>,
}

/// The lens for a picture, and for the film about it.
pub(super) fn lens(
    record: &record::Prescription,
    raster: &Raster,
    film: &Raster,
    context: &mut Context<'_>,
) -> Option<Lens> {
    let given = given(record, context);
    let filter = record.ir_cut.as_ref().map(|filter| ir_cut(filter, context));
    let given = given.map(|Given { surfaces, opening }| Given { surfaces: coated(surfaces, record), opening })?;
    let prescription = focused(record, given).map_err(|error| refuse(record, &error, context)).ok()?;
    let filter = filter.map_or(Some(None), |filter| filter.map(Some))?;
    let lens = Prescribed::new(prescription, filter, film.max_radius_mm());
    let lens = context.accept(&record.place, lens)?;
    if lens.lit_radius_mm() < raster.max_radius_mm() * (1.0 - 1e-9) {
        let (lit, needed) = (lens.lit_radius_mm(), raster.max_radius_mm());
        let told = format!("the lens lights {lit:.3} mm about the axis, the picture reaches {needed:.3} mm");
        context.warn_on(&record.place, told);
    }
    Some(Lens::prescription(lens))
}

fn given(record: &record::Prescription, context: &mut Context<'_>) -> Option<Given> {
    match &record.source {
        Source::Published(name) => published(name, context),
        Source::File(file) => {
            let asset = context.assets.prescriptions.get(&file.value)?;
            from_lens_file(asset, record, &file.place, context)
        }
        Source::Surfaces(surfaces) => {
            let made: Vec<_> = surfaces.iter().map(|s| surface(s, context)).collect();
            Some(Given { surfaces: made.into_iter().collect::<Option<_>>()?, opening: None })
        }
    }
}

fn published(name: &Placed<String>, context: &mut Context<'_>) -> Option<Given> {
    let Some(lens) = named(&name.value) else {
        let known: Vec<_> = LENSES.iter().map(|lens| lens.name).collect();
        let problem = format!("no published lens is called \"{}\"", name.value);
        context.fault(&name.place, problem, format!("give one of {}", known.join(", ")));
        return None;
    };
    Some(Given { surfaces: lens.surfaces(), opening: None })
}

/// The surfaces of a lens program's file.
fn from_lens_file(
    asset: &PrescriptionAsset,
    record: &record::Prescription,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<Given> {
    let apertures = apertures(asset, record, place, context)?;
    let surfaces = asset.surfaces.iter().zip(apertures).map(|(surface, semi_mm)| of_file(surface, semi_mm));
    let surfaces = context.accept(place, surfaces.collect::<Result<Vec<_>, _>>())?;
    Some(Given { surfaces, opening: asset.opening })
}

fn apertures(
    asset: &PrescriptionAsset,
    record: &record::Prescription,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<Vec<f64>> {
    let count = asset.surfaces.len();
    if let Some(list) = &record.semi_apertures_mm {
        if list.len() == count {
            return Some(list.iter().map(|semi| semi.value).collect());
        }
        let place = list.first().map_or(place, |first| &first.place);
        let problem = format!("{} semi-apertures for the {count} surfaces of the file", list.len());
        context.fault(place, problem, format!("give {count}"));
        return None;
    }
    let without = asset.surfaces.iter().enumerate().filter(|(_, s)| s.semi_aperture_mm.is_none());
    let names: Vec<String> = without.map(|(i, s)| format!("{} (line {})", i + 1, s.line)).collect();
    if !names.is_empty() {
        let problem = format!("the file gives no semi-aperture of its surfaces {}", names.join(", "));
        let remedy = format!("add them to the file (DIAM, CIR), or give \"semi_apertures_mm\", {count} numbers");
        context.fault(place, problem, remedy);
    }
    asset.surfaces.iter().map(|s| s.semi_aperture_mm).collect()
}

/// A surface of a file.
///
/// # Errors
/// Where its glass is none.
fn of_file(surface: &SurfaceAsset, semi_aperture_mm: f64) -> Result<Surface, GlassError> {
    let glass = match &surface.glass {
        GlassAsset::Air => Dispersion::AIR,
        GlassAsset::Named(name) => glass::named(name)?.dispersion,
        GlassAsset::Abbe { index, abbe } => Dispersion::of_abbe(*index, *abbe)?,
    };
    Ok(Surface {
        conic: surface.conic,
        asphere: surface.asphere,
        stop: surface.stop,
        ..Surface::sphere(surface.radius_mm, surface.thickness_mm, glass, semi_aperture_mm)
    })
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

/// The lens's coating on the surfaces against air that say nothing of their own.
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

/// The lens, opened and focused.
fn focused(record: &record::Prescription, given: Given) -> Result<Prescription, PrescriptionError> {
    let distance_m = focus_m(&record.focus_distance_m);
    let focus = match &record.focus_by {
        None | Some(record::FocusBy::Sensor) => Focus::Sensor { distance_m },
        Some(record::FocusBy::Group(group)) => {
            let [first, last] = group.value.map(|number| number as usize - 1);
            Focus::Group { distance_m, first, last }
        }
    };
    let defocus_mm = record.defocus_mm.as_ref().map_or(0.0, |d| d.value);
    let make = |f_number, surfaces| Prescription::new(PrescriptionParameters { surfaces, f_number, focus, defocus_mm });
    match (&record.f_number, given.opening) {
        (Some(n), _) => make(Some(n.value), given.surfaces),
        (None, None) => make(None, given.surfaces),
        (None, Some(LensOpening::FNumber { f_number })) => make(Some(f_number), given.surfaces),
        (None, Some(LensOpening::EntrancePupil { diameter_mm })) => {
            let open = make(None, given.surfaces.clone())?;
            make(Some(open.paraxial().focal_length_mm / diameter_mm), given.surfaces)
        }
    }
}

/// Notes why the surfaces are no lens where the cause stands.
fn refuse(record: &record::Prescription, error: &PrescriptionError, context: &mut Context<'_>) {
    let whole = |place: &Place, context: &mut Context<'_>| context.fault(place, error.to_string(), "");
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
            let at = error.surface().and_then(|number| asset?.surfaces.get(number - 1));
            let line = at.map_or(String::new(), |s| format!(" (line {} of {})", s.line, file.value.display()));
            context.fault(&file.place, format!("{error}{line}"), "");
        }
        (_, Source::Published(name)) => whole(&name.place, context),
    }
}
