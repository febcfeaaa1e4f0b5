//! A lens given by its surfaces: in the camera file, in the file of a lens program, or published.

use std::path::PathBuf;

use super::focus::{FocusDistance, focus_distance};
use super::numbers::f_number;
use crate::asset::ASPHERE_TERMS;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{Rule, choice, either, flag, keyed, list, number, path, record, text, variant, vector, words};
use crate::record::curve::spectrum_file;

record! {
    /// A ray-traced lens.
    pub struct Prescription check(check) {
        /// Source of its surfaces.
        inside source: SurfaceListSource;
        /// With "file": clear semi-apertures of its surfaces. Default: the file's, otherwise as its fields need.
        optional semi_apertures_mm: Vec<Placed<f64>> = list(number("mm").above(0.0), 1);
        /// Glass catalogues of Zemax, searched in this order before those built in.
        many glasses: Placed<PathBuf> = list(path(&["agf"]), 1);
        /// f-number at infinity focus; opens the stop, at most to its semi-aperture. Default: the file's, or the full stop.
        optional f_number: Placed<f64> = f_number();
        /// Distance from the entrance pupil to the plane in focus. Default, with "file" only: its object.
        optional focus_distance_m: FocusDistance = focus_distance();
        /// Part that moves to focus: the sensor, or a group by its first and last surface, counted from 1 at the scene; the sensor then stays at infinity
        /// focus. Default: "sensor".
        optional focus_by: FocusingPart = focus_by();
        /// Distance of the sensor behind the paraxial image at 587.56 nm, or the file's primary wavelength. Default: the file's, otherwise 0.
        optional defocus_mm: Placed<f64> = number("mm");
        /// Coating of surfaces in air without their own. Default: "uncoated".
        optional coating: Coating = coating();
        /// Interference filter in front of the sensor.
        optional ir_cut: IrCut = record();
    }
}

impl Prescription {
    /// Paths of its glass catalogues.
    #[must_use]
    pub fn glass_files(&self) -> Vec<PathBuf> {
        self.glasses.iter().map(|file| file.value.clone()).collect()
    }
}

keyed! {
    /// Source of the surfaces.
    pub enum SurfaceListSource {
        /// A lens of docs/lenses.md: "double-gauss", "wide-angle", "fisheye", "telephoto".
        published => Published(Placed<String>) = text("the name of a published lens");
        /// Sequential lens of Zemax (.zmx) or CODE V (.seq), as text.
        file => File(Placed<PathBuf>) = path(&["zmx", "seq"]);
        /// Surfaces from the scene to the sensor, one of them the stop; air follows the last.
        surfaces => Surfaces(Vec<Surface>) = list(record::<Surface>(), 1);
    }
}

record! {
    /// A surface and the space behind it, in the order in which light meets them. With c = 1/radius_mm and r the distance from the axis its sag is
    /// c r²/(1 + √(1 − (1 + conic) c² r²)) + a₁ r² + a₂ r⁴ + …, a the list `asphere`. Signs follow the light, also after mirrors: sags and distances are
    /// positive in its direction.
    pub struct Surface check(check_surface) {
        /// Radius of curvature, positive with the centre behind the surface as the light meets it: a concave mirror's is negative. Default: a plane.
        optional radius_mm: Placed<f64> = number("mm");
        /// Conic constant: 0 sphere, −1 paraboloid. Default: 0.
        optional conic: Placed<f64> = number("");
        /// Coefficients of r², r⁴, r⁶ …; at most ten.
        optional asphere: Vec<Placed<f64>> = list(number("mm^(1 - 2i)"), 1);
        /// Makes the surface a mirror; the light stays in the medium before it. Default: false.
        optional mirror: Placed<bool> = flag();
        /// Distance to the next surface along the light; omitted for the last.
        optional thickness_mm: Placed<f64> = number("mm").at_least(0.0);
        /// Radius of the clear aperture.
        required semi_aperture_mm: Placed<f64> = number("mm").above(0.0);
        /// Radius about the axis within which light is stopped: a hole, or a disc before the surface. Default: 0.
        optional obscured_radius_mm: Placed<f64> = number("mm").at_least(0.0);
        /// Medium behind the surface: a glass of a catalogue ("N-BK7"; as "F2_HOYA" of that maker), or a table. Default: air.
        optional glass: Glass = glass();
        /// Transmittance: uncoated (Fresnel), a fraction or a layer. Default: the lens's coating. Of a mirror its reflectance, by default 1.
        optional coating: Coating = coating();
        /// Marks the aperture stop. Default: false.
        optional stop: Placed<bool> = flag();
    }
}

/// The medium of a space.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a description has few of them, and places of values take most of it")]
pub enum Glass {
    /// By the maker's name.
    Named(Placed<String>),
    /// By its optical constants.
    Numbers(GlassNumbers),
}

