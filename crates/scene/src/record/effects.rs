//! `[effects]`: effects on the irradiance behind the lens.

use std::path::PathBuf;

use crate::fault::{ErrorCode, Faults};
use crate::place::{Place, Placed};
use crate::reader::{
    Rule, RuleExt as _, choice, either, exactly, flag, keyed, list, number, path, record, whole, words,
};

record! {
    /// Effects on the irradiance behind the lens, on either route. The film is rendered wider than the image, for light from beyond its edge, and
    /// spectral bands are stored.
    pub struct Effects check(check) {
        /// Point-spread function: diffraction and wavefront error of the aperture, or an image of a point. Default: none.
        optional psf: Psf = record();
        /// Light scattered in the lens. Default: none.
        optional glare: Glare = record();
        /// Adds ghosts, traced from light reflected by two surfaces of the lens; only with a lens whose "type" is "prescription". Default: false.
        optional ghosts: Placed<bool> = flag();
        /// With "ghosts": reflectance of the sensor, 0 … 0.5. Default: 0.
        optional sensor_reflectance: Placed<f64> = number("").at_least(0.0).at_most(0.5);
        /// Rendered margin beyond the image on every side, as a fraction of its width and height, 0 … 1. Default: the reach of the effects, at most
        /// 0.25.
        optional margin: Placed<f64> = number("").at_least(0.0).at_most(1.0);
    }
}

record! {
    /// Point-spread function of the aperture: diffraction at the working f-number of the lens, with wavefront error. "image" (an image of a point) or
    /// "files" (tables over the field) replace both.
    pub struct Psf check(check_psf) {
        /// Blades of the diaphragm, 3 … 32. Default: a circle. The area is always that of the circle of the f-number.
        optional blades: Placed<u64> = whole(3, 32);
        /// With "blades": their curvature, 0 … 1, from straight edges to a circle. Default: 0.
        optional blade_curvature: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// With "blades": direction of a corner, degrees from the image's right towards its bottom. Default: 0.
        optional rotation_deg: Placed<f64> = number("deg");
        /// Radius of a central obstruction as a fraction of the pupil's, 0 … 0.9. Default: 0.
        optional obstruction: Placed<f64> = number("").at_least(0.0).at_most(0.9);
        /// Zernike terms of the wavefront error. A ray through the point u of the pupil (of radius one) is displaced by 2N ∂W/∂u. Default: none.
        many wavefront: ZernikeTerm = list(record::<ZernikeTerm>(), 1);
        /// Radius at which the function ends, mm, above 0. Default: about 256 px, or 256 λN where λN is less than a pixel.
        optional reach_mm: Placed<f64> = number("mm").above(0.0);
        /// Patches across and down the image with one function each, 1 … 32. Default: one where the function is nearly the same everywhere, else five
        /// and three.
        optional patches: Placed<[Placed<u64>; 2]> = exactly(whole(1, 32));
        /// An image of a point on the sensor, instead of the aperture's function and all its keys; with "image_pitch_um". Values are linear, also
        /// those of 8 and 16 bits, and are divided by their sum; of a coloured image the mean of its channels. The point is in the middle, the first
        /// row above it and the first column to its left, as in the captured image. Default: the aperture.
        optional image: Placed<PathBuf> = path(&["png", "exr"]);
        /// With "image": pixel pitch on the sensor, µm, above 0, at most that of the sensor's pixels.
        optional image_pitch_um: Placed<f64> = number("µm").above(0.0);
        /// With "image": wavelength of "image_pitch_um", nm, 300 … 1 100. The image scales in proportion to the wavelength, as diffraction does.
        /// Default: equal at all wavelengths.
        optional image_wavelength_nm: Placed<f64> = number("nm").at_least(300.0).at_most(1100.0);
        /// A table of the lens's MTF, instead of the aperture's function and all its keys: a round function, equal at all wavelengths and over the
        /// image, as a sum of Gaussians. Default: the aperture.
        optional mtf: ModulationTable = record();
        /// Point-spread functions over the field, instead of the aperture's function and all its keys except "patches": Zemax's "Huygens PSF" or "FFT
        /// PSF" saved as text, one file per field point (and wavelength, or all polychromatic). The distance from the axis is that of the file's
        /// centre (or reference) coordinates, else of its field, by the lens's projection or in mm; the function turns with the direction from the
        /// axis. Linear between distances and between wavelengths, constant beyond; values are divided by their sum. Without "patches" the number
        /// follows from the files, 11 across at most; functions are placed on the image's edges and evenly between. Default: the aperture.
        many files: Placed<PathBuf> = list(path(&["txt", "dat"]), 1);
        /// Method of spreading light. "film" convolves the film's pixels: no noise, but contrast is lost where the function is about as narrow as a
        /// pixel. "samples" displaces each sample on the sensor: exact at any width, with slightly more noise (light beyond 2.5 px is spread by the
        /// film). Default: "samples" where samples pass through the lens, four fifths of the light fall near, and the film's contrast would be wrong
        /// by more than 0.01 ("image" of one width at all wavelengths, where samples add no noise) or 0.065 (else); the plan states the error.
        /// Otherwise "film".
        optional spread_by: Placed<SpreadBy> = choice();
    }
}

