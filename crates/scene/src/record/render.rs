//! `[render]`: how the light is found. `None` everywhere means: the plan decides.

use crate::fault::{ErrorCode, Faults};
use crate::place::{Place, Placed};
use crate::reader::{Record, Rule, among, choice, either, keyed, number, record, variant, vector, whole, words};
use crate::record::paths::PathKeys;
use crate::record::samples::SampleKeys;
use etendue_core::{Accelerator, Integrator, LightSampling};

/// The largest seed: TOML holds no larger whole number.
pub const MAX_SEED: u64 = i64::MAX.cast_unsigned();

record! {
    /// How the light is found.
    pub struct Render check(check) {
        /// What decides the samples.
        inline samples: SampleKeys;
        /// How much of the light's ways is followed. Depth and identities are the same by every integrator. Default: "path".
        optional integrator: Placed<Integrator> = choice();
        /// What only paths need.
        inline paths: PathKeys;
        /// By what a light's chance of being drawn at a surface goes: the noise of surfaces that mirror lamps depends on it, no mean does. Default: "gloss".
        optional light_sampling: Placed<LightSampling> = choice();
        /// Wavelengths that a path carries. Default: 4.
        optional wavelengths_per_path: Placed<u64> = among(&[1, 4, 8]);
        /// The density by which the wavelengths of pixels that sum electrons are drawn: their noise depends on it, their mean does not.
        /// Default: "auto".
        optional wavelength_density: Placed<WavelengthDensity> = choice();
        /// Through the lens (exact), or as seen from the centre of the entrance pupil (fast, reusable). Default: "lens".
        optional route: Placed<Route> = choice();
        /// Width of the spectral bands, nm, 1 … 100; the range is a whole number of bands. Default: 5.
        optional band_width_nm: Placed<f64> = number("nm").at_least(1.0).at_most(100.0);
        /// First and last wavelength, nm, within 300 … 1 100. Default: what the cameras need.
        optional wavelength_range_nm: Placed<[f64; 2]> = vector::<2>(number("nm").at_least(300.0).at_most(1100.0));
        /// Whether a spectral cube is kept or pixels sum electrons directly. Default: "auto", what the outputs need.
        optional accumulate: Placed<Accumulate> = choice();
        /// What is spent on the trees by which rays find surfaces. No pixel depends on it; of several cameras, the
        /// last of "fast", "default", "best" counts. Default: "default".
        optional accelerator: Placed<Accelerator> = choice();
        /// Side of a tile, px, 4 … 1 024. Default: 32.
        optional tile_px: Placed<u64> = whole(4, 1024);
        /// Seed of every random number, 0 … 2⁶³ − 1. Default: 0.
        optional seed: Placed<u64> = whole(0, MAX_SEED);
        /// With route "pupil": margin on every side, as a share of the picture's width and height, 0 … 1. Default: 0.
        optional overscan: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// With route "pupil": how things out of focus are blurred in the picture. Default: "physical".
        optional depth_of_field: DepthOfField = depth_of_field();
    }
}

/// How things out of focus are blurred behind stored radiance.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a description has few of them, and places of values take most of it")]
pub enum DepthOfField {
    /// By a method without parameters.
    Named(Placed<DepthMethod>),
    /// By a blend.
    Fast(FastBlend),
}

words! {
    /// A method without parameters.
    pub enum DepthMethod {
        /// The pupil's own outline of each field point, spread in the order of depth.
        "physical" => Physical,
        /// Nothing is blurred.
        "none" => None,
    }
}

keyed! {
    /// A method with parameters.
    pub enum DepthOfFieldTable {
        /// A look, by a blend with one blurred copy of the picture by distance.
        fast => Fast(FastBlend) = record::<FastBlend>();
    }
}

record! {
    /// A blend with one blurred copy of the picture: none of it in the sharp range, all of it where things are blurred, and
    /// linear in the distance (along the ray) between.
    pub struct FastBlend check(check_blend) {
        /// Two rising distances, m: to the first from the camera everything is blurred, from the second on it is sharp. Default:
        /// nothing near is blurred.
        optional near_m: Placed<[f64; 2]> = vector::<2>(number("m").at_least(0.0));
        /// Two rising distances, m: to the first everything is sharp, from the second on it is blurred. Default: nothing far is
        /// blurred.
        optional far_m: Placed<[f64; 2]> = vector::<2>(number("m").at_least(0.0));
        /// Diameter of the blur, px, above 0, at most 1 000: a bell as wide as a disc of it.
        required blur_px: Placed<f64> = number("px").above(0.0).at_most(1000.0);
    }
}

