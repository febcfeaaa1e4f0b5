//! The command line, as typed.

pub mod chart;
pub mod file_name;
pub mod measure;
pub mod sensor;
pub mod trade;
pub mod words;

use clap::{Args, Parser, Subcommand, ValueEnum};
use etendue::measure::LensRequest;
use etendue::{DevelopRequest, Existing, ExposeRequest, JobRequest, Levels, ShardSpec};
use etendue_optics::{DepthOfField, FastBlend, FastParameters};
use etendue_scene::record::render::LARGEST_SEED;
use std::path::{Path, PathBuf};
use trade::{Integrator, Quality};

/// Spectral path tracing joined to a physical camera: from a scene file to the picture that camera would have taken.
#[derive(Debug, Parser)]
#[command(name = "etendue", version, max_term_width = 110)]
#[command(after_help = "Exit status: 0 done, 1 a comparison or run failed, 2 unusable input or arguments.\n\
    Results go to stdout, everything else to stderr. Start with: etendue render scenes/street/street.toml -o out/street")]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
}

/// The verbs of the command line.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Render radiance, image, raw and ground truth of a job's cameras
    Render(Render),
    /// Join the shards of one job to the result of an unsharded run, byte for byte
    Merge(Merge),
    /// Print what will be modelled, what is left out and why, and what it will cost
    Plan(Plan),
    /// Photograph a stored radiance image (rendered with route = "pupil") by another lens and sensor
    Expose(Expose),
    /// Make pictures of raws that were taken before, by another processing
    Develop(Develop),
    /// Photograph even light by a camera's bare sensor, or take the series by which EMVA 1288 measures; nothing is traced
    Flat(sensor::Flat),
    /// Make a camera file of an EMVA 1288 data sheet; figures that contradict each other are refused
    Datasheet(sensor::DataSheet),
    /// Say what is in a file, with units; make a picture of it
    Inspect(Inspect),
    /// Compare two results: errors with their uncertainty; exit status 1 where they differ
    Compare(Compare),
    /// Make a test chart as a scene ready to render, with its truth beside it
    #[command(subcommand)]
    Chart(chart::Chart),
    /// Measure a camera: from pictures, or its lens without rendering
    #[command(subcommand)]
    Measure(Measure),
    /// Find a camera's intrinsics and distortion from several pictures of a chart, as a camera file
    Calibrate(measure::calibrate::CalibrateArgs),
    /// Print the JSON Schema of a file kind, for editors
    Schema(Schema),
}