record! {
    /// Modulation of the lens as a function of spatial frequency on the sensor.
    pub struct ModulationTable check(check_modulation) {
        /// Source of the points.
        inside source: ModulationSource;
        /// With "cycles_per_mm": modulation at each frequency, 0 … 1; at 0 it is 1 and need not be given.
        optional modulation: Vec<Placed<f64>> = list(number("").at_least(0.0).at_most(1.0), 2);
    }
}

keyed! {
    /// Source of a table of modulation.
    pub enum ModulationSource {
        /// Zemax's "FFT MTF" exported as text, or any table of frequency and modulation whose head contains "MTF" and "cycles per mm".
        file => File(Placed<PathBuf>) = path(&["txt"]);
        /// Spatial frequencies, cycles/mm, rising from above 0.
        cycles_per_mm => Frequencies(Vec<Placed<f64>>) = list(number("cycles/mm").above(0.0), 2);
    }
}

fn check_modulation(table: &ModulationTable, faults: &mut Faults) {
    match (&table.source, &table.modulation) {
        (ModulationSource::File(_), None) => {}
        (ModulationSource::File(_), Some(list)) => {
            let place = list.first().map_or(&table.place, |first| &first.place);
            faults.add(
                ErrorCode::NoEffect,
                place,
                "\"modulation\" has no effect here, it belongs to \"cycles_per_mm\"",
                "remove it",
            );
        }
        (ModulationSource::Frequencies(_), None) => {
            faults.add(
                ErrorCode::MissingKey,
                &table.place,
                "the key \"modulation\" is missing",
                "add \"modulation\", one for each frequency",
            );
        }
        (ModulationSource::Frequencies(frequencies), Some(list)) if frequencies.len() != list.len() => {
            let problem = format!("found {} frequencies and {} modulations", frequencies.len(), list.len());
            faults.add(ErrorCode::WrongCount, &table.place, problem, "give equal numbers of both");
        }
        (ModulationSource::Frequencies(frequencies), Some(_)) => {
            if let Some(pair) = frequencies.windows(2).find(|pair| pair[1].value <= pair[0].value) {
                let problem = format!("{} is not above {}", pair[1].value, pair[0].value);
                faults.add(ErrorCode::WrongOrder, &pair[1].place, problem, "give rising frequencies");
            }
        }
    }
}

words! {
    /// Method of spreading light by a point-spread function.
    pub enum SpreadBy {
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
        /// With "rms_waves": its wavelength, nm, 300 … 1 100.
        optional wavelength_nm: Placed<f64> = number("nm").at_least(300.0).at_most(1100.0);
        /// Distances from the axis on the sensor, mm, rising, one for each root mean square; linear between them. The term is stated for a point to
        /// the right of the axis and turns with the point. Default: equal everywhere, not turned.
        many field_radius_mm: Placed<f64> = list(number("mm").at_least(0.0), 2);
    }
}

keyed! {
    /// The index of a Zernike term.
    pub enum ZernikeIndex {
        /// Noll's index (1976), from 1 (piston) to 91: 4 defocus, 7 and 8 coma, 11 spherical aberration.
        noll => Noll(Placed<u64>) = whole(1, 91);
        /// Index of OSA and ANSI Z80.28, from 0 (piston) to 90: 4 defocus, 7 and 8 coma, 12 spherical aberration.
        osa => Osa(Placed<u64>) = whole(0, 90);
    }
}

keyed! {
    /// Root mean square of a term: one number, or one for each field radius.
    pub enum TermSize {
        /// In µm.
        rms_um => Micrometres(Vec<Placed<f64>>) = sizes("µm");
        /// In waves of "wavelength_nm".
        rms_waves => Waves(Vec<Placed<f64>>) = sizes("");
    }
}

fn sizes(unit: &'static str) -> impl Rule<Out = Vec<Placed<f64>>> {
    let one = |list: &Vec<Placed<f64>>| list.first().filter(|_| list.len() == 1).cloned();
    either(number(unit).map(|v| vec![v], one), list(number(unit), 2))
}

