//! `[render]`: how the light is found. `None` everywhere means: the plan decides.

use crate::fault::{ErrorCode, Faults};
use crate::place::{Place, Placed};
use crate::reader::{Rule, among, choice, either, flag, keyed, list, number, record, variant, vector, whole};
use crate::record::samples::SampleKeys;

/// The largest seed: TOML holds no larger whole number.
pub const MAX_SEED: u64 = i64::MAX.cast_unsigned();

/// The most samples of a pixel.
pub const MAX_SPP: u64 = 1 << 20;

record! {
    /// How the light is found.
    pub struct Render check(check) {
        /// Samples per pixel, 1 … 1 048 576; a multiple of "replicates". Default: 64, or as `--quality` says.
        optional spp: Placed<u64> = whole(1, MAX_SPP);
        /// Samples per pixel of each of the passes whose weighted mean is the light, in the place of "spp": [8, 8, 16] are 32 in three
        /// independent passes. Each is a multiple of "replicates", or less than that many: then so many on average, as that part
        /// of the pixels, evenly spread, gets one sample in each replicate. At least one pass is whole; 64 passes at most.
        /// Default: one pass of "spp" samples, with `--progressive` by its schedule.
        many passes: Placed<f64> = list(number("").above(0.0).at_most(MAX_SPP as f64), 1);
        /// Independent replicates from which the variance is told, 1 … 1 024; one gives no variance. Samples
        /// are spread evenly within a replicate only: where light is even, one replicate of few samples is less noisy than
        /// several. Wavelengths of bands are spread over all replicates, but where "variance" is asked for. Default: 4, or 2 or 1 where "spp" is no multiple.
        optional replicates: Placed<u64> = whole(1, 1024);
        /// A pixel gets samples until its standard error is at most this part of the noise that the sensor adds there (shot, dark,
        /// read, quantisation), above 0 … 100; of the pixel's own mean where no electrons are made, or with route "pupil". The number is
        /// decided for each replicate by what others show after "min_spp" samples, so that no mean is
        /// biased; there are 8 replicates unless said otherwise, and 5 at least. In the place of "spp". Default: every pixel gets "spp" samples.
        optional noise_threshold: Placed<f64> = number("").above(0.0).at_most(100.0);
        /// With "noise_threshold": samples that every pixel gets, 8 … 65 536, a multiple of "replicates". Default: 16.
        optional min_spp: Placed<u64> = whole(8, 65_536);
        /// With "noise_threshold": samples that a pixel gets at most, a multiple of "replicates", from "min_spp" to 1 048 576. Default: 4 096.
        optional max_spp: Placed<u64> = whole(8, 1 << 20);
        /// How much of the light's ways is followed. Depth and identities are the same by every integrator. Default: "path".
        optional integrator: Placed<Integrator> = choice();
        /// Surfaces that a path meets at most, 1 … 1 024; belongs to integrator = "path". Default: 16, or as `--quality` says.
        optional max_bounces: Placed<u64> = whole(1, 1024);
        /// Whether light of suns and glowing surfaces that smooth surfaces throw on matt ones, and mirrors on much less glossy surfaces, is followed. Without it the
        /// picture is darker by that light, and free of the rare bright samples that find it; and rain or snow turns only light on its way to the
        /// camera, not between matt surfaces. Belongs to integrator = "path".
        /// Default: true.
        optional caustics: Placed<bool> = flag();
        /// Whether lobes that come after wider ones are widened (path-space regularisation): metals, coats, glass and paint that a path meets behind a glossy
        /// surface (and behind a matt one where caustics are followed) are rougher than they are, so that lamps in them are found without rare bright
        /// samples. The picture is biased: mirror images in what other surfaces mirror, and caustics, are blurred. What is seen straight or in
        /// mirrors is as it was. Belongs to integrator = "path". Default: false.
        optional regularize: Placed<bool> = flag();
        /// Whether matt surfaces scatter paths to where light was found to come from (path guiding): before each pass a sixteenth as many paths as it has (with "noise_threshold", as "min_spp" makes),
        /// at most 524 288, are followed. Noise of indirect light depends on it, no mean does. Belongs to integrator = "path". Default: false.
        optional guiding: Placed<bool> = flag();
        /// Paths that go on, and lights that are drawn, at the first surface that is no mirror, for each sample, 1 … 64 (branched path tracing): the way there is paid once, and
        /// light has the noise of as many more samples, for less time where that way is long. Edges, depth of field and motion
        /// have the noise of "spp". No mean changes. Excludes "path_reuse_px" above 1; belongs to integrator = "path". Default: 1.
        optional branches: Placed<u64> = whole(1, 64);
        /// Paths of blocks of this many by this many pixels of one colour share their tails: 1 (none do), 2, 4 or 8. It takes
        /// much less time for the same error where light is scattered from surface to surface, but errors of the pixels of
        /// a block are then alike. Belongs to integrator = "path". Default: 1.
        optional path_reuse_px: Placed<u64> = among(&[1, 2, 4, 8]);
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

choice! {
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

choice! {
    /// How much of the light's ways is followed.
    pub enum Integrator {
        /// Local shading: light of lamps, suns and sky on every surface as if nothing stood in its way, nothing else.
        "flat" => Flat,
        /// The same with shadows: light that reaches a surface directly.
        "direct" => Direct,
        /// Everything, by path tracing.
        "path" => Path,
    }
}

choice! {
    /// What is spent on the trees by which rays find surfaces.
    pub enum Accelerator {
        /// The least time to build: to frame a scene of many millions of triangles. Rays take up to a fifth longer.
        "fast" => Fast,
        /// Little time to build, about a microsecond a triangle.
        "default" => Default,
        /// The least time a ray, a few per cent less than with "default", for nearly twice the time to build and half as much
        /// memory again: for long renderings.
        "best" => Best,
    }
}

choice! {
    /// By what a light's chance of being drawn at a surface goes.
    pub enum LightSampling {
        /// Its irradiance, and how much of it a glossy surface sends back along the path.
        "gloss" => Gloss,
        /// Its irradiance alone: a path takes up to a quarter less time where surfaces are glossy and lamps are many, and their mirror images are found by luck.
        "irradiance" => Irradiance,
    }
}

choice! {
    /// The way to the sensor plane.
    pub enum Route {
        /// Every sample goes through the lens.
        "lens" => Lens,
        /// The radiance at the centre of the entrance pupil, then the lens on the picture.
        "pupil" => Pupil,
    }
}

choice! {
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

choice! {
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
    /// A record that says nothing.
    #[must_use]
    pub fn silent(place: Place) -> Self {
        Self {
            place,
            spp: None,
            passes: Vec::new(),
            replicates: None,
            noise_threshold: None,
            min_spp: None,
            max_spp: None,
            integrator: None,
            max_bounces: None,
            caustics: None,
            regularize: None,
            guiding: None,
            branches: None,
            path_reuse_px: None,
            light_sampling: None,
            wavelengths_per_path: None,
            wavelength_density: None,
            route: None,
            band_width_nm: None,
            wavelength_range_nm: None,
            accumulate: None,
            accelerator: None,
            tile_px: None,
            seed: None,
            overscan: None,
            depth_of_field: None,
        }
    }

    /// The limit of noise, where it decides the samples: the command line's "spp" or "passes" supersede that of a file.
    #[must_use]
    pub fn threshold_in_force(&self) -> Option<&Placed<f64>> {
        self.noise_threshold.as_ref().filter(|_| self.sample_keys().has_threshold_in_force())
    }

    /// How many paths go on from a first surface.
    #[must_use]
    pub fn branches_in_force(&self) -> u64 {
        above_one(&self.branches).filter(|_| !self.reuse_counts()).map_or(1, |branches| branches.value)
    }

    /// Side of the squares of pixels whose paths share their tails, px.
    #[must_use]
    pub fn path_reuse_in_force(&self) -> u64 {
        let counts = self.reuse_counts() || above_one(&self.branches).is_none();
        above_one(&self.path_reuse_px).filter(|_| counts).map_or(1, |side| side.value)
    }

    /// Whether the command line's "path_reuse_px" supersedes the "branches" of a file.
    fn reuse_counts(&self) -> bool {
        let is_of_command = |key: &Option<Placed<u64>>| above_one(key).is_some_and(|key| key.place.is_command_line());
        is_of_command(&self.path_reuse_px) && !is_of_command(&self.branches)
    }

    /// The passes, where they are stated and count.
    #[must_use]
    pub fn passes_in_force(&self) -> Option<&[Placed<f64>]> {
        self.sample_keys().has_passes_in_force().then_some(&self.passes[..])
    }

    fn sample_keys(&self) -> SampleKeys {
        SampleKeys {
            spp: self.spp.clone(),
            passes: self.passes.clone(),
            replicates: self.replicates.clone(),
            noise_threshold: self.noise_threshold.clone(),
            min_spp: self.min_spp.clone(),
            max_spp: self.max_spp.clone(),
        }
    }

    /// The keys that only paths need, as far as they are said, and where.
    fn of_paths(&self) -> impl Iterator<Item = (&'static str, &Place)> {
        let keys = [
            ("max_bounces", self.max_bounces.as_ref().map(|b| &b.place)),
            ("caustics", self.caustics.as_ref().map(|c| &c.place)),
            ("regularize", self.regularize.as_ref().map(|r| &r.place)),
            ("guiding", self.guiding.as_ref().map(|g| &g.place)),
            ("branches", self.branches.as_ref().map(|b| &b.place)),
            ("path_reuse_px", self.path_reuse_px.as_ref().map(|t| &t.place)),
        ];
        keys.into_iter().filter_map(|(key, place)| Some((key, place?)))
    }

    /// Whether what stands at `place` is a key that only paths need.
    fn states(&self, place: &Place) -> bool {
        self.of_paths().any(|(_, stated)| stated == place)
    }

    /// What this record says, and `base` where it is silent.
    #[must_use]
    pub fn over(&self, base: &Self) -> Self {
        let (a, b) = (self.clone(), base.clone());
        let samples = self.sample_keys().over(base.sample_keys());
        Self {
            place: a.place,
            spp: samples.spp,
            passes: samples.passes,
            replicates: samples.replicates,
            noise_threshold: samples.noise_threshold,
            min_spp: samples.min_spp,
            max_spp: samples.max_spp,
            integrator: a.integrator.or(b.integrator),
            max_bounces: a.max_bounces.or(b.max_bounces),
            caustics: a.caustics.or(b.caustics),
            regularize: a.regularize.or(b.regularize),
            guiding: a.guiding.or(b.guiding),
            branches: a.branches.or(b.branches),
            path_reuse_px: a.path_reuse_px.or(b.path_reuse_px),
            light_sampling: a.light_sampling.or(b.light_sampling),
            wavelengths_per_path: a.wavelengths_per_path.or(b.wavelengths_per_path),
            wavelength_density: a.wavelength_density.or(b.wavelength_density),
            route: a.route.or(b.route),
            band_width_nm: a.band_width_nm.or(b.band_width_nm),
            wavelength_range_nm: a.wavelength_range_nm.or(b.wavelength_range_nm),
            accumulate: a.accumulate.or(b.accumulate),
            accelerator: a.accelerator.or(b.accelerator),
            tile_px: a.tile_px.or(b.tile_px),
            seed: a.seed.or(b.seed),
            overscan: a.overscan.or(b.overscan),
            depth_of_field: a.depth_of_field.or(b.depth_of_field),
        }
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

/// Checks the records of all cameras, into which the job's has been merged: what only paths need must serve a camera that
/// traces them.
pub(crate) fn check_levels<'r>(cameras: impl Iterator<Item = &'r Render> + Clone, faults: &mut Faults) {
    let traces = |render: &Render| render.integrator.as_ref().is_none_or(|l| l.value == Integrator::Path);
    for render in cameras.clone().filter(|r| !traces(r)) {
        for (key, place) in render.of_paths() {
            if !cameras.clone().any(|r| traces(r) && r.states(place)) {
                let problem = format!("\"{key}\" has no effect here, it belongs to integrator = \"path\"");
                let cause = render.integrator.as_ref().map(|i| &i.place);
                faults.add_idle(ErrorCode::NoEffect, key, place, cause, problem, "remove it, or change the integrator");
            }
        }
    }
}

/// Paths that branch share no tails: of the two keys that of the command line counts.
fn check_branches(render: &Render, faults: &mut Faults) {
    let (Some(branches), Some(reuse)) = (above_one(&render.branches), above_one(&render.path_reuse_px)) else { return };
    let mut idle = |(key, of): (&str, &Placed<u64>), (other, cause): (&str, &Placed<u64>)| {
        let problem =
            format!("\"{key}\" and \"{other}\" = {} exclude each other: paths that branch share no tails", cause.value);
        faults.add_idle(
            ErrorCode::Contradiction,
            key,
            &of.place,
            Some(&cause.place),
            problem,
            "give one of the two, or 1 for the other",
        );
    };
    if render.reuse_counts() {
        idle(("branches", branches), ("path_reuse_px", reuse));
    } else {
        idle(("path_reuse_px", reuse), ("branches", branches));
    }
}

fn above_one(key: &Option<Placed<u64>>) -> Option<&Placed<u64>> {
    key.as_ref().filter(|key| key.value > 1)
}

/// Checks a record into which the job's has been merged. The default route is through the lens.
pub(crate) fn check_merged(render: &Render, faults: &mut Faults) {
    render.sample_keys().check(faults);
    check_branches(render, faults);
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
