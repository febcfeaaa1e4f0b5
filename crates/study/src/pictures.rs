//! Images of approximations: the exact form, the approximation, and their difference side by side.

use crate::configuration::Configuration;
use crate::measured::{ConfigurationMeasurement, Role};
use crate::study::{Study, StudyRequest};
use etendue::{Error, Job, Observer, RenderOptions, display_jpeg};
use etendue_core::Plane;
use etendue_core::quantity::Display;

/// Gain of differences in the encoded image.
const GAIN: f32 = 4.0;
/// Maximum fraction of a study's time for one image.
const MAX_IMAGE_TIME_FRACTION: f64 = 0.03;
/// Quality of the JPEG.
pub(crate) const QUALITY: u8 = 92;
/// Maximum samples per pixel of an image.
const MAX_SPP: f64 = 64.0;

/// An image compared with that of the exact form.
#[derive(Clone, Debug)]
pub struct ImageComparison {
    /// File name.
    pub file: String,
    /// Exact form, approximation, and four times their difference on grey, side by side, as JPEG.
    pub jpeg: Vec<u8>,
}

/// Images of a study's approximations, each with as many samples as time allows and with the random numbers of the exact form; empty if the camera makes no
/// images. Runs on the caller's thread pool.
///
/// # Errors
/// The observer cancels, or light is not finite.
pub fn pictures(study: &Study, request: &StudyRequest, observer: &dyn Observer) -> Result<Vec<ImageComparison>, Error> {
    let Some(exact) = study.configurations.iter().find(|measured| measured.configuration.is_exact()) else {
        return Ok(Vec::new());
    };
    let affordable = MAX_IMAGE_TIME_FRACTION * request.budget_s / exact.sample_s.value;
    let spp = affordable.clamp(1.0, MAX_SPP) as u64;
    let image = |configuration: &Configuration| -> Result<Option<Plane<Display>>, Error> {
        let mut request_of = configuration.request(&request.job, &study.camera);
        (request_of.spp, request_of.noise) = (Some(spp), None);
        developed_image(&request_of.open()?, request, observer)
    };
    let Some(reference) = image(&exact.configuration)? else { return Ok(Vec::new()) };
    let mut compared = Vec::new();
    for measured in study.configurations.iter().filter(|measured| is_shown(measured)) {
        let Some(own) = image(&measured.configuration)? else { continue };
        let file = format!("{}.jpg", file_stem(&measured.configuration));
        compared.push(ImageComparison { file, jpeg: display_jpeg(&side_by_side(&reference, &own), QUALITY)? });
    }
    Ok(compared)
}

fn developed_image(
    job: &Job,
    request: &StudyRequest,
    observer: &dyn Observer,
) -> Result<Option<Plane<Display>>, Error> {
    let options = RenderOptions { simd: request.simd, ..RenderOptions::default() };
    let results = job.render(&options, observer)?;
    Ok(results.cameras()[0].display_image())
}

/// Returns true for approximations that are not the exact form.
fn is_shown(measured: &ConfigurationMeasurement) -> bool {
    matches!(measured.role, Role::Approximation | Role::Stated) && !measured.configuration.is_exact()
}

fn file_stem(configuration: &Configuration) -> String {
    let word = configuration.label().replace([',', 'λ'], "");
    word.split_whitespace().collect::<Vec<_>>().join("-")
}

/// The first image, the second, and (second − first) times a gain on grey.
pub(crate) fn side_by_side(first: &Plane<Display>, second: &Plane<Display>) -> Plane<Display> {
    let (width, height) = (first.width(), first.height());
    let mut sheet = Plane::new(3 * width, height);
    for y in 0..height {
        for x in 0..width {
            let (a, b) = (first.at(x, y), second.at(x, y));
            let difference = std::array::from_fn(|i| (0.5 + GAIN * (b[i] - a[i])).clamp(0.0, 1.0));
            sheet.set(x, y, a);
            sheet.set(width + x, y, b);
            sheet.set(2 * width + x, y, difference);
        }
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_differ_by_grey() {
        let plane = |value: f32| Plane::<Display>::filled(4, 3, [value; 3]);
        let sheet = side_by_side(&plane(0.25), &plane(0.25));
        assert_eq!((sheet.width(), sheet.at(1, 2), sheet.at(9, 1)), (12, [0.25; 3], [0.5; 3]));
        let sheet = side_by_side(&plane(0.25), &plane(0.3));
        assert!((sheet.at(8, 0)[0] - 0.7).abs() < 1e-6 && sheet.at(5, 0) == [0.3; 3]);
    }
}
