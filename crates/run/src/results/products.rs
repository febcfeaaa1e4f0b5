//! Files of light and ground truth that a camera can deliver: names, contents, and writers.

use super::camera::CameraResults;
use super::metadata;
use super::writer::ResultWriter;
use crate::result_files::{ResultFiles, entry, entry_of};
use etendue_core::quantity::{Cover, DigitalNumber, Irradiance, MeanElectrons, Radiance, Transmittance};
use etendue_io::exr::{
    self, ExrImage, ExrLayer, LengthPlanes, SpectralBands, ground_truth_from_planes, ground_truth_image, layers_image,
    plane_image, radiance_image, spectral_image,
};
use etendue_io::failure::Error;
use etendue_io::{Provenance, png};
use etendue_pipeline::Plan;
use etendue_pipeline::plan::{CameraBody, CameraPlan, CorrespondenceFormat, Products, TimeDependence};
use etendue_pipeline::render::FrameCapture;
use etendue_pipeline::sampling::SamplingPlanes;
use etendue_pipeline::truth::{GroundTruth, TruthRows};
use etendue_pipeline::weather_layers::weather_layers;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;

/// Files that are written together: of one frame, or of all frames if light is constant.
pub(super) struct ProductFiles {
    /// Adds the requested files with their contents.
    pub(crate) entries: fn(&Products, &mut FileEntries),
    /// Stage at which they are written.
    pub(crate) stage: WriteStage,
    /// Writes the requested files.
    pub(crate) write: fn(&CameraResults, &mut ResultWriter<'_>) -> Result<(), Error>,
}

/// Stage at which files are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WriteStage {
    /// Before the frames, and whenever these are refined.
    Light,
    /// After the frames.
    GroundTruth,
}

/// Names of files with the content of each.
#[derive(Debug, Default)]
pub(super) struct FileEntries(Vec<(String, Value)>);

impl FileEntries {
    /// Adds a file if it is requested.
    pub(crate) fn add(&mut self, is_wanted: bool, name: &str, entry: Value) {
        if is_wanted {
            self.0.push((name.to_owned(), entry));
        }
    }
}

impl ProductFiles {
    /// Returns true if any of them is requested.
    pub(crate) fn is_wanted(&self, products: &Products) -> bool {
        let mut entries = FileEntries::default();
        (self.entries)(products, &mut entries);
        !entries.0.is_empty()
    }
}

/// All of them, in the order of writing.
pub(super) const PRODUCT_FILES: &[ProductFiles] = &[
    ProductFiles {
        entries: |p, files| files.add(p.radiance, ResultFiles::RADIANCE, entry_of::<Radiance>()),
        stage: WriteStage::Light,
        write: write_radiance,
    },
    ProductFiles {
        entries: |p, files| files.add(p.irradiance, ResultFiles::IRRADIANCE, entry_of::<Irradiance>()),
        stage: WriteStage::Light,
        write: |results, writer| {
            let variance = results.camera().products.variance;
            writer.irradiance(&results.file(ResultFiles::IRRADIANCE), &results.light, variance, &results.provenance())
        },
    },
    ProductFiles {
        entries: |p, files| files.add(p.ghosts, ResultFiles::GHOSTS, entry_of::<Irradiance>()),
        stage: WriteStage::Light,
        write: |results, writer| {
            writer.ghosts(&results.file(ResultFiles::GHOSTS), &results.light, &results.provenance())
        },
    },
    ProductFiles {
        entries: |p, files| {
            let entry = entry("samples; variance of the mean from Monte Carlo and from the sensor", "1, e^2, e^2");
            files.add(p.sampling, ResultFiles::SAMPLING, entry);
        },
        stage: WriteStage::Light,
        write: write_sampling,
    },
    ProductFiles {
        entries: |p, files| files.add(p.electrons, ResultFiles::ELECTRONS, entry_of::<MeanElectrons>()),
        stage: WriteStage::Light,
        write: write_electrons,
    },
    ProductFiles { entries: truth_entries, stage: WriteStage::GroundTruth, write: write_truth },
    ProductFiles {
        entries: |p, files| {
            files.add(p.weather, ResultFiles::TRANSMITTANCE, entry_of::<Transmittance>());
            files.add(p.weather, ResultFiles::AIRLIGHT, entry_of::<Radiance>());
            files.add(p.cover, ResultFiles::COVER, entry_of::<Cover>());
        },
        stage: WriteStage::GroundTruth,
        write: write_weather,
    },
    ANNOTATIONS,
];

