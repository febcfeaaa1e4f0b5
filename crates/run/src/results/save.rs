//! Files of a camera's results.

use super::camera::CameraResults;
use super::frames::{FrameProducts, write_frames};
use super::metadata;
use super::products::{PRODUCT_FILES, WriteStage, is_large, planes, truth_image};
use super::writer::ResultWriter;
use crate::result_files::ResultFiles;
use etendue_core::observer::Observer;
use etendue_io::OutputFolder;
use etendue_io::exr::encode_ground_truth;
use etendue_io::failure::Error;
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_pipeline::truth::{TruthRows, ground_truth};
use serde_json::Value;

impl CameraResults {
    /// Writes all files except the camera's side-car; returns the side-car's facts of each frame.
    pub(super) fn write_files(&self, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<Vec<Value>, Error> {
        let mut writer = ResultWriter { prefix: self.camera().name.clone(), folder };
        self.write_products(WriteStage::Light, &mut writer)?;
        let points = self.write_photographs(&mut writer, observer)?;
        self.write_products(WriteStage::GroundTruth, &mut writer)?;
        if let Some(rectified) = &self.undistorted {
            self.write_undistorted(rectified, &mut writer)?;
        }
        Ok(points)
    }

    /// Writes the files of light and frames.
    pub(crate) fn write_light(&self, folder: &mut OutputFolder, observer: &dyn Observer) -> Result<(), Error> {
        let mut writer = ResultWriter { prefix: self.camera().name.clone(), folder };
        self.write_products(WriteStage::Light, &mut writer)?;
        self.write_photographs(&mut writer, observer).map(|_| ())
    }

    /// Name of a file of light or ground truth.
    pub(super) fn file(&self, name: &str) -> String {
        if self.has_own_light() { ResultFiles::numbered(name, self.frame_numbers().start) } else { name.to_owned() }
    }

    /// Facts of the files of light and ground truth.
    pub(super) fn provenance(&self) -> etendue_io::Provenance {
        metadata::provenance(&self.plan, self.camera(), self.frame_numbers().start)
    }

    fn write_products(&self, stage: WriteStage, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let products = &self.camera().products;
        let products_of_stage =
            PRODUCT_FILES.iter().filter(|product| product.stage == stage && product.is_wanted(products));
        products_of_stage.map(|product| product.write).try_for_each(|write| write(self, writer))
    }

    /// Writes the frames; returns the side-car's facts of each.
    fn write_photographs(&self, writer: &mut ResultWriter<'_>, observer: &dyn Observer) -> Result<Vec<Value>, Error> {
        let camera = self.camera();
        let facts = self.provenance();
        let (products, undistorted) = (&camera.products, self.undistorted.as_ref());
        let frame_products = FrameProducts {
            products,
            camera: &camera.name,
            facts: &facts,
            undistorted,
            one_by_one: is_large(&self.plan, camera),
            observer,
        };
        write_frames(&camera.body, self.numbered_frames(), |frame| self.address(frame), frame_products, writer)
    }

    /// Writes the ground truth of the rectified camera.
    fn write_undistorted(&self, rectified: &RectifiedCamera, writer: &mut ResultWriter<'_>) -> Result<(), Error> {
        let camera = self.camera();
        if !camera.products.ground_truth {
            return Ok(());
        }
        let facts = metadata::undistorted_provenance(self.provenance(), rectified);
        let name = ResultFiles::undistorted(&self.file(ResultFiles::GROUND_TRUTH));
        let rectified = rectified.plan(camera);
        if is_large(&self.plan, &rectified) {
            let rows = TruthRows::new(&self.plan, &rectified, self.frame_numbers().start, self.simd);
            return writer.exr(&name, truth_image(&rows, &facts));
        }
        let truth = ground_truth(&self.plan, &rectified, self.frame_numbers().start, self.simd);
        writer.write(&name, encode_ground_truth(&planes(&truth), &facts))
    }
}