record! {
    /// A glass by its optical constants, relative to air.
    pub struct GlassNumbers check(check_glass) {
        /// Given constants.
        inside known: GlassConstants;
        /// With "index": Abbe number V_d. Default: no dispersion.
        optional abbe: Placed<f64> = number("").above(5.0);
        /// With "sellmeier_b": C₁, C₂, C₃.
        optional sellmeier_c_um2: Placed<[f64; 3]> = vector::<3>(number("µm²"));
    }
}

keyed! {
    /// Given constants of a glass.
    pub enum GlassConstants {
        /// Refractive index n_d, at 587.56 nm; with "abbe" a Conrady curve on the normal line.
        index => Index(Placed<f64>) = number("").above(1.0).at_most(5.0);
        /// B₁, B₂, B₃ of Sellmeier's equation n² = 1 + Σ B λ²/(λ² − C), λ in µm.
        sellmeier_b => Sellmeier(Placed<[f64; 3]>) = vector::<3>(number(""));
    }
}

/// Transmittance of a surface.
#[derive(Clone, Debug)]
pub enum Coating {
    /// Bare glass.
    Uncoated,
    /// A fraction, equal at all angles and wavelengths.
    Share(Placed<f64>),
    /// A quarter-wave layer of magnesium fluoride for this wavelength, nm.
    QuarterWave(Placed<f64>),
}

words! {
    /// The word for a surface without a coating.
    pub enum UncoatedWord {
        /// Bare glass: Fresnel reflection.
        "uncoated" => Uncoated,
    }
}

keyed! {
    /// A layer.
    pub enum Layer {
        /// Wavelength of a quarter-wave layer of magnesium fluoride.
        quarter_wave_nm => QuarterWave(Placed<f64>) = number("nm").at_least(300.0).at_most(1100.0);
    }
}

/// The part that moves to focus.
#[derive(Clone, Debug)]
pub enum FocusingPart {
    Sensor,
    /// From the first to the last surface of a group, counted from 1.
    Group(Placed<[f64; 2]>),
}

words! {
    /// The word for focusing by the sensor.
    pub enum FocusMechanism {
        /// The sensor moves, or the lens as a whole.
        "sensor" => Sensor,
    }
}

record! {
    /// An interference filter. An edge at λ₀ shifts to λ₀ √(1 − sin²θ/effective_index²) for light at the angle θ.
    pub struct IrCut check(check_filter) {
        /// Transmittance at normal incidence.
        inside normal: IrCutCurve;
        /// With "edge_nm": width of the edge from full transmittance to none.
        optional edge_width_nm: Placed<f64> = number("nm").above(0.0);
        /// Effective index of its layers; 1.5 to 2.2 is usual.
        required effective_index: Placed<f64> = number("").above(1.0);
    }
}

keyed! {
    /// Transmittance of a filter at normal incidence.
    pub enum IrCutCurve {
        /// Two columns: wavelength in nm, transmittance 0 … 1.
        spectrum => Spectrum(Placed<PathBuf>) = spectrum_file();
        /// Wavelength of half transmittance: full below, none above, linear between.
        edge_nm => Edge(Placed<f64>) = number("nm").at_least(300.0).at_most(1100.0);
    }
}

fn glass() -> impl Rule<Out = Glass> {
    either(variant!(text("the name of a glass"), Glass::Named), variant!(record::<GlassNumbers>(), Glass::Numbers))
}

pub(crate) fn coating() -> impl Rule<Out = Coating> {
    let fraction = variant!(number("").above(0.0).at_most(1.0), Coating::Share);
    let layer = variant!(record::<Layer>(), Layer::QuarterWave => Coating::QuarterWave);
    either(variant!(choice::<UncoatedWord>(), UncoatedWord::Uncoated == Coating::Uncoated), either(fraction, layer))
}

fn focus_by() -> impl Rule<Out = FocusingPart> {
    let group = variant!(vector::<2>(number("").at_least(1.0)), FocusingPart::Group);
    either(variant!(choice::<FocusMechanism>(), FocusMechanism::Sensor == FocusingPart::Sensor), group)
}