/// Files of motion, disparity and objects.
const ANNOTATIONS: ProductFiles = ProductFiles {
    entries: annotation_entries,
    stage: WriteStage::GroundTruth,
    write: |results, writer| results.write_annotations(writer),
};

fn annotation_entries(products: &Products, files: &mut FileEntries) {
    let annotations = &products.annotations;
    let flow = entry("optical flow to the next frame", "px");
    let layers = "flow, visibility, image velocity, scene flow, velocity and time, as requested";
    files.add(annotations.needs_neighbours(), ResultFiles::MOTION, entry(layers, "px, 1, px/s, m, m/s, s"));
    files.add(annotations.optical_flow == Some(CorrespondenceFormat::Middlebury), ResultFiles::FLOW_FLO, flow.clone());
    files.add(annotations.optical_flow == Some(CorrespondenceFormat::Kitti), ResultFiles::FLOW_PNG, flow);
    let disparity = annotations.disparity.map(|product| product.format);
    files.add(disparity.is_some(), ResultFiles::DISPARITY, entry("disparity, visibility", "px, 1"));
    let map = entry("disparity; infinite where unknown", "px");
    files.add(disparity == Some(CorrespondenceFormat::Middlebury), ResultFiles::DISPARITY_PFM, map);
    let png_entry = entry("disparity; 0 where unknown", "1/256 px");
    files.add(disparity == Some(CorrespondenceFormat::Kitti), ResultFiles::DISPARITY_PNG, png_entry);
    files.add(
        annotations.boxes,
        ResultFiles::BOXES,
        entry("bounding boxes of objects in the image and in space", "px, m"),
    );
    let ranked = "objects and materials of each pixel by decreasing coverage, Cryptomatte 1.2";
    files.add(annotations.cryptomatte, ResultFiles::CRYPTOMATTE, entry(ranked, "1"));
}

impl ResultFiles {
    /// All files of a camera whose frames share one light, with their contents.
    #[must_use]
    pub fn for_products(p: &Products, body: &CameraBody, frames: &Range<u32>) -> BTreeMap<String, Value> {
        let mut files = Self::light_files(p);
        files.extend(Self::frame_files(p, body, frames));
        files
    }

    /// All files of a camera of a plan over frames, with their contents.
    #[must_use]
    pub fn for_camera(camera: &CameraPlan, frames: &Range<u32>) -> BTreeMap<String, Value> {
        let (p, body) = (&camera.products, &camera.body);
        if camera.time == TimeDependence::None {
            return Self::for_products(p, body, frames);
        }
        let mut files = Self::frame_files(p, body, frames);
        for (name, entry) in Self::light_files(p) {
            if Self::is_of_camera(&name) {
                files.insert(name, entry);
                continue;
            }
            files.extend(frames.clone().map(|frame| (Self::numbered(&name, frame), entry.clone())));
        }
        let facts = entry("times, poses and sensor of a frame", "");
        files.extend(frames.clone().map(|frame| (Self::frame(frame), facts.clone())));
        files
    }

    /// Returns true if a file belongs to the camera or to all frames, and has no frame number.
    fn is_of_camera(name: &str) -> bool {
        [Self::RAYS, Self::TRACKS].contains(&name) || name == Self::undistorted(Self::RAYS)
    }