/// A job file and what the command line changes in it.
#[derive(Debug, Args)]
pub struct Job {
    /// The job file (TOML)
    #[arg(value_name = "JOB.toml")]
    pub job: PathBuf,
    /// Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Samples a pixel, over all replicates, of every camera [default: the job's, or the quality's]
    #[arg(long, value_name = "N")]
    pub spp: Option<u64>,
    /// How much of the light's ways every camera follows, as render.level says it [default: the job's, or path]
    #[arg(long, value_enum)]
    pub integrator: Option<Integrator>,
    /// A preset of samples and bounces, for what the job file leaves open
    #[arg(long, value_enum)]
    pub quality: Option<Quality>,
    /// Render only this camera of the job
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// The seed of all random numbers [default: the job's, or 0]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

impl From<&Job> for JobRequest {
    fn from(a: &Job) -> Self {
        Self {
            job: a.job.clone(),
            set: a.set.clone(),
            spp: a.spp,
            integrator: a.integrator.map(Into::into),
            quality: a.quality.map(Into::into),
            camera: a.camera.clone(),
            seed: a.seed,
        }
    }
}

/// Where results go.
#[derive(Debug, Args)]
pub struct Output {
    /// Folder for the results; made where missing
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Replace results that are already there
    #[arg(long)]
    pub overwrite: bool,
}

impl Output {
    /// The folder, and whether results there may be replaced.
    pub fn folder(&self) -> (&Path, Existing) {
        (&self.output, if self.overwrite { Existing::Replace } else { Existing::Refuse })
    }
}

/// `etendue render`
#[derive(Debug, Args)]
pub struct Render {
    #[command(flatten)]
    pub job: Job,
    #[command(flatten)]
    pub output: Output,
    /// Frames to take, first to last (the last excluded); each has its own sensor noise. The light of a still world is
    /// rendered once
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: std::ops::Range<u32>,
    /// Worker threads [default: one a processor]. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = whole(1, 1024))]
    pub threads: Option<u32>,
    /// Render only the tiles whose number is I modulo N; join the shards with `etendue merge`
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<ShardSpec>,
}

/// `etendue merge`
#[derive(Debug, Args)]
pub struct Merge {
    /// The folders of all shards
    #[arg(required = true, value_name = "DIR")]
    pub shards: Vec<PathBuf>,
    #[command(flatten)]
    pub output: Output,
}

/// `etendue plan`
#[derive(Debug, Args)]
pub struct Plan {
    #[command(flatten)]
    pub job: Job,
}

/// `etendue expose`
#[derive(Debug, Args)]
pub struct Expose {
    /// A spectral radiance image rendered with route = "pupil"
    #[arg(value_name = "RADIANCE.exr")]
    pub radiance: PathBuf,
    /// The camera file (TOML) to photograph it with
    #[arg(long, value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set sensor.exposure_s=0.002
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// The seed of the sensor's noise [default: that of the radiance image]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    /// Frames to take, first to last (the last excluded); each has its own sensor noise
    #[arg(long, value_name = "A..B", value_parser = frames, default_value = "0..1")]
    pub frames: std::ops::Range<u32>,
    /// How things out of focus are blurred: physical, none, or a look, e.g.
    /// fast:blur_px=8,near_m=0.5..2,far_m=10..40 [default: physical]
    #[arg(long, value_name = "METHOD", value_parser = depth_of_field)]
    pub depth_of_field: Option<DepthOfField>,
    #[command(flatten)]
    pub output: Output,
}

impl From<&Expose> for ExposeRequest {
    fn from(a: &Expose) -> Self {
        Self {
            radiance: a.radiance.clone(),
            camera: a.camera.clone(),
            set: a.set.clone(),
            seed: a.seed,
            frames: a.frames.clone(),
            depth_of_field: a.depth_of_field,
        }
    }
}

/// `etendue develop`
#[derive(Debug, Args)]
pub struct Develop {
    /// Raws (PNG, TIFF, DNG), each with its side-car camera.json beside it
    #[arg(required = true, value_name = "RAW")]
    pub raws: Vec<PathBuf>,
    /// The camera file (TOML) whose sensor took them and whose processing makes the pictures
    #[arg(long, value_name = "CAMERA.toml")]
    pub camera: PathBuf,
    /// Change a key of the camera file, e.g. --set processing.demosaic=malvar
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// For raws without a side-car: digital numbers of no light and of a saturated pixel, e.g. 64..4095
    #[arg(long, value_name = "BLACK..WHITE", value_parser = levels)]
    pub levels: Option<Levels>,
    /// The seed of the paper's noises [default: that of the side-car, or 0]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    #[command(flatten)]
    pub output: Output,
}

impl From<&Develop> for DevelopRequest {
    fn from(a: &Develop) -> Self {
        Self { raws: a.raws.clone(), camera: a.camera.clone(), set: a.set.clone(), levels: a.levels, seed: a.seed }
    }
}

/// `etendue inspect`
#[derive(Debug, Args)]
pub struct Inspect {
    /// A file that Étendue reads or writes: EXR, PNG, JPEG, HDR, OBJ, lamps (IES, LDT), JSON side-car
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Write a picture of it here
    #[arg(long, value_name = "OUT.png", value_parser = file_name::png)]
    pub png: Option<PathBuf>,
}

/// `etendue compare`
#[derive(Debug, Args)]
pub struct Compare {
    /// One result: an EXR or PNG file
    #[arg(value_name = "A")]
    pub a: PathBuf,
    /// The other, of the same size and channels
    #[arg(value_name = "B")]
    pub b: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Family-wise probability of calling equal images different, for images that carry their variance
    #[arg(long, value_name = "P", default_value_t = 0.001)]
    pub significance: f64,
    /// Where they differ, write A, B and their difference as pictures into this folder
    #[arg(long, value_name = "DIR")]
    pub difference: Option<PathBuf>,
}

/// `etendue measure`
#[derive(Debug, Subcommand)]
pub enum Measure {
    /// Focal lengths, principal planes, pupils and field of view; by field: distortion, illumination, spots, field
    /// curvature, colour
    Lens(MeasureLens),
    /// Distortion from one picture of a plane chart, without a model: the curve over the field, line distortion, k1 and k2 (ISO
    /// 17850)
    Distortion(measure::distortion::DistortionArgs),
    /// Focal length and principal point, from one picture of a chart at a known distance or from several
    Focal(measure::focal::FocalArgs),
    /// Lateral chromatic displacement of red and blue against green (ISO 19084)
    Chromatic(measure::chromatic::ChromaticArgs),
    /// Photon transfer after EMVA 1288: gain, quantum efficiency, dark noise, saturation, linearity, DSNU, PRNU
    Ptc(measure::ptc::PtcArgs),
    /// Slanted edges: the spatial frequency response with MTF50 and MTF10 (ISO 12233)
    Sfr(measure::sfr::SfrArgs),
    /// The tone curve from a series of exposures or from steps, with linearity and dynamic range (ISO 14524); the camera's
    /// response from a scene at exposures known relatively
    Oecf(measure::oecf::OecfArgs),
    /// A flat field's fall-off over the radial field position
    Vignetting(measure::shading::VignettingArgs),
    /// A flat field's fall-off as a map, and its colour shading (ISO 17957)
    Shading(measure::shading::ShadingArgs),
    /// Temporal and fixed-pattern noise of an even surface (ISO 15739)
    Noise(measure::noise::NoiseArgs),
    /// Light in traps that send none (ISO 18844)
    Flare(measure::flare::FlareArgs),
    /// Colours of a ColorChecker after a fitted matrix, CIEDE2000
    Colour(measure::colour::ColourArgs),
    /// Contrast detection probability of pairs of patches (IEEE P2020)
    Cdp(measure::cdp::CdpArgs),
    /// An estimated depth picture against the truth: bias, error and outliers by range, edges apart
    Depth(measure::depth::DepthArgs),
    /// The dark current's growth with temperature, by three laws
    DarkCurrent(measure::dark_current::DarkCurrentArgs),
    /// A Siemens star: response over frequency (ISO 12233)
    Star(measure::texture::StarArgs),
    /// Texture such as dead leaves against its reference: response, invented structure, coherence
    Texture(measure::texture::TextureArgs),
    /// Two cameras' measurements side by side, or a camera file against what was measured; exit status 1 where they differ
    Compare(measure::compare::CompareArgs),
}

/// `etendue measure lens`
#[derive(Debug, Args)]
pub struct MeasureLens {
    /// A camera file (TOML), a lens of Zemax (.zmx) or CODE V (.seq), or the name of a published lens (double-gauss,
    /// wide-angle, fisheye, telephoto)
    #[arg(value_name = "FILE")]
    pub lens: String,
    /// Change a key of the camera, e.g. --set lens.f_number=4
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// The f-number at infinity focus, in place of the camera's or the lens file's
    #[arg(long, value_name = "N")]
    pub f_number: Option<f64>,
    /// How many field heights, from the axis to the picture's edge
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = whole(2, 1000))]
    pub fields: u32,
    /// For a lens without a sensor: how far the picture reaches from the axis, mm [default: the largest field that a lens
    /// file states, otherwise 21.64; or as far as there is light]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub picture_radius_mm: Option<f64>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

