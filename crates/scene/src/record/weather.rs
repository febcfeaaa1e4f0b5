//! A weather file: weather that `etendue weather` adds to stored radiance.

use super::light::Emission;
use super::medium::{DensityNoise, Extinction, MediumShape};
use super::precipitation::Precipitation;
use super::transform::Transform;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::SpectrumValues;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{list, number, record, text, variants};

record! {
    /// Fog added to stored radiance by Koschmieder's law (1924): L = L₀ T + L_air (1 − T), T = exp(−∫β dt) along each pixel's ray; and streaks of
    /// rain or snow. At least one of the two.
    pub struct Weather check(check_weather) {
        /// Airlight: radiance of fog of infinite depth.
        required airlight: Airlight = record();
        /// Fog; overlapping fogs add up.
        many fog: Fog = list(record(), 0);
        /// Rain or snow: near drops and flakes as streaks, far ones by Koschmieder's law.
        optional precipitation: Precipitation = record();
        /// Exposure of streaks from the image's time on; required with "precipitation".
        optional exposure_s: Placed<f64> = number("s").above(0.0).at_most(60.0);
    }
}

variants! {
    /// Radiance of fog of infinite depth.
    pub enum Airlight by "type" {
        /// Equal in all directions, with the keys of an emission.
        "uniform" => Uniform(Emission),
        /// Mean of the image's sky above the horizon.
        "sky" => Sky(AirlightSky),
    }
}

record! {
    /// Airlight from the sky's own radiance.
    pub struct AirlightSky {
        /// Greatest elevation of the averaged sky. Default: 10.
        optional elevation_deg: Placed<f64> = number("°").above(0.0).at_most(90.0);
    }
}

record! {
    /// Fog in a part of the world.
    pub struct Fog check(check) {
        /// Name.
        required name: Placed<String> = text("the name of the fog");
        /// Density.
        inside extinction: Extinction;
        /// Part of the world that it fills. Default: everywhere.
        optional shape: MediumShape = record();
        /// Placement of the shape in the world; only of shapes with bounds.
        inside transform: Transform;
        /// Variation of the density. Default: homogeneous.
        optional unevenness: DensityNoise = record();
    }
}

fn check_weather(weather: &Weather, errors: &mut DescriptionErrors) {
    check_airlight(weather, errors);
    match (&weather.precipitation, &weather.exposure_s) {
        (None, None) if weather.fog.is_empty() => {
            errors.add(
                ErrorCode::Empty,
                &weather.place,
                "the file contains no weather",
                "give \"fog\" or \"precipitation\"",
            );
        }
        (None, Some(exposure)) => errors.add(
            ErrorCode::NoEffect,
            &exposure.place,
            "\"exposure_s\" has no effect without \"precipitation\"",
            "give \"precipitation\", or remove it",
        ),
        (Some(falls), None) => errors.add(
            ErrorCode::MissingKey,
            falls.place(),
            "the image has no exposure time, which streaks need",
            "give \"exposure_s\" next to \"airlight\": the exposure time of the camera that will expose the image",
        ),
        _ => {}
    }
}

fn check_airlight(weather: &Weather, errors: &mut DescriptionErrors) {
    if let Airlight::Uniform(emission) = &weather.airlight
        && let Some((key, place)) = emission.level.flux()
    {
        let problem = format!("\"{key}\" is the flux of a surface, and the air has none");
        errors.add(ErrorCode::Contradiction, place, problem, "give \"luminance_cd_m2\" or \"radiance_w_m2_sr_nm\"");
    }
}

fn check(fog: &Fog, errors: &mut DescriptionErrors) {
    super::medium::check_place(fog.shape.as_ref(), fog.transform.stated_at(), errors);
    super::medium::check_gain(fog.unevenness.as_ref(), errors);
}

impl NamesFiles for Weather {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, airlight, fog, precipitation: _, exposure_s: _ } = self;
        if let Airlight::Uniform(emission) = airlight {
            emission.name_files(files);
        }
        for Fog { place: _, name: _, extinction, shape, transform: _, unevenness: _ } in fog {
            shape.name_files(files);
            if let Extinction::PerMetre(curve) = extinction {
                curve.name_file(SpectrumValues::Light, files);
            }
        }
    }
}