fn depth_of_field() -> impl Rule<Out = DepthOfField> {
    let fast = variant!(record::<DepthOfFieldTable>(), DepthOfFieldTable::Fast => DepthOfField::Fast);
    either(variant!(choice(), DepthOfField::Named), fast)
}

fn check_blend(blend: &FastBlend, faults: &mut Faults) {
    for range in [&blend.near_m, &blend.far_m].into_iter().flatten() {
        if range[0] >= range[1] {
            let problem = format!("found {} m before {} m", range[0], range[1]);
            faults.add(
                ErrorCode::WrongOrder,
                &range.place,
                problem,
                "give the shorter distance first and a longer one after it",
            );
        }
    }
}

impl DepthOfField {
    /// Where it stands.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Named(method) => &method.place,
            Self::Fast(blend) => &blend.place,
        }
    }
}

words! {
    /// The way to the sensor plane.
    pub enum Route {
        /// Every sample goes through the lens.
        "lens" => Lens,
        /// The radiance at the centre of the entrance pupil, then the lens on the picture.
        "pupil" => Pupil,
    }
}

words! {
    /// The density by which the wavelengths of pixels that sum electrons are drawn.
    pub enum WavelengthDensity {
        /// By the response, and by the light's spectrum with it where that is foretold to lessen the variance and no bands are kept.
        "auto" => Auto,
        /// Evenly over the range.
        "uniform" => Uniform,
        /// By the pixel's response.
        "response" => Response,
        /// By the pixel's response times the spectra of the scene's sources of light.
        "response_and_source" => ResponseAndSource,
    }
}

words! {
    /// What pixels sum.
    pub enum Accumulate {
        /// What the outputs need.
        "auto" => Auto,
        /// Spectral bands.
        "cube" => Cube,
        /// Electrons.
        "electrons" => Electrons,
    }
}

impl Render {
    /// The keys of the record, and those of `base` where it has none.
    pub(crate) fn over(&self, base: &Self) -> Self {
        let (mut own, mut base) = (self.clone(), base.clone());
        own.samples.exclude(&mut base.samples);
        Record::over(&own, &base)
    }
}

fn check(render: &Render, faults: &mut Faults) {
    if let Some(range) = &render.wavelength_range_nm
        && range[0] >= range[1]
    {
        let problem = format!("found {} to {}", range[0], range[1]);
        faults.add(
            ErrorCode::WrongOrder,
            &range.place,
            problem,
            "give the shorter wavelength first and a longer one after it",
        );
    }
}

/// Checks a record into which the job's has been merged. The default route is through the lens.
pub(crate) fn check_merged(render: &Render, faults: &mut Faults) {
    render.samples.check(faults);
    render.paths.check_branches(faults);
    if render.route.as_ref().is_some_and(|r| r.value == Route::Pupil) {
        return;
    }
    let keys = [
        ("overscan", render.overscan.as_ref().map(|o| &o.place), "remove it"),
        (
            "depth_of_field",
            render.depth_of_field.as_ref().map(DepthOfField::place),
            "remove it: through the lens the blur is the lens's own, by its f-number and focus",
        ),
    ];
    for (key, place, remedy) in keys {
        if let Some(place) = place {
            let problem = format!("\"{key}\" has no effect here, it belongs to route = \"pupil\"");
            faults.add_idle(
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

/// Checks the records of all cameras, into which the job's has been merged: what only paths need must serve a camera that
/// traces them.
pub(crate) fn check_path_keys<'r>(cameras: impl Iterator<Item = &'r Render> + Clone, faults: &mut Faults) {
    let traces = |render: &Render| render.integrator.as_ref().is_none_or(|key| key.value == Integrator::Path);
    let serves = |place: &Place| {
        let mut tracing = cameras.clone().filter(|render| traces(render));
        tracing.any(|render| render.paths.to_table().entries().any(|(_, item)| item.place == *place))
    };
    for render in cameras.clone().filter(|render| !traces(render)) {
        let cause = render.integrator.as_ref().map(|integrator| &integrator.place);
        for (key, item) in render.paths.to_table().entries().filter(|(_, item)| !serves(&item.place)) {
            let problem = format!("\"{key}\" has no effect here, it belongs to integrator = \"path\"");
            faults.add_idle(
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
