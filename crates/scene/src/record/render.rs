//! `[render]`: light transport and sampling. `None` means that the plan decides.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{Record, Rule, among, choice, either, integer, keyed, number, record, variant, vector, words};
use crate::record::paths::PathKeys;
use crate::record::samples::SampleKeys;
use etendue_core::{Accelerator, Integrator, LightSampling};

/// The largest seed: TOML holds no larger whole number.
pub const MAX_SEED: u64 = i64::MAX.cast_unsigned();

record! {
    /// Light transport and sampling.
    pub struct Render check(check) {
        /// Number of samples.
        inline samples: SampleKeys;
        /// Light paths that are simulated. Depth and identities are equal for every integrator. Default: "path".
        optional integrator: Placed<Integrator> = choice();
        /// Settings of the path integrator.
        inline paths: PathKeys;
        /// Criterion of light sampling; affects noise only. Default: "gloss".
        optional light_sampling: Placed<LightSampling> = choice();
        /// Wavelengths of a path. Default: 4.
        optional wavelengths_per_path: Placed<u64> = among(&[1, 4, 8]);
        /// Density of sampled wavelengths; affects noise only. Default: "auto".
        optional wavelength_density: Placed<WavelengthDensity> = choice();
        /// Through the lens (exact), or from the pupil's centre (fast, reusable). Default: "lens".
        optional route: Placed<Route> = choice();
        /// Width of the spectral bands; the range is a whole number of them. Default: 5.
        optional band_width_nm: Placed<f64> = number("nm").at_least(1.0).at_most(100.0);
        /// First and last wavelength. Default: as the cameras need.
        optional wavelength_range_nm: Placed<[f64; 2]> = vector::<2>(number("nm").at_least(300.0).at_most(1100.0));
        /// Pixels sum a spectral cube, or electrons. Default: "auto", as the outputs need.
        optional accumulate: Placed<Accumulate> = choice();
        /// Build effort of ray-tracing structures, without effect on pixels; the best of several cameras counts. Default: "default".
        optional accelerator: Placed<Accelerator> = choice();
        /// Side of a tile. Default: 32.
        optional tile_px: Placed<u64> = integer(4, 1024);
        /// Seed of all random numbers. Default: 0.
        optional seed: Placed<u64> = integer(0, MAX_SEED);
        /// With route "pupil": margin on every side, as a fraction of the image's size. Default: 0.
        optional overscan: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// With route "pupil": defocus blur. Default: "physical".
        optional depth_of_field: DepthOfField = depth_of_field();
    }
}

/// Defocus blur computed from stored radiance.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a description has few of them, and places of values take most of it")]
pub enum DepthOfField {
    /// A method without parameters.
    Named(Placed<DepthMethod>),
    /// A blend with a blurred image.
    Fast(FastBlend),
}

words! {
    /// A method without parameters.
    pub enum DepthMethod {
        /// The outline of the pupil at each field point, spread in order of depth.
        "physical" => Physical,
        /// No defocus blur.
        "none" => None,
    }
}

keyed! {
    /// A method with parameters.
    pub enum ParametricDepthMethod {
        /// Artistic: a blend with one blurred copy, by distance.
        fast => Fast(FastBlend) = record::<FastBlend>();
    }
}

record! {
    /// A blend with one blurred copy of the image. The weight of the copy is 0 in the sharp range, 1 in the blurred range, and linear in the distance
    /// (along the ray) between them.
    pub struct FastBlend check(check_blend) {
        /// Two increasing distances: blurred before the first, sharp beyond the second. Default: nothing near is blurred.
        optional near_m: Placed<[f64; 2]> = vector::<2>(number("m").at_least(0.0));
        /// Two increasing distances: sharp before the first, blurred beyond the second. Default: nothing far is blurred.
        optional far_m: Placed<[f64; 2]> = vector::<2>(number("m").at_least(0.0));
        /// Diameter of the blur; the kernel is a bell of this width.
        required blur_px: Placed<f64> = number("px").above(0.0).at_most(1000.0);
    }
}

fn depth_of_field() -> impl Rule<Out = DepthOfField> {
    let fast = variant!(record::<ParametricDepthMethod>(), ParametricDepthMethod::Fast => DepthOfField::Fast);
    either(variant!(choice(), DepthOfField::Named), fast)
}

