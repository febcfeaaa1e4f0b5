//! The plan: everything that a rendering needs, resolved and checked. Immutable.

use crate::block::Blocks;
use crate::remark::Remark;
use etendue_core::{Bands, CameraPose};
use etendue_isp::{Mosaic, Processing};
use etendue_optics::{DepthOfField, Effects, Front, FrontRay, Lens, PupilProjection};
use etendue_projection::Raster;
use etendue_scene::Place;
use etendue_sensor::Sensor;
use etendue_tracer::accel::World;
use etendue_tracer::integrator::Level;
use etendue_tracer::lights::Sources;
use etendue_tracer::materials::MaterialTable;
use glam::DVec2;

/// What a rendering does, for all cameras of a job.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Meshes and instances.
    pub world: World,
    /// Materials and textures.
    pub material_table: MaterialTable,
    /// What shines but is no surface.
    pub sources: Sources,
    /// What is said of the sky, where the surroundings are one.
    pub sky: Option<SkyFacts>,
    /// The cameras.
    pub cameras: Vec<CameraPlan>,
    /// What the instance ids of the ground truth stand for, from id 1.
    pub identities: Vec<Identity>,
    /// Names of the materials; the ground truth's material id is the place in this list, from 1.
    pub materials: Vec<String>,
    /// Semantic classes: name and id.
    pub classes: Vec<(String, u32)>,
    /// What was read and not used, what was dropped, where tables end.
    pub remarks: Vec<Remark>,
    /// Which keys of the files the command line makes meaningless, in sentences.
    pub notices: Vec<String>,
    /// Hash of all that decides the result: description, assets by content, version.
    pub hash: [u8; 32],
}

/// A clear sky in figures, for people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyFacts {
    /// Turbidity.
    pub turbidity: f64,
    /// Height of the sun's centre, degrees.
    pub sun_elevation_deg: f64,
    /// Azimuth of the sun's centre from +x towards +y, degrees.
    pub sun_azimuth_deg: f64,
    /// Illuminance of level ground by the sky, lx.
    pub sky_lx: f64,
    /// Illuminance of level ground by the sky's own sun, lx; 0 where it is left out or down.
    pub sun_lx: f64,
}

/// What an instance id stands for.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Identity {
    /// The instance's name.
    pub name: String,
    /// Its semantic class.
    pub class: Option<String>,
}

/// One camera of a plan.
#[derive(Clone, Debug)]
pub struct CameraPlan {
    /// Its name, part of file names.
    pub name: String,
    /// Its place in the job, part of the random addresses of its noise.
    pub index: u32,
    /// Whose light it sees: its own, or that of the first camera of the job whose light is equal.
    pub light: LightOwner,
    /// Where it stands.
    pub pose: CameraPose,
    /// Everything behind the scene.
    pub body: CameraBody,
    /// How its light is found.
    pub settings: Settings,
    /// How things out of focus are blurred at the pupil; none through the lens, whose rays do it.
    pub depth_of_field: DepthOfField,
    /// What it delivers.
    pub products: Products,
}

/// The camera that a film is rendered for; others of equal light use it too.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightOwner {
    /// Its name.
    pub camera: String,
    /// Its place in the job, part of the random addresses of the light.
    pub index: u32,
}

/// A camera wherever it stands: lens, effects, sensor, processing.
#[derive(Clone, Debug)]
pub struct CameraBody {
    /// Where the description says how large the picture is.
    pub place: Place,
    /// The pixel grid.
    pub raster: Raster,
    /// The lens.
    pub lens: Lens,
    /// What stands in front of it; `None` where nothing does.
    pub front: Option<Front>,
    /// What becomes of the irradiance behind the lens.
    pub effects: Effects,
    /// Side of the photosensitive area, in pixels.
    pub aperture_px: f64,
    /// The electronics; `None` where no electrons are wanted.
    pub sensor: Option<Sensor>,
    /// How raw becomes a picture; `None` where none is wanted.
    pub development: Option<Development>,
}

/// How raw becomes a picture.
#[derive(Clone, Debug)]
pub struct Development {
    /// Which pixel measures which colour.
    pub mosaic: Mosaic,
    /// Every step.
    pub processing: Processing,
    /// How the picture is written.
    pub format: PictureFormat,
}

/// How a picture is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Without loss.
    Png {
        /// Bits of a channel: 8, or 10 to 16 in a file of 16.
        bits: u32,
    },
    /// With loss, 8 bits.
    Jpeg {
        /// 1 to 100.
        quality: u8,
    },
}

impl PictureFormat {
    /// The extension of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png { .. } => "png",
            Self::Jpeg { .. } => "jpg",
        }
    }

    /// Bits of a channel.
    #[must_use]
    pub fn bits(self) -> u32 {
        match self {
            Self::Png { bits } => bits,
            Self::Jpeg { .. } => 8,
        }
    }
}

impl CameraBody {
    /// How its pictures are written.
    #[must_use]
    pub fn picture_format(&self) -> PictureFormat {
        self.development.as_ref().map_or(PictureFormat::Png { bits: 8 }, |development| development.format)
    }
}

