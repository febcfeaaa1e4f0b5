//! Groups of cameras with the same light.
//!
//! The light of a camera depends on its pose, its lens and the elements before it, its film, the sampling and storage of light, and, if pixels accumulate
//! electrons, on their response to a second of light. It does not depend on the exposure (unless something moves or flickers), noise (unless samples are
//! adaptive), ADC, effects behind the lens (except for the margin that they need, and a point spread that displaces samples) or processing. Cameras of equal
//! light share one film: that of the first of them in the job, whose index is in the random addresses of all.

use crate::plan::{CameraBody, CameraPlan, LightOwner, Passes, Plan, Route, Settings, TimeDependence, Timing};
use crate::sizes::spectrum_spread::SpectrumSpread;
use crate::sizes::tolerance::Tolerance;
use etendue_core::CameraPath;
use etendue_optics::effects::PointSpread;
use etendue_optics::{Front, Lens, PupilProjection};
use etendue_projection::Raster;
use etendue_sensor::{Cfa, Sensor};
use etendue_spectra::Spectrum;

/// Properties of a camera that determine its light; the world is the plan's.
#[derive(Clone, Debug, PartialEq)]
struct LightKey<'a> {
    path: &'a CameraPath,
    /// Timing, if light depends on time.
    timing: Option<&'a Timing>,
    optics: OpticsKey<'a>,
    sampling: SamplingKey,
    settings: Settings,
    response: Option<ResponseKey<'a>>,
    /// Tolerance of noise-limited sampling.
    tolerance: Option<Tolerance>,
}

/// Optics that determine the camera's rays.
#[derive(Clone, Debug, PartialEq)]
enum OpticsKey<'a> {
    Lens(Box<LensKey<'a>>),
    Pupil(&'a PupilProjection),
}

#[derive(Clone, Debug, PartialEq)]
struct LensKey<'a> {
    lens: &'a Lens,
    front: Option<&'a Front>,
    film: Raster,
    aperture_px: f64,
    /// The image raster, over which the pitch of a mirror's view is computed.
    mirrored: Option<&'a Raster>,
    /// Point spread that displaces samples, and the film's margin, because it varies over the film.
    displacing: Option<(&'a PointSpread, [usize; 2])>,
}

/// Number of samples, seed, and the spread of wavelengths for replicates that give a variance.
#[derive(Clone, Debug, PartialEq, Eq)]
struct SamplingKey {
    spp: u32,
    passes: Option<Passes>,
    replicates: u32,
    seed: u64,
    spread: SpectrumSpread,
}

/// Electrons of pixels per second of light.
#[derive(Clone, Debug, PartialEq)]
struct ResponseKey<'a> {
    filter: &'a Cfa,
    pitch_um: f64,
    fill_factor: f64,
    efficiencies: Vec<&'a Spectrum>,
}

impl<'a> LightKey<'a> {
    fn new(camera: &'a CameraPlan) -> Self {
        let s = &camera.settings;
        Self {
            path: &camera.path,
            timing: (camera.time != TimeDependence::None).then_some(&camera.timing),
            optics: OpticsKey::new(camera),
            sampling: SamplingKey {
                spp: s.spp,
                passes: camera.passes.clone(),
                replicates: s.replicates,
                seed: s.seed,
                spread: camera.spectrum_spread(),
            },
            // Excludes settings with their own place in the key, and the size of a tile, which does not change the light.
            settings: Settings {
                tile_px: 0,
                spp: 0,
                replicates: 0,
                seed: 0,
                route: Route::Lens,
                spectral_gain: None,
                ..*s
            },
            tolerance: camera.tolerance(),
            response: camera.body.sensor.as_ref().filter(|_| s.accumulates_electrons).map(ResponseKey::new),
        }
    }