    /// The files of light and ground truth.
    fn light_files(p: &Products) -> BTreeMap<String, Value> {
        let mut files = FileEntries::default();
        PRODUCT_FILES.iter().for_each(|product| (product.entries)(p, &mut files));
        files.add(
            p.annotations.tracks,
            Self::TRACKS,
            entry("bounding boxes of objects over all frames, by object", "px, m, s"),
        );
        files.add(p.rays, Self::RAYS, entry("origin and direction of each pixel's ray, camera frame", "m, 1"));
        let has_rectified = p.undistorted.is_some();
        let planes = entry("depth, distance, normal, position, ids of the undistorted image", "m, m, 1, m, 1");
        files.add(has_rectified && p.ground_truth, &Self::undistorted(Self::GROUND_TRUTH), planes);
        let rays = entry("origin and direction of each pixel's ray of the undistorted image, camera frame", "m, 1");
        files.add(has_rectified && p.rays, &Self::undistorted(Self::RAYS), rays);
        files.0.into_iter().collect()
    }

    fn frame_files(p: &Products, body: &CameraBody, frames: &Range<u32>) -> BTreeMap<String, Value> {
        let mut files = BTreeMap::new();
        let mut add = |is_wanted: bool, name: &str, entry: Value| {
            if is_wanted {
                files.insert(name.to_owned(), entry);
            }
        };
        let has_rectified = p.undistorted.is_some();
        let format = body.picture_format();
        let image_entry = body.development.as_ref().map_or(Value::Null, Self::picture_entry);
        let video = entry("images of all frames, Y'CbCr of BT.709 in limited range, 4:4:4", "8 bits");
        add(p.video, Self::VIDEO, video);
        let mut undistorted = image_entry.clone();
        undistorted["quantity"] =
            format!("undistorted {}", image_entry["quantity"].as_str().unwrap_or_default()).into();
        for frame in frames.clone() {
            add(has_rectified && p.picture, &Self::undistorted(&Self::picture(frame, format)), undistorted.clone());
            add(p.raw, &Self::raw(frame, p.raw_format), entry_of::<DigitalNumber>());
            add(
                p.signal_breakdown,
                &Self::signal_breakdown(frame),
                entry("components of the digital number, one layer each", "e"),
            );
            add(p.picture, &Self::picture(frame, format), image_entry.clone());
        }
        files
    }
}

fn write_radiance(results: &CameraResults, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let camera = results.camera();
    let Some(radiance) = &results.light.radiance else { return Ok(()) };
    let variance = camera.products.variance.then_some(&radiance.variance);
    let facts = metadata::radiance_provenance(results.provenance(), camera);
    let lengths = results.depth.as_ref().map(|d| LengthPlanes { distance: &d.distance, depth: &d.depth });
    let bands = SpectralBands::from_stored(&radiance.mean, variance);
    writer.exr(&results.file(ResultFiles::RADIANCE), radiance_image(bands, lengths, &facts))
}

fn write_electrons(results: &CameraResults, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let light = &results.light;
    let Some(mean) = &light.electrons else { return Ok(()) };
    let variance = light.electrons_variance.as_ref().filter(|_| results.camera().products.variance);
    writer.exr(&results.file(ResultFiles::ELECTRONS), plane_image(mean, variance, &results.provenance()))
}

fn write_sampling(results: &CameraResults, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let Some(sampling) = &results.sampling else { return Ok(()) };
    writer.exr(&results.file(ResultFiles::SAMPLING), sampling_image(sampling, &results.provenance()))
}

fn sampling_image<'a>(sampling: &'a SamplingPlanes, facts: &Provenance) -> ExrImage<'a> {
    let SamplingPlanes { samples, monte_carlo, sensor } = sampling;
    let variances = [("monte_carlo_variance", monte_carlo), ("sensor_variance", sensor)];
    let variances =
        variances.into_iter().filter_map(|(name, plane)| Some((name, ExrLayer::Float(plane.as_ref()?.samples()))));
    let layers: Vec<_> = [("samples", ExrLayer::Uint(samples.samples()))].into_iter().chain(variances).collect();
    let layers: Vec<_> = layers.into_iter().map(|(name, layer)| (name.to_owned(), layer)).collect();
    layers_image(samples.width(), samples.height(), &layers, facts)
}