fn check_blend(blend: &FastBlend, errors: &mut DescriptionErrors) {
    for range in [&blend.near_m, &blend.far_m].into_iter().flatten() {
        if range[0] >= range[1] {
            let problem = format!("found {} m before {} m", range[0], range[1]);
            errors.add(
                ErrorCode::WrongOrder,
                &range.place,
                problem,
                "give the shorter distance first and a longer one after it",
            );
        }
    }
}

impl DepthOfField {
    /// Place in the description.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Named(method) => &method.place,
            Self::Fast(blend) => &blend.place,
        }
    }
}

words! {
    /// The optical path to the sensor plane.
    pub enum Route {
        /// Every sample passes through the lens.
        "lens" => Lens,
        /// Radiance at the centre of the entrance pupil; the lens is then applied to the image.
        "pupil" => Pupil,
    }
}

words! {
    /// Density from which wavelengths are sampled for pixels that sum electrons.
    pub enum WavelengthDensity {
        /// The pixel's response, multiplied by the spectrum of the light where that is estimated to lower the variance and no bands are stored.
        "auto" => Auto,
        /// Uniform over the range.
        "uniform" => Uniform,
        /// The pixel's response.
        "response" => Response,
        /// The pixel's response times the spectra of the scene's light sources.
        "response_and_source" => ResponseAndSource,
    }
}

words! {
    /// The quantity that pixels sum.
    pub enum Accumulate {
        /// The quantity that the outputs need.
        "auto" => Auto,
        /// Spectral bands.
        "cube" => Cube,
        /// Electrons.
        "electrons" => Electrons,
    }
}

impl Render {
    /// Returns the keys of the record, completed by those of `base`.
    pub(crate) fn over(&self, base: &Self) -> Self {
        let (mut own, mut base) = (self.clone(), base.clone());
        own.samples.exclude(&mut base.samples);
        Record::over(&own, &base)
    }
}

fn check(render: &Render, errors: &mut DescriptionErrors) {
    if let Some(range) = &render.wavelength_range_nm
        && range[0] >= range[1]
    {
        let problem = format!("found {} to {}", range[0], range[1]);
        errors.add(
            ErrorCode::WrongOrder,
            &range.place,
            problem,
            "give the shorter wavelength first and a longer one after it",
        );
    }
}

/// Checks a record into which the job's has been merged. The default route is through the lens.
pub(crate) fn check_merged(render: &Render, errors: &mut DescriptionErrors) {
    render.samples.check(errors);
    render.paths.check_branches(errors);
    if render.route.as_ref().is_some_and(|r| r.value == Route::Pupil) {
        return;
    }
    let keys = [
        ("overscan", render.overscan.as_ref().map(|o| &o.place), "remove it"),
        (
            "depth_of_field",
            render.depth_of_field.as_ref().map(DepthOfField::place),
            "remove it: the lens determines the defocus by its f-number and focus",
        ),
    ];
    for (key, place, remedy) in keys {
        if let Some(place) = place {
            let problem = format!("\"{key}\" has no effect here, it belongs to route = \"pupil\"");
            errors.add_without_effect(
                ErrorCode::NoEffect,
                key,
                place,
                render.route.as_ref().map(|route| &route.place),
                problem,
                remedy,
            );
        }
    }
}

/// Checks the records of all cameras, into which the job's has been merged. A key of the path integrator must apply to at least one camera that
/// traces paths.
pub(crate) fn check_path_keys<'r>(cameras: impl Iterator<Item = &'r Render> + Clone, errors: &mut DescriptionErrors) {
    let traces = |render: &Render| render.integrator.as_ref().is_none_or(|key| key.value == Integrator::Path);
    let serves = |place: &Place| {
        let mut tracing = cameras.clone().filter(|render| traces(render));
        tracing.any(|render| render.paths.to_table().entries().any(|(_, item)| item.place == *place))
    };
    for render in cameras.clone().filter(|render| !traces(render)) {
        let cause = render.integrator.as_ref().map(|integrator| &integrator.place);
        for (key, item) in render.paths.to_table().entries().filter(|(_, item)| !serves(&item.place)) {
            let problem = format!("\"{key}\" has no effect here, it belongs to integrator = \"path\"");
            errors.add_without_effect(
                ErrorCode::NoEffect,
                key,
                &item.place,
                cause,
                problem,
                "remove it, or change the integrator",
            );
        }
    }
}
