//! `[effects]`: effects on the irradiance behind the lens.

use std::path::PathBuf;

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{
    Rule, RuleExt as _, choice, either, exactly, flag, integer, keyed, list, number, path, record, words,
};

record! {
    /// Effects on the irradiance behind the lens, on either route. The film is rendered wider than the image, for light from beyond its edge, and
    /// spectral bands are stored.
    pub struct Effects check(check) {
        /// Point-spread function.
        optional psf: Psf = record();
        /// Light scattered in the lens.
        optional glare: Glare = record();
        /// Adds ghosts; needs a prescription lens. Default: false.
        optional ghosts: Placed<bool> = flag();
        /// With "ghosts": reflectance of the sensor. Default: 0.
        optional sensor_reflectance: Placed<f64> = number("").at_least(0.0).at_most(0.5);
        /// Rendered margin on every side, as a fraction of the image's size. Default: the reach of the effects, at most 0.25.
        optional margin: Placed<f64> = number("").at_least(0.0).at_most(1.0);
    }
}

record! {
    /// Point-spread function of the aperture: diffraction at the working f-number of the lens, with wavefront error. "image" (an image of a point) or
    /// "files" (tables over the field) replace both.
    pub struct Psf check(check_psf) {
        /// Blades of the diaphragm, at constant aperture area. Default: a circle.
        optional blades: Placed<u64> = integer(3, 32);
        /// With "blades": curvature, from straight edges to a circle. Default: 0.
        optional blade_curvature: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// With "blades": direction of a corner, from right towards bottom. Default: 0.
        optional rotation_deg: Placed<f64> = number("deg");
        /// Radius of a central obstruction over the pupil's. Default: the prescription's obscuration on the axis, otherwise 0.
        optional obstruction: Placed<f64> = number("").at_least(0.0).at_most(0.9);
        /// Zernike terms of the wavefront error.
        many wavefront: ZernikeTerm = list(record::<ZernikeTerm>(), 1);
        /// Radius at which the function ends. Default: about 256 px, or 256 λN where λN is below a pixel.
        optional reach_mm: Placed<f64> = number("mm").above(0.0);
        /// Patches across and down with one function each. Default: one where it is nearly constant, otherwise five across and three down.
        optional patches: Placed<[Placed<u64>; 2]> = exactly(integer(1, 32));
        /// Image of a point, instead of the aperture: linear, normalised, oriented as captured, the point in the middle.
        optional image: Placed<PathBuf> = path(&["png", "exr"]);
        /// With "image": its pixel pitch on the sensor, at most the sensor's.
        optional image_pitch_um: Placed<f64> = number("µm").above(0.0);
        /// With "image": wavelength of the pitch, to which the size is proportional. Default: equal at all wavelengths.
        optional image_wavelength_nm: Placed<f64> = number("nm").at_least(300.0).at_most(1100.0);
        /// MTF of the lens, instead of the aperture: a round function, equal over wavelengths and image.
        optional mtf: ModulationTable = record();
        /// Zemax "Huygens PSF" or "FFT PSF" texts, one per field point and wavelength, instead of the aperture.
        many files: Placed<PathBuf> = list(path(&["txt", "dat"]), 1);
        /// "film" convolves pixels without noise; "samples" displaces samples, exact at any width. Default: "samples" where samples pass through the lens,
        /// four fifths of the light fall near, and "film" would change contrast by more than 0.01 ("image" of one width) or 0.065; otherwise "film".
        optional spread_by: Placed<PsfMethod> = choice();
    }
}

record! {
    /// Modulation of the lens as a function of spatial frequency on the sensor.
    pub struct ModulationTable check(check_modulation) {
        /// Source of the points.
        inside source: ModulationSource;
        /// With "cycles_per_mm": modulation at each frequency.
        optional modulation: Vec<Placed<f64>> = list(number("").at_least(0.0).at_most(1.0), 2);
    }
}

keyed! {
    /// Source of a table of modulation.
    pub enum ModulationSource {
        /// Zemax "FFT MTF" text, or a table of frequency and modulation headed "MTF" and "cycles per mm".
        file => File(Placed<PathBuf>) = path(&["txt"]);
        /// Spatial frequencies, increasing.
        cycles_per_mm => Frequencies(Vec<Placed<f64>>) = list(number("cycles/mm").above(0.0), 2);
    }
}