fn truth_entries(p: &Products, files: &mut FileEntries) {
    files.add(
        p.ground_truth,
        ResultFiles::GROUND_TRUTH,
        entry("depth, distance, normal, position, ids", "m, m, 1, m, 1"),
    );
    if let Some(per_m) = p.depth_png_per_m {
        files.add(true, ResultFiles::DEPTH, entry("planar depth; 0: invalid", &format!("1/{per_m} m")));
    }
}

fn write_truth(results: &CameraResults, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let products = &results.camera().products;
    if is_large(&results.plan, results.camera()) {
        return write_large_truth(results, writer);
    }
    let truth = results.ground_truth();
    if products.ground_truth {
        let name = results.file(ResultFiles::GROUND_TRUTH);
        let image = ground_truth_from_planes(&planes(&truth), &results.provenance());
        writer.exr(&name, image.map_err(|error| Error::Run(format!("{name}: {error}")))?)?;
    }
    match products.depth_png_per_m {
        Some(per_metre) => {
            writer.write(&results.file(ResultFiles::DEPTH), png::encode_depth16(&truth.depth, per_metre))
        }
        None => Ok(()),
    }
}

/// Does the same for planes that exceed the memory limit of films: computed during writing, some rows at a time.
fn write_large_truth(results: &CameraResults, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let camera = results.camera();
    let rows = TruthRows::new(&results.plan, camera, results.frame_numbers().start, results.simd);
    if camera.products.ground_truth {
        writer.exr(&results.file(ResultFiles::GROUND_TRUTH), truth_image(&rows, &results.provenance()))?;
    }
    match camera.products.depth_png_per_m {
        Some(per_metre) => {
            writer.write(&results.file(ResultFiles::DEPTH), png::encode_depth16(&rows.depth(), per_metre))
        }
        None => Ok(()),
    }
}

/// Effect of weather on each pixel, computed again with the samples of the light.
fn write_weather(results: &CameraResults, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
    let camera = results.camera();
    let frame_capture = FrameCapture { frame: results.frame_numbers().start, capture: 0 };
    let layers = weather_layers(&results.plan, camera, frame_capture, results.simd);
    let facts = metadata::radiance_provenance(results.provenance(), camera);
    writer.exr(&results.file(ResultFiles::TRANSMITTANCE), plane_image(&layers.transmittance, None, &facts))?;
    let airlight = SpectralBands::from_cubes(&layers.airlight, None);
    writer.exr(&results.file(ResultFiles::AIRLIGHT), spectral_image::<Radiance>(airlight, &facts))?;
    layers
        .cover
        .iter()
        .try_for_each(|cover| writer.exr(&results.file(ResultFiles::COVER), plane_image(cover, None, &facts)))
}

/// Returns true if an image is so large that its ground truth, about as large as all other results together, would exceed the memory limit of film bands.
pub(super) fn is_large(plan: &Plan, camera: &CameraPlan) -> bool {
    plan.film_limit.as_ref().is_some_and(|limit| TruthRows::bytes(camera) > limit.bytes as f64)
}

/// Rows of ground truth for a file.
struct RowsOfFile<'a>(&'a TruthRows<'a>);

impl exr::GroundTruthRows for RowsOfFile<'_> {
    fn rows(&self, rows: Range<usize>, take: &mut dyn FnMut(&exr::GroundTruth<'_>)) {
        take(&planes(&self.0.rows(rows)));
    }
}

pub(super) fn truth_image<'a>(rows: &'a TruthRows<'a>, facts: &Provenance) -> ExrImage<'a> {
    ground_truth_image(rows.size().0, rows.size().1, rows.has_gaps(), RowsOfFile(rows), facts)
}

pub(super) fn planes(truth: &GroundTruth) -> exr::GroundTruth<'_> {
    exr::GroundTruth {
        depth: Some(&truth.depth),
        distance: Some(&truth.distance),
        normal: Some(&truth.normal),
        position: Some(&truth.position),
        position_low: truth.position_low.as_ref(),
        camera_space_position: truth.camera_space_position.as_ref(),
        instance: Some(&truth.instance),
        semantic: Some(&truth.semantic),
        material: Some(&truth.material),
        ray: Some(&truth.ray),
        mirror: truth.mirror.as_ref(),
    }
}