fn check_psf(psf: &Psf, faults: &mut Faults) {
    check_blades(psf, faults);
    match (&psf.image, &psf.mtf, psf.files.first()) {
        (None, None, None) => check_without_image(psf, faults),
        (Some(image), None, None) => check_image(psf, &image.place, faults),
        (None, Some(_), None) => {
            check_without_image(psf, faults);
            check_alone(psf, "mtf", faults);
        }
        (None, None, Some(_)) => {
            check_without_image(psf, faults);
            check_alone(psf, "files", faults);
        }
        (Some(image), Some(_), _) => {
            faults.add(ErrorCode::Contradiction, &image.place, "\"image\" contradicts \"mtf\"", "remove one of them");
        }
        (image, _, Some(file)) => {
            let other = if image.is_some() { "image" } else { "mtf" };
            faults.add(
                ErrorCode::Contradiction,
                &file.place,
                format!("\"files\" contradicts \"{other}\""),
                "remove one of them",
            );
        }
    }
}

fn check_without_image(psf: &Psf, faults: &mut Faults) {
    let of_image = [(&psf.image_pitch_um, "image_pitch_um"), (&psf.image_wavelength_nm, "image_wavelength_nm")];
    for (key, name) in of_image.into_iter().filter_map(|(key, name)| Some((key.as_ref()?, name))) {
        faults.add(
            ErrorCode::NoEffect,
            &key.place,
            format!("\"{name}\" has no effect without \"image\""),
            "give \"image\", or remove it",
        );
    }
}

fn check_image(psf: &Psf, image: &Place, faults: &mut Faults) {
    if psf.image_pitch_um.is_none() {
        let problem = "\"image\" does not state the distance of its pixels on the sensor";
        faults.add(ErrorCode::MissingKey, image, problem, "add \"image_pitch_um\"");
    }
    check_alone(psf, "image", faults);
}

/// Refuses keys of the aperture together with a complete function.
fn check_alone(psf: &Psf, whole: &str, faults: &mut Faults) {
    let shared = |name: &str| name == "patches" && whole == "files";
    for (place, name) in of_aperture(psf).filter(|(_, name)| !shared(name)) {
        let problem = format!("\"{name}\" contradicts \"{whole}\", which is the whole point-spread function");
        faults.add(ErrorCode::Contradiction, place, problem, "remove one of them");
    }
}

/// Keys that describe an aperture's function.
fn of_aperture(psf: &Psf) -> impl Iterator<Item = (&Place, &'static str)> {
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

fn check_blades(psf: &Psf, faults: &mut Faults) {
    let of_blades = [(&psf.blade_curvature, "blade_curvature"), (&psf.rotation_deg, "rotation_deg")];
    for (key, name) in of_blades {
        if let (Some(key), None, None, true) = (key, &psf.blades, &psf.image, psf.files.is_empty()) {
            faults.add(
                ErrorCode::NoEffect,
                &key.place,
                format!("\"{name}\" has no effect on a circle"),
                "give \"blades\", or remove it",
            );
        }
    }
}

fn check_term(term: &ZernikeTerm, faults: &mut Faults) {
    match (&term.size, &term.wavelength_nm) {
        (TermSize::Waves(_), None) => {
            faults.add(
                ErrorCode::MissingKey,
                &term.place,
                "\"rms_waves\" does not state its wavelength",
                "add \"wavelength_nm\"",
            );
        }
        (TermSize::Micrometres(_), Some(nm)) => {
            faults.add(ErrorCode::NoEffect, &nm.place, "\"wavelength_nm\" has no effect with \"rms_um\"", "remove it");
        }
        _ => {}
    }
}

record! {
    /// Light scattered over the sensor: of a point's light the fraction 1 − s is unscattered, and s is spread with a density proportional to (r₀² +
    /// r²)^(−p/2), where r is the distance on the sensor.
    pub struct Glare {
        /// Scattered fraction s, 0 … 0.5: 0.005 to 0.03 for clean lenses, more with dirt.
        required scatter: Placed<f64> = number("").at_least(0.0).at_most(0.5);
        /// Radius r₀ within which scattered light is nearly uniform, µm, above 0.
        required core_um: Placed<f64> = number("µm").above(0.0);
        /// Exponent p, above 0; above 2 unless "reach_mm" is given.
        required exponent: Placed<f64> = number("").above(0.0);
        /// Radius at which scattered light ends, mm, above 0. Default: unlimited.
        optional reach_mm: Placed<f64> = number("mm").above(0.0);
    }
}

fn check(effects: &Effects, faults: &mut Faults) {
    if effects.psf.is_none() && effects.glare.is_none() && effects.ghosts.is_none() {
        let remedy = "add [effects.psf], [effects.glare] or ghosts = true, or remove the section";
        faults.add(ErrorCode::Empty, &effects.place, "[effects] contains no effect", remedy);
    }
    if let (Some(reflectance), false) = (&effects.sensor_reflectance, effects.ghosts.as_ref().is_some_and(|g| g.value))
    {
        let problem = "\"sensor_reflectance\" has no effect without ghosts = true";
        faults.add(ErrorCode::NoEffect, &reflectance.place, problem, "add it, or remove \"sensor_reflectance\"");
    }
}