fn check_modulation(table: &ModulationTable, errors: &mut DescriptionErrors) {
    match (&table.source, &table.modulation) {
        (ModulationSource::File(_), None) => {}
        (ModulationSource::File(_), Some(list)) => {
            let place = list.first().map_or(&table.place, |first| &first.place);
            errors.add(
                ErrorCode::NoEffect,
                place,
                "\"modulation\" has no effect here, it belongs to \"cycles_per_mm\"",
                "remove it",
            );
        }
        (ModulationSource::Frequencies(_), None) => {
            errors.add(
                ErrorCode::MissingKey,
                &table.place,
                "the key \"modulation\" is missing",
                "add \"modulation\", one for each frequency",
            );
        }
        (ModulationSource::Frequencies(frequencies), Some(list)) if frequencies.len() != list.len() => {
            let problem =
                format!("the numbers of frequencies ({}) and modulations ({}) differ", frequencies.len(), list.len());
            errors.add(ErrorCode::WrongCount, &table.place, problem, "give equal numbers");
        }
        (ModulationSource::Frequencies(frequencies), Some(_)) => {
            if let Some(pair) = frequencies.windows(2).find(|pair| pair[1].value <= pair[0].value) {
                let problem = format!("{} is not above {}", pair[1].value, pair[0].value);
                errors.add(ErrorCode::WrongOrder, &pair[1].place, problem, "give increasing frequencies");
            }
        }
    }
}

words! {
    /// Method of spreading light by a point-spread function.
    pub enum PsfMethod {
        /// Convolution of the film's pixels.
        "film" => Film,
        /// Displaced samples.
        "samples" => Samples,
    }
}

record! {
    /// A Zernike term, of root mean square one over the pupil of the f-number; it extends beyond that pupil in the corners of blades.
    pub struct ZernikeTerm check(check_term) {
        /// Index of the term.
        inside index: ZernikeIndex;
        /// Size of the term.
        inside size: TermSize;
        /// Wavelength of "rms_waves".
        optional wavelength_nm: Placed<f64> = number("nm").at_least(300.0).at_most(1100.0);
        /// Increasing distances from the axis, one for each root mean square of a point to the right; the term turns with the point. Default: equal everywhere.
        many field_radius_mm: Placed<f64> = list(number("mm").at_least(0.0), 2);
    }
}

keyed! {
    /// The index of a Zernike term.
    pub enum ZernikeIndex {
        /// Noll's index (1976): 1 piston, 4 defocus, 7 and 8 coma, 11 spherical aberration.
        noll => Noll(Placed<u64>) = integer(1, 91);
        /// Index of OSA and ANSI Z80.28: 0 piston, 4 defocus, 7 and 8 coma, 12 spherical aberration.
        osa => Osa(Placed<u64>) = integer(0, 90);
    }
}

keyed! {
    /// Root mean square of a term: one number, or one for each field radius.
    pub enum TermSize {
        /// Root mean square in µm.
        rms_um => Micrometres(Vec<Placed<f64>>) = sizes("µm");
        /// Root mean square in waves of "wavelength_nm".
        rms_waves => Waves(Vec<Placed<f64>>) = sizes("");
    }
}

fn sizes(unit: &'static str) -> impl Rule<Out = Vec<Placed<f64>>> {
    let one = |list: &Vec<Placed<f64>>| list.first().filter(|_| list.len() == 1).cloned();
    either(number(unit).map(|v| vec![v], one), list(number(unit), 2))
}

fn check_psf(psf: &Psf, errors: &mut DescriptionErrors) {
    check_blades(psf, errors);
    match (&psf.image, &psf.mtf, psf.files.first()) {
        (None, None, None) => check_without_image(psf, errors),
        (Some(image), None, None) => check_image(psf, &image.place, errors),
        (None, Some(_), None) => {
            check_without_image(psf, errors);
            check_alone(psf, "mtf", errors);
        }
        (None, None, Some(_)) => {
            check_without_image(psf, errors);
            check_alone(psf, "files", errors);
        }
        (Some(image), Some(_), _) => {
            errors.add(ErrorCode::Contradiction, &image.place, "\"image\" contradicts \"mtf\"", "remove one of them");
        }
        (image, _, Some(file)) => {
            let other = if image.is_some() { "image" } else { "mtf" };
            errors.add(
                ErrorCode::Contradiction,
                &file.place,
                format!("\"files\" contradicts \"{other}\""),
                "remove one of them",
            );
        }
    }
}

fn check_without_image(psf: &Psf, errors: &mut DescriptionErrors) {
    let of_image = [(&psf.image_pitch_um, "image_pitch_um"), (&psf.image_wavelength_nm, "image_wavelength_nm")];
    for (key, name) in of_image.into_iter().filter_map(|(key, name)| Some((key.as_ref()?, name))) {
        errors.add(
            ErrorCode::NoEffect,
            &key.place,
            format!("\"{name}\" has no effect without \"image\""),
            "give \"image\", or remove it",
        );
    }
}

