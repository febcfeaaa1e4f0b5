//! A camera's results as files.

use super::camera::CameraResults;
use super::frames::{Wanted, write_frames};
use super::metadata;
use super::writer::ResultWriter;
use crate::result_files::Files;
use etendue_core::observer::Observer;
use etendue_core::quantity::Radiance;
use etendue_io::exr::{
    self, Layer, Lengths, SpectralBands, encode_ground_truth, ground_truth_image, ground_truth_of_planes, layers_image,
    plane_image, radiance_image, spectral_image,
};
use etendue_io::failure::Error;
use etendue_io::{OutputFolder, png};
use etendue_pipeline::Plan;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_pipeline::render::Shot;
use etendue_pipeline::sampling::SamplingPlanes;
use etendue_pipeline::truth::{GroundTruth, TruthRows, ground_truth};
use etendue_pipeline::weather_layers::weather_layers;
use serde_json::Value;
use std::ops::Range;

impl CameraResults {
    /// Writes all files but the camera's side-car; answers with what that says of each frame.
    pub(super) fn write_files(&self, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<Vec<Value>, Error> {
        let mut writer = ResultWriter { prefix: self.camera().name.clone(), folder };
        self.write_spectra(&mut writer)?;
        let points = self.write_photographs(&mut writer, observer)?;
        self.write_truth(&mut writer)?;
        self.write_weather(&mut writer)?;
        self.write_annotations(&mut writer)?;
        if let Some(twin) = &self.undistorted {
            self.write_undistorted(twin, &mut writer)?;
        }
        Ok(points)
    }

    /// Writes the files of light and photographs.
    pub(crate) fn write_light(&self, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<(), Error> {
        let mut writer = ResultWriter { prefix: self.camera().name.clone(), folder };
        self.write_spectra(&mut writer)?;
        self.write_photographs(&mut writer, observer).map(|_| ())
    }

    /// The name of a file of light or ground truth.
    pub(super) fn file(&self, name: &str) -> String {
        if self.has_own_light() { Files::numbered(name, self.frame_numbers().start) } else { name.to_owned() }
    }

    /// The facts of the files of light and ground truth.
    pub(super) fn provenance(&self) -> etendue_io::Provenance {
        metadata::provenance(&self.plan, self.camera(), self.frame_numbers().start)
    }

    fn write_spectra(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let (camera, light) = (self.camera(), &self.light);
        let products = &camera.products;
        if let Some(radiance) = light.radiance.as_ref().filter(|_| products.radiance) {
            let variance = products.variance.then_some(&radiance.variance);
            let facts = metadata::radiance_provenance(self.provenance(), camera);
            let lengths = self.depth.as_ref().map(|d| Lengths { distance: &d.distance, depth: &d.depth });
            let bands = SpectralBands::of_kept(&radiance.mean, variance);
            writer.exr(&self.file(Files::RADIANCE), radiance_image(bands, lengths, &facts))?;
        }
        if products.irradiance {
            writer.irradiance(&self.file(Files::IRRADIANCE), light, products.variance, &self.provenance())?;
        }
        if products.ghosts {
            writer.ghosts(&self.file(Files::GHOSTS), light, &self.provenance())?;
        }
        if let Some(sampling) = &self.sampling {
            writer.exr(&self.file(Files::SAMPLING), sampling_image(sampling, &self.provenance()))?;
        }
        if let Some(mean) = light.electrons.as_ref().filter(|_| products.electrons) {
            let variance = light.electrons_variance.as_ref().filter(|_| products.variance);
            writer.exr(&self.file(Files::ELECTRONS), plane_image(mean, variance, &self.provenance()))?;
        }
        Ok(())
    }

    /// The frames; answers with what the side-car says of each.
    fn write_photographs(&self, writer: &mut ResultWriter<'_>, observer: &dyn Observer) -> Result<Vec<Value>, Error> {
        let camera = self.camera();
        let facts = self.provenance();
        let (products, undistorted) = (&camera.products, self.undistorted.as_ref());
        let wanted = Wanted {
            products,
            camera: &camera.name,
            facts: &facts,
            undistorted,
            one_by_one: is_large(&self.plan, camera),
            observer,
        };
        write_frames(&camera.body, self.numbered_frames(), |frame| self.address(frame), wanted, writer)
    }

    fn write_truth(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let products = &self.camera().products;
        if !products.ground_truth && products.depth_png_per_m.is_none() {
            return Ok(());
        }
        if is_large(&self.plan, self.camera()) {
            return self.write_large_truth(writer);
        }
        let truth = self.ground_truth();
        if products.ground_truth {
            self.write_truth_planes(&truth, writer)?;
        }
        match products.depth_png_per_m {
            Some(per_metre) => writer.write(&self.file(Files::DEPTH), png::encode_depth16(&truth.depth, per_metre)),
            None => Ok(()),
        }
    }

    fn write_truth_planes(&self, truth: &GroundTruth, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let name = self.file(Files::GROUND_TRUTH);
        let image = ground_truth_of_planes(&planes(truth), &self.provenance());
        writer.exr(&name, image.map_err(|error| Error::Run(format!("{name}: {error}")))?)
    }

    /// The same of planes that are larger than films may be in memory: found when they are written, some rows at a time.
    fn write_large_truth(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let camera = self.camera();
        let rows = TruthRows::new(&self.plan, camera, self.frame_numbers().start, self.simd);
        if camera.products.ground_truth {
            writer.exr(&self.file(Files::GROUND_TRUTH), truth_image(&rows, &self.provenance()))?;
        }
        match camera.products.depth_png_per_m {
            Some(per_metre) => writer.write(&self.file(Files::DEPTH), png::encode_depth16(&rows.depth(), per_metre)),
            None => Ok(()),
        }
    }

    /// What weather does to each pixel: found anew, with the samples of the light.
    fn write_weather(&self, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let camera = self.camera();
        if !camera.products.weather {
            return Ok(());
        }
        let shot = Shot { frame: self.frame_numbers().start, capture: 0 };
        let layers = weather_layers(&self.plan, camera, shot, self.simd);
        let facts = metadata::radiance_provenance(self.provenance(), camera);
        writer.exr(&self.file(Files::TRANSMITTANCE), plane_image(&layers.transmittance, None, &facts))?;
        let airlight = SpectralBands::of(&layers.airlight, None);
        writer.exr(&self.file(Files::AIRLIGHT), spectral_image::<Radiance>(airlight, &facts))?;
        layers.cover.iter().try_for_each(|cover| writer.exr(&self.file(Files::COVER), plane_image(cover, None, &facts)))
    }

    /// Ground truth of the undistorted twin.
    fn write_undistorted(&self, twin: &RectifiedCamera, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let camera = self.camera();
        if !camera.products.ground_truth {
            return Ok(());
        }
        let facts = metadata::undistorted_provenance(self.provenance(), twin);
        let name = Files::undistorted(&self.file(Files::GROUND_TRUTH));
        let twin = twin.plan(camera);
        if is_large(&self.plan, &twin) {
            let rows = TruthRows::new(&self.plan, &twin, self.frame_numbers().start, self.simd);
            return writer.exr(&name, truth_image(&rows, &facts));
        }
        let truth = ground_truth(&self.plan, &twin, self.frame_numbers().start, self.simd);
        writer.write(&name, encode_ground_truth(&planes(&truth), &facts))
    }
}

/// Whether a picture is so large that its ground truth, about as much as all else that is made of it, would take more memory than the bands of a film may.
fn is_large(plan: &Plan, camera: &CameraPlan) -> bool {
    plan.film_limit.as_ref().is_some_and(|limit| TruthRows::bytes(camera) > limit.bytes as f64)
}

/// Rows of ground truth for a file.
struct RowsOfFile<'a>(&'a TruthRows<'a>);

impl exr::GroundTruthRows for RowsOfFile<'_> {
    fn rows(&self, rows: Range<usize>, take: &mut dyn FnMut(&exr::GroundTruth<'_>)) {
        take(&planes(&self.0.rows(rows)));
    }
}

fn truth_image<'a>(rows: &'a TruthRows<'a>, facts: &etendue_io::Provenance) -> exr::ExrImage<'a> {
    ground_truth_image(rows.size().0, rows.size().1, rows.has_gaps(), RowsOfFile(rows), facts)
}

fn sampling_image<'a>(sampling: &'a SamplingPlanes, facts: &etendue_io::Provenance) -> exr::ExrImage<'a> {
    let SamplingPlanes { samples, monte_carlo, sensor } = sampling;
    let variances = [("monte_carlo_variance", monte_carlo), ("sensor_variance", sensor)];
    let variances =
        variances.into_iter().filter_map(|(name, plane)| Some((name, Layer::Float(plane.as_ref()?.samples()))));
    let layers: Vec<_> = [("samples", Layer::Uint(samples.samples()))].into_iter().chain(variances).collect();
    let layers: Vec<_> = layers.into_iter().map(|(name, layer)| (name.to_owned(), layer)).collect();
    layers_image(samples.width(), samples.height(), &layers, facts)
}

fn planes(truth: &GroundTruth) -> exr::GroundTruth<'_> {
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