/// The way to the sensor plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one a camera, and settings that hold it stay Copy")]
pub enum Route {
    /// Every sample goes through the lens.
    Lens,
    /// Radiance at the centre of the entrance pupil in this geometry, then the lens on the picture.
    Pupil(PupilProjection),
}

/// How the light of a camera is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples a pixel.
    pub spp: u32,
    /// Independent replicates; divides `spp`.
    pub replicates: u32,
    /// How much of the light's ways is followed.
    pub level: Level,
    /// Greatest number of scattering events; 1 where no paths are traced.
    pub max_bounces: u32,
    /// Whether caustics of lamps are followed.
    pub caustics: bool,
    /// Wavelengths a path: 1, 4 or 8.
    pub wavelengths: u32,
    /// The way to the sensor plane.
    pub route: Route,
    /// Shortest and longest wavelength sampled, nm.
    pub range_nm: (f64, f64),
    /// Spectral bands, where a cube is kept.
    pub bands: Option<Bands>,
    /// Whether pixels fold their responsivity into electrons.
    pub folded: bool,
    /// Side of a tile, px.
    pub tile_px: u32,
    /// Pixels whose paths share their tails.
    pub blocks: Blocks,
    /// Seed of every random number.
    pub seed: u64,
}

/// File format of digital numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawFormat {
    /// 16-bit PNG.
    Png,
    /// TIFF of 16 or 32 bits.
    Tiff,
    /// Digital Negative.
    Dng,
}

impl RawFormat {
    /// The one that a sensor's numbers have unless another is asked for.
    #[must_use]
    pub fn usual(sensor: Option<&Sensor>) -> Self {
        if sensor.is_some_and(|s| s.delivered_bits() > 16) { Self::Tiff } else { Self::Png }
    }

    /// The extension of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Tiff => "tif",
            Self::Dng => "dng",
        }
    }
}

/// What a camera delivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Products {
    /// Spectral radiance.
    pub radiance: bool,
    /// Spectral irradiance on the sensor.
    pub irradiance: bool,
    /// The part of the irradiance that is ghosts.
    pub ghosts: bool,
    /// Variances of what is estimated.
    pub variance: bool,
    /// Expected electrons.
    pub electrons: bool,
    /// Digital numbers.
    pub raw: bool,
    /// Their file format.
    pub raw_format: RawFormat,
    /// What each pixel's digital number is made of.
    pub signal_breakdown: bool,
    /// The picture.
    pub picture: bool,
    /// Depth, normals, positions, identities.
    pub ground_truth: bool,
    /// Positions in the camera's frame with it.
    pub camera_space_position: bool,
    /// Depth as 16-bit PNG, by its numbers a metre.
    pub depth_png_per_m: Option<f64>,
    /// Origin and direction of each pixel's ray.
    pub rays: bool,
    /// Ground truth, rays and picture of the undistorted twin as well, by its focal length over the camera's.
    pub undistorted: Option<f64>,
}

impl Products {
    /// Whether nothing is delivered.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let light = self.radiance || self.irradiance || self.ghosts || self.electrons;
        let images = light || self.raw || self.picture || self.signal_breakdown;
        !(images || self.ground_truth || self.depth_png_per_m.is_some() || self.rays)
    }
}

impl Plan {
    /// The camera of a name.
    #[must_use]
    pub fn camera(&self, name: &str) -> Option<&CameraPlan> {
        self.cameras.iter().find(|camera| camera.name == name)
    }

    /// The hash in hexadecimal.
    #[must_use]
    pub fn hash_text(&self) -> String {
        self.hash.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

impl CameraBody {
    /// The pixels that are rendered: the picture's, and those beyond it that the effects need.
    #[must_use]
    pub fn film(&self) -> Raster {
        self.effects.film(&self.raster)
    }

    /// The ray by which ground truth looks from a point of the picture (px), and whether it is off the pupil's centre;
    /// `None` where no light comes.
    #[must_use]
    pub fn truth_ray(&self, raster_px: DVec2) -> Option<(FrontRay, bool)> {
        let sensor_mm = self.raster.sensor_mm(raster_px);
        match &self.front {
            Some(front) => front.truth_ray(&self.lens, sensor_mm),
            None => self.lens.truth_ray(sensor_mm).map(|truth| (FrontRay::bare(truth.ray), truth.off_centre)),
        }
    }

    /// Whether a ray or its weight depends on the wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.lens.disperses() || self.front.as_ref().is_some_and(Front::disperses)
    }
}

impl CameraPlan {
    /// Whether no camera before it in the job has the same light.
    #[must_use]
    pub fn owns_light(&self) -> bool {
        self.light.index == self.index
    }

    /// Columns and rows of the film: of the picture with its margin, or of the stored radiance.
    #[must_use]
    pub fn film_size(&self) -> (u32, u32) {
        match &self.settings.route {
            Route::Lens => (self.body.film().width() as u32, self.body.film().height() as u32),
            Route::Pupil(projection) => (projection.width() as u32, projection.height() as u32),
        }
    }
}