fn check_image(psf: &Psf, image: &Place, errors: &mut DescriptionErrors) {
    if psf.image_pitch_um.is_none() {
        let problem = "\"image\" does not state the distance of its pixels on the sensor";
        errors.add(ErrorCode::MissingKey, image, problem, "add \"image_pitch_um\"");
    }
    check_alone(psf, "image", errors);
}

/// Refuses keys of the aperture together with a complete function.
fn check_alone(psf: &Psf, key_name: &str, errors: &mut DescriptionErrors) {
    let shared = |name: &str| name == "patches" && key_name == "files";
    for (place, name) in aperture_keys(psf).filter(|(_, name)| !shared(name)) {
        let problem = format!("\"{name}\" contradicts \"{key_name}\", which is the whole point-spread function");
        errors.add(ErrorCode::Contradiction, place, problem, "remove one of them");
    }
}

/// Keys that describe an aperture's function.
fn aperture_keys(psf: &Psf) -> impl Iterator<Item = (&Place, &'static str)> {
    fn place<T>(key: &Option<Placed<T>>) -> Option<&Place> {
        key.as_ref().map(|key| &key.place)
    }
    let keys = [
        (place(&psf.blades), "blades"),
        (place(&psf.blade_curvature), "blade_curvature"),
        (place(&psf.rotation_deg), "rotation_deg"),
        (place(&psf.obstruction), "obstruction"),
        (psf.wavefront.first().map(|term| &term.place), "wavefront"),
        (place(&psf.reach_mm), "reach_mm"),
        (place(&psf.patches), "patches"),
    ];
    keys.into_iter().filter_map(|(place, name)| Some((place?, name)))
}

fn check_blades(psf: &Psf, errors: &mut DescriptionErrors) {
    let of_blades = [(&psf.blade_curvature, "blade_curvature"), (&psf.rotation_deg, "rotation_deg")];
    for (key, name) in of_blades {
        if let (Some(key), None, None, true) = (key, &psf.blades, &psf.image, psf.files.is_empty()) {
            errors.add(
                ErrorCode::NoEffect,
                &key.place,
                format!("\"{name}\" has no effect on a circle"),
                "give \"blades\", or remove it",
            );
        }
    }
}

fn check_term(term: &ZernikeTerm, errors: &mut DescriptionErrors) {
    match (&term.size, &term.wavelength_nm) {
        (TermSize::Waves(_), None) => {
            errors.add(
                ErrorCode::MissingKey,
                &term.place,
                "\"rms_waves\" does not state its wavelength",
                "add \"wavelength_nm\"",
            );
        }
        (TermSize::Micrometres(_), Some(nm)) => {
            errors.add(ErrorCode::NoEffect, &nm.place, "\"wavelength_nm\" has no effect with \"rms_um\"", "remove it");
        }
        _ => {}
    }
}

record! {
    /// Light scattered over the sensor: of a point's light the fraction 1 − s is unscattered, and s is spread with a density proportional to (r₀² +
    /// r²)^(−p/2), where r is the distance on the sensor.
    pub struct Glare {
        /// Scattered fraction s; 0.005 to 0.03 for clean lenses.
        required scatter: Placed<f64> = number("").at_least(0.0).at_most(0.5);
        /// Radius r₀ within which scattered light is nearly uniform.
        required core_um: Placed<f64> = number("µm").above(0.0);
        /// Exponent p; above 2 unless "reach_mm" is given.
        required exponent: Placed<f64> = number("").above(0.0);
        /// Radius at which scattered light ends. Default: unlimited.
        optional reach_mm: Placed<f64> = number("mm").above(0.0);
    }
}

fn check(effects: &Effects, errors: &mut DescriptionErrors) {
    if effects.psf.is_none() && effects.glare.is_none() && effects.ghosts.is_none() {
        let remedy = "add [effects.psf], [effects.glare] or ghosts = true, or remove the section";
        errors.add(ErrorCode::Empty, &effects.place, "[effects] contains no effect", remedy);
    }
    if let (Some(reflectance), false) = (&effects.sensor_reflectance, effects.ghosts.as_ref().is_some_and(|g| g.value))
    {
        let problem = "\"sensor_reflectance\" has no effect without ghosts = true";
        errors.add(ErrorCode::NoEffect, &reflectance.place, problem, "add it, or remove \"sensor_reflectance\"");
    }
}