fn check(lens: &Prescription, errors: &mut DescriptionErrors) {
    if let (Some(file), SurfaceListSource::Published(_)) = (lens.glasses.first(), &lens.source) {
        let problem = "\"glasses\" has no effect here: the glasses of a published lens are known";
        errors.add(ErrorCode::NoEffect, &file.place, problem, "remove it");
    }
    if lens.focus_distance_m.is_none() && !matches!(lens.source, SurfaceListSource::File(_)) {
        let problem = "the key \"focus_distance_m\" is missing";
        errors.add(
            ErrorCode::MissingKey,
            &lens.place,
            problem,
            "add \"focus_distance_m\", a distance in m or \"infinity\"",
        );
    }
    let semi_aperture = lens.semi_apertures_mm.iter().flatten().next();
    if let (Some(semi_aperture), false) = (semi_aperture, matches!(lens.source, SurfaceListSource::File(_))) {
        let problem = "\"semi_apertures_mm\" has no effect here, it belongs to \"file\"";
        errors.add(
            ErrorCode::NoEffect,
            &semi_aperture.place,
            problem,
            "remove it; a surface states its own \"semi_aperture_mm\"",
        );
    }
    if let Some(FocusingPart::Group(group)) = &lens.focus_by
        && !(group.value.iter().all(|i| i.fract() == 0.0) && group.value[0] <= group.value[1])
    {
        let problem = format!("{} to {} is not a range of surfaces", group.value[0], group.value[1]);
        errors.add(
            ErrorCode::WrongOrder,
            &group.place,
            problem,
            "give two whole numbers, the first surface's and the last's",
        );
    }
    let SurfaceListSource::Surfaces(surfaces) = &lens.source else { return };
    let (last, others) = surfaces.split_last().map_or((None, &[][..]), |(last, others)| (Some(last), others));
    for surface in others.iter().filter(|s| s.thickness_mm.is_none()) {
        errors.add(
            ErrorCode::MissingKey,
            &surface.place,
            "the distance to the next surface is missing",
            "add \"thickness_mm\"",
        );
    }
    if let Some(thickness) = last.and_then(|s| s.thickness_mm.as_ref()) {
        let problem =
            "\"thickness_mm\" of the last surface has no effect: the focus determines the position of the sensor";
        errors.add(ErrorCode::NoEffect, &thickness.place, problem, "remove it");
    }
    for surface in surfaces {
        if let Some(beyond) = surface.asphere.iter().flatten().nth(ASPHERE_TERMS) {
            let problem = format!("found more than {ASPHERE_TERMS} coefficients");
            errors.add(ErrorCode::WrongCount, &beyond.place, problem, "give those of r² to r²⁰");
        }
        if let Some(radius) = surface.radius_mm.as_ref().filter(|r| r.value == 0.0) {
            errors.add(
                ErrorCode::OutOfRange,
                &radius.place,
                "found a radius of 0",
                "give a radius, or omit the key for a plane",
            );
        }
    }
}

fn check_surface(surface: &Surface, errors: &mut DescriptionErrors) {
    let is_mirror = surface.mirror.as_ref().is_some_and(|mirror| mirror.value);
    if let (true, Some(glass)) = (is_mirror, &surface.glass) {
        let place = match glass {
            Glass::Named(name) => &name.place,
            Glass::Numbers(numbers) => &numbers.place,
        };
        let problem = "\"glass\" of a mirror has no effect: the light stays in the medium before it";
        errors.add(ErrorCode::NoEffect, place, problem, "remove it");
    }
    if let (true, Some(Coating::QuarterWave(layer))) = (is_mirror, &surface.coating) {
        let problem = "the coating of a mirror is its reflectance";
        errors.add(ErrorCode::WrongType, &layer.place, problem, "give a number above 0, at most 1");
    }
    if let Some(obscured) = &surface.obscured_radius_mm
        && obscured.value >= surface.semi_aperture_mm.value
    {
        let problem = format!("{} mm leaves nothing open of \"semi_aperture_mm\"", obscured.value);
        errors.add(ErrorCode::OutOfRange, &obscured.place, problem, "give a smaller radius");
    }
}

fn check_glass(glass: &GlassNumbers, errors: &mut DescriptionErrors) {
    match (&glass.known, &glass.abbe, &glass.sellmeier_c_um2) {
        (GlassConstants::Index(_), _, Some(c)) => {
            errors.add(ErrorCode::NoEffect, &c.place, "\"sellmeier_c_um2\" belongs to \"sellmeier_b\"", "remove it");
        }
        (GlassConstants::Sellmeier(_), Some(abbe), _) => {
            errors.add(
                ErrorCode::NoEffect,
                &abbe.place,
                "\"abbe\" has no effect here, it belongs to \"index\"",
                "remove it",
            );
        }
        (GlassConstants::Sellmeier(b), _, None) => {
            errors.add(
                ErrorCode::MissingKey,
                &b.place,
                "the resonances of Sellmeier's equation are missing",
                "add \"sellmeier_c_um2\"",
            );
        }
        _ => {}
    }
}

fn check_filter(filter: &IrCut, errors: &mut DescriptionErrors) {
    match (&filter.normal, &filter.edge_width_nm) {
        (IrCutCurve::Edge(edge), None) => {
            errors.add(ErrorCode::MissingKey, &edge.place, "the width of the edge is missing", "add \"edge_width_nm\"");
        }
        (IrCutCurve::Spectrum(_), Some(width)) => {
            errors.add(
                ErrorCode::NoEffect,
                &width.place,
                "\"edge_width_nm\" has no effect here, it belongs to \"edge_nm\"",
                "remove it",
            );
        }
        _ => {}
    }
}