    /// Differences between two cameras with the same view and rays; `None` if these differ.
    fn differences(&self, other: &Self) -> Option<Vec<&'static str>> {
        if (self.path, &self.optics) != (other.path, &other.optics) {
            return None;
        }
        let samples =
            |key: &Self| (key.sampling.spp, key.sampling.passes.clone(), key.sampling.replicates, key.sampling.seed);
        let storage = |s: &Settings| (s.bands, s.accumulates_electrons, s.range);
        let (a, b) = (&self.settings, &other.settings);
        let same_storage = Settings {
            adaptive: b.adaptive,
            bands: b.bands,
            accumulates_electrons: b.accumulates_electrons,
            range: b.range,
            ..*a
        };
        let unlike = [
            (samples(self) != samples(other), "samples or seed"),
            (self.timing != other.timing, "the exposure times"),
            (storage(a) != storage(b), "the stored spectrum"),
            (
                a.bands == b.bands && self.sampling.spread != other.sampling.spread,
                "variance, which requires independent replicates",
            ),
            (self.tolerance != other.tolerance, "the noise that determines the samples"),
            (same_storage != *b, "the simulated light paths"),
            (
                self.response != other.response && a.accumulates_electrons && b.accumulates_electrons,
                "the spectral response of the pixels",
            ),
        ];
        Some(unlike.iter().filter(|(unlike, _)| *unlike).map(|(_, name)| *name).collect())
    }
}

impl<'a> OpticsKey<'a> {
    fn new(camera: &'a CameraPlan) -> Self {
        let CameraBody { lens, front, aperture_px, .. } = &camera.body;
        match &camera.settings.route {
            Route::Pupil(projection) => Self::Pupil(projection),
            Route::Lens => Self::Lens(Box::new(LensKey {
                lens,
                front: front.as_ref(),
                film: camera.body.film(),
                aperture_px: *aperture_px,
                mirrored: front.as_ref().map(|_| &camera.body.raster),
                displacing: camera.body.effects.displacing().map(|psf| (psf, camera.body.effects.margin_px())),
            })),
        }
    }
}

impl<'a> ResponseKey<'a> {
    fn new(sensor: &'a Sensor) -> Self {
        let p = sensor.parameters();
        Self {
            filter: &p.cfa,
            pitch_um: p.pixel.pitch_um,
            fill_factor: p.pixel.fill_factor,
            efficiencies: p.channels.iter().map(|channel| &channel.quantum_efficiency).collect(),
        }
    }
}

/// Gives every camera the light of the first one with equal light.
pub(crate) fn share_equal_light(cameras: &mut [CameraPlan]) {
    let owners: Vec<LightOwner> = {
        let mut firsts: Vec<(LightKey<'_>, LightOwner)> = Vec::new();
        let mut owner = |camera| owner_of(camera, &mut firsts);
        cameras.iter().map(&mut owner).collect()
    };
    cameras.iter_mut().zip(owners).for_each(|(camera, owner)| camera.light = owner);
}

fn owner_of<'a>(camera: &'a CameraPlan, firsts: &mut Vec<(LightKey<'a>, LightOwner)>) -> LightOwner {
    let key = LightKey::new(camera);
    let owner = match firsts.iter().find(|(first, _)| *first == key) {
        Some((_, owner)) => return owner.clone(),
        None => LightOwner { camera: camera.name.clone(), index: camera.index },
    };
    firsts.push((key, owner.clone()));
    owner
}

/// Explains a camera's own light although an earlier camera has the same view and rays: that camera's name and the differences. `None` if there is no such
/// camera, or the light is shared.
pub(crate) fn own_light_reason<'a>(plan: &'a Plan, camera: &CameraPlan) -> Option<(&'a str, Vec<&'static str>)> {
    let before = plan.cameras.iter().take_while(|other| other.index < camera.index);
    let owners = before.filter(|other| other.is_first_with_light() && other.light != camera.light);
    let key = LightKey::new(camera);
    let apart = owners.filter_map(|other| Some((other.name.as_str(), LightKey::new(other).differences(&key)?)));
    camera.is_first_with_light().then(|| apart.min_by_key(|(_, unlike)| unlike.len())).flatten()
}