impl From<&MeasureLens> for LensRequest {
    fn from(a: &MeasureLens) -> Self {
        Self {
            lens: a.lens.clone(),
            set: a.set.clone(),
            f_number: a.f_number,
            fields: a.fields,
            picture_radius_mm: a.picture_radius_mm,
        }
    }
}

/// `etendue schema`
#[derive(Debug, Args)]
pub struct Schema {
    /// The kind of file
    #[arg(value_enum)]
    pub kind: SchemaKind,
}

/// Kinds of description files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaKind {
    /// Geometry, materials, lights
    Scene,
    /// Lens, sensor, processing
    Camera,
    /// Scene, cameras, render and output settings
    Job,
    /// What `etendue datasheet` reads
    Datasheet,
}

/// A seed, as the key `seed` admits it.
pub fn seed(text: &str) -> Result<u64, String> {
    let seed = text.parse().ok().filter(|seed| *seed <= LARGEST_SEED);
    seed.ok_or_else(|| format!("expected a whole number from 0 to {LARGEST_SEED}, not '{text}'"))
}

/// Frames that one run takes at most.
const MOST_FRAMES: usize = 100_000;

pub fn frames(text: &str) -> Result<std::ops::Range<u32>, String> {
    let expected = || format!("expected FIRST..END with FIRST < END, e.g. 0..10, not '{text}'");
    let (first, end) = text.split_once("..").ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<u32>().map_err(|_| expected());
    let range = number(first)?..number(end)?;
    match range.len() {
        0 => Err(expected()),
        count if count > MOST_FRAMES => Err(format!("{count} frames; one run takes at most {MOST_FRAMES}")),
        _ => Ok(range),
    }
}

/// A whole number from `least` to `most`.
pub fn whole(least: u32, most: u32) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|n| (least..=most).contains(n));
        number.ok_or_else(|| format!("expected a whole number from {least} to {most}, not '{text}'"))
    }
}

fn levels(text: &str) -> Result<Levels, String> {
    let expected = || format!("expected BLACK..WHITE with BLACK < WHITE, e.g. 64..4095, not '{text}'");
    let (black, white) = text.split_once("..").ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<f64>().map_err(|_| expected());
    let (black_dn, white_dn) = (number(black)?, number(white)?);
    let legal = black_dn >= 0.0 && black_dn < white_dn && white_dn.is_finite();
    legal.then_some(Levels { black_dn, white_dn }).ok_or_else(expected)
}

