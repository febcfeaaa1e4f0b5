//! The command line, as typed.

pub mod chart;
mod depth_of_field;
pub mod file_name;
pub mod measure;
mod run;
pub mod sensor;
pub mod trade;
pub mod words;

use clap::{Args, Parser, Subcommand, ValueEnum};
use depth_of_field::depth_of_field;
use etendue::{DevelopRequest, Existing, ExposeRequest, JobRequest, Levels, ShardSpec};
use etendue_optics::DepthOfField;
use run::{frames, levels, seed, shard, whole};
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
    /// How much of the light's ways every camera follows, as render.integrator says it [default: the job's, or path]
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
    /// Change a key of the camera file, e.g. --set isp.demosaic=malvar
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
    Lens(measure::lens::LensArgs),
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

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_well_formed() {
        Arguments::command().debug_assert();
    }
}