fn depth_of_field(text: &str) -> Result<DepthOfField, String> {
    match text.split_once(':') {
        None if text == "physical" => Ok(DepthOfField::Physical),
        None if text == "none" => Ok(DepthOfField::None),
        Some(("fast", keys)) => blend(keys).map(DepthOfField::Fast),
        _ => Err(format!("expected physical, none or fast:blur_px=…, not '{text}'")),
    }
}

fn blend(keys: &str) -> Result<FastBlend, String> {
    let (mut near, mut far, mut blur_px) = (None, None, None);
    for pair in keys.split(',') {
        let expected = || format!("expected blur_px=NUMBER, near_m=FROM..TO or far_m=FROM..TO, not '{pair}'");
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| expected());
        let (key, value) = pair.split_once('=').ok_or_else(expected)?;
        let range = || {
            let (from, to) = value.split_once("..").ok_or_else(expected)?;
            Ok::<_, String>((number(from)?, number(to)?))
        };
        match key.trim() {
            "blur_px" => blur_px = Some(number(value)?),
            "near_m" => near = Some(range()?),
            "far_m" => far = Some(range()?),
            _ => return Err(expected()),
        }
    }
    let blur_px = blur_px.ok_or("the diameter of the blur is missing: add blur_px=NUMBER")?;
    if near.is_none() && far.is_none() {
        return Err("nothing is blurred by this: add near_m=FROM..TO or far_m=FROM..TO".to_owned());
    }
    let (blurred_near_m, sharp_near_m) = near.unwrap_or((0.0, 0.0));
    let (sharp_far_m, blurred_far_m) = far.unwrap_or((f64::INFINITY, f64::INFINITY));
    let parameters = FastParameters { sharp_near_m, sharp_far_m, blurred_near_m, blurred_far_m, blur_px };
    FastBlend::new(parameters).map_err(|error| error.to_string())
}

fn shard(text: &str) -> Result<ShardSpec, String> {
    let expected = || format!("expected I/N with I < N, e.g. 0/3, not '{text}'");
    let (index, count) = text.split_once('/').ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<u32>().map_err(|_| expected());
    let (index, count) = (number(index)?, number(count)?);
    if index < count { Ok(ShardSpec { index, count }) } else { Err(expected()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_well_formed() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn whole_numbers_have_ranges() {
        assert_eq!((whole(3, 10)("3"), whole(3, 10)("10")), (Ok(3), Ok(10)));
        assert_eq!(whole(3, 10)("2"), Err("expected a whole number from 3 to 10, not '2'".to_owned()));
        assert_eq!(whole(1, 9)("1.5"), Err("expected a whole number from 1 to 9, not '1.5'".to_owned()));
    }

    #[test]
    fn seeds_and_frames_are_as_many_as_keys_and_memory_hold() {
        assert_eq!(seed("9223372036854775807"), Ok(LARGEST_SEED));
        assert!(seed("9223372036854775808").is_err() && seed("-1").is_err());
        assert_eq!(frames("0..100000"), Ok(0..100_000));
        assert_eq!(frames("0..100001"), Err("100001 frames; one run takes at most 100000".to_owned()));
    }

    #[test]
    fn frames_and_shards_are_ranges() {
        assert_eq!(frames("2..5"), Ok(2..5));
        assert!(frames("5..5").is_err() && frames("5").is_err() && frames("a..b").is_err());
        assert_eq!(shard("1/3"), Ok(ShardSpec { index: 1, count: 3 }));
        assert!(shard("3/3").is_err() && shard("1").is_err());
        assert_eq!(levels("63.5..4095"), Ok(Levels { black_dn: 63.5, white_dn: 4095.0 }));
        assert!(["64", "5..5", "-1..5", "0..inf", "a..b"].iter().all(|text| levels(text).is_err()));
    }

    #[test]
    fn depth_of_field_is_a_word_or_a_look_with_numbers() {
        assert_eq!(depth_of_field("physical"), Ok(DepthOfField::Physical));
        assert_eq!(depth_of_field("none"), Ok(DepthOfField::None));
        let look = depth_of_field("fast:blur_px=8,far_m=10..40");
        let Ok(DepthOfField::Fast(blend)) = look else { panic!("{look:?}") };
        let p = blend.parameters();
        assert_eq!((p.blur_px, p.sharp_near_m, p.sharp_far_m, p.blurred_far_m), (8.0, 0.0, 10.0, 40.0));
        let wrong = [
            "fast",
            "fast:",
            "fast:blur_px=8",
            "fast:far_m=10..40",
            "fast:blur=8",
            "sharp",
            "fast:blur_px=8,far_m=10",
            "fast:blur_px=8,far_m=40..10",
        ];
        assert!(wrong.iter().all(|text| depth_of_field(text).is_err()));
    }
}
