//! BOP (Hodaň et al. 2018): poses of objects, depth and masks, `bop/SPLIT/SCENE`.
//!
//! A scene is one camera of one sample, with the number sample × cameras + index of the camera in the job; its images are numbered by frames. Objects are those
//! of the ground truth that have a class, with their identities as `obj_id`.
//!
//! - A model's frame is that of the object (x forward, y left, z up, whatever axes its file has), its origin at the centre of the object's box; lengths are in
//!   mm. `models/models_info.json` holds that box; its `diameter` is the box's diagonal, an upper bound of the largest distance of two points of the mesh. The
//!   models themselves are not written.
//! - `depth` is the distance along the axis, 0 if there is none or it exceeds 65 535 units of `bop_depth_unit_mm` (`depth_scale`).
//! - `mask` holds the pixels of the object without occlusion, `mask_visib` its visible pixels, 255; files are numbered by the index in `scene_gt.json`.
//! - `px_count_all` and `visib_fract` count the pixels within the image. BOP's own tools also count those outside it: an unoccluded object cut by the image
//!   border has the fraction 1 here.
//! - `cam_K` has pixel centres at whole numbers, as OpenCV does.

use std::{cell::RefCell, collections::BTreeMap};

use etendue::{Error, ErrorCode, OutputFolder};
use etendue_core::{Plane, quantity::Length};
use etendue_io::png::{encode_depth16, encode_grey8, stored_depth};
use glam::{DMat3, DQuat, DVec3};
use serde_json::{Map, Value, json};

use crate::record::{ImageRecord, ObjectRecord, SampleRecord};
use crate::records::{FormatWriter, Records, write};
use crate::{draw::Split, picture::SampleImage, set::Set};

pub(super) struct Bop {
    depth_unit_mm: f64,
    /// `scene_gt_info` of the current sample, by camera and frame.
    counted: RefCell<BTreeMap<(String, u32), Vec<Value>>>,
    /// Models of the complete samples and of those rendered since; `None` before the first of a run.
    models: RefCell<Option<ObjectModels>>,
}

/// Names and sizes of objects, mm, by identity.
#[derive(Default)]
struct ObjectModels(BTreeMap<u32, (String, DVec3)>);

impl ObjectModels {
    /// Models of all records except one, whose sample is rendered again.
    fn new(records: &Records, without: Option<u32>) -> Result<Self, Error> {
        let mut models = Self::default();
        for record in records.each() {
            let record = record.map_err(Error::run)?;
            if Some(record.sample) != without {
                models.add(&record)?;
            }
        }
        Ok(models)
    }

    /// Adds the objects of a record; a model of BOP has a fixed size.
    fn add(&mut self, record: &SampleRecord) -> Result<(), Error> {
        for object in record.pictures.iter().flat_map(objects) {
            let size_mm = 1000.0 * DVec3::from_array(object.box_3d.size_m);
            let (name, known_mm) = self.0.entry(object.id).or_insert_with(|| (object.name.clone(), size_mm));
            if *name != object.name || (*known_mm - size_mm).abs().max_element() > 1e-6 * size_mm.max_element() {
                return Err(another_model(record, object, name));
            }
        }
        Ok(())
    }
}

impl Bop {
    pub(super) fn new(set: &Set) -> Self {
        let unit = set.variations.as_ref().and_then(|variations| variations.bop_depth_unit_mm.as_ref());
        Self {
            depth_unit_mm: unit.map_or(1.0, |unit| unit.value),
            counted: RefCell::default(),
            models: RefCell::default(),
        }
    }

    fn units_per_m(&self) -> f64 {
        1000.0 / self.depth_unit_mm
    }
}

fn scene(set: &Set, sample: u32, split: Split, camera: &str) -> String {
    let place = set.cameras.iter().position(|known| known == camera).expect("a camera of the job");
    format!("bop/{}/{:06}", split.name(), sample as usize * set.cameras.len() + place)
}

/// Objects of an image that BOP includes.
fn objects(image: &ImageRecord) -> impl Iterator<Item = &ObjectRecord> {
    image.objects.iter().filter(|object| object.class.is_some())
}

impl FormatWriter for Bop {
    fn write_image(&self, set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (record, truth) = (&image.record, image.truth);
        let (scene, number) = (scene(set, image.sample.0, image.sample.1, &record.camera), record.frame);
        write(folder, &format!("{scene}/rgb/{number:06}.{}", record.extension), &image.bytes)?;
        let mut encoded = |name: String, bytes: Result<Vec<u8>, _>| {
            let bytes = bytes.map_err(|error: etendue_io::exr::EncodeError| Error::Run(format!("{name}: {error}")))?;
            write(folder, &name, &bytes)
        };
        encoded(format!("{scene}/depth/{number:06}.png"), encode_depth16(&truth.depth, self.units_per_m()))?;
        let silhouettes = image.silhouettes();
        let (mut counted, ids) = (Vec::new(), truth.instance.samples());
        for (place, object) in objects(record).enumerate() {
            let silhouette = silhouettes.get(&object.id).map_or(&[][..], Vec::as_slice);
            let visible: Vec<usize> = silhouette.iter().copied().filter(|at| ids[*at] == object.id).collect();
            for (kind, pixels) in [("mask", silhouette), ("mask_visib", &visible)] {
                let mut mask = vec![0; ids.len()];
                pixels.iter().for_each(|at| mask[*at] = 255);
                let bytes = encode_grey8(record.width_px, record.height_px, &mask);
                encoded(format!("{scene}/{kind}/{number:06}_{place:06}.png"), bytes)?;
            }
            counted.push(self.info(object, silhouette, visible.len(), &truth.depth));
        }
        self.counted.borrow_mut().insert((record.camera.clone(), number), counted);
        Ok(())
    }

    fn sample(&self, set: &Set, record: &SampleRecord, folder: &mut OutputFolder) -> Result<(), Error> {
        let counted = self.counted.take();
        // Checked before the sample has a record, so that one with another size never counts as complete.
        let mut models = self.models.borrow_mut();
        if models.is_none() {
            let records = Records::in_folder(folder.path())?;
            *models = Some(ObjectModels::new(&records, Some(record.sample))?);
        }
        models.get_or_insert_default().add(record)?;
        for camera in &set.cameras {
            let scene = scene(set, record.sample, record.split, camera);
            let images = || record.pictures.iter().filter(|image| image.camera == *camera);
            let by_number = |entry: &dyn Fn(&ImageRecord) -> Value| -> Value {
                images().map(|image| (image.frame.to_string(), entry(image))).collect::<Map<_, _>>().into()
            };
            let poses = |image: &ImageRecord| objects(image).map(pose).collect::<Vec<_>>().into();
            let counts = |image: &ImageRecord| {
                counted.get(&(image.camera.clone(), image.frame)).cloned().unwrap_or_default().into()
            };
            for (name, facts) in [
                ("scene_camera", by_number(&|image| self.camera(image))),
                ("scene_gt", by_number(&poses)),
                ("scene_gt_info", by_number(&counts)),
            ] {
                write(folder, &format!("{scene}/{name}.json"), format!("{facts}\n").as_bytes())?;
            }
        }
        Ok(())
    }

    fn finish(&self, _set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        let ObjectModels(models) = ObjectModels::new(records, None)?;
        let facts: Map<String, Value> = models.iter().map(|(id, (_, size))| (id.to_string(), model(*size))).collect();
        write(folder, "bop/models/models_info.json", format!("{}\n", Value::Object(facts)).as_bytes())?;
        let names: Map<String, Value> =
            models.into_iter().map(|(id, (name, _))| (id.to_string(), name.into())).collect();
        write(folder, "bop/models/names.json", format!("{}\n", Value::Object(names)).as_bytes())
    }
}

fn another_model(record: &SampleRecord, object: &ObjectRecord, known: &str) -> Error {
    Error::argument(
        "formats",
        format!(
            "`formats` bop: object {} is \"{known}\" in one sample and \"{}\" of another size or name in sample {}, but a BOP model has one size; \
             vary poses, not scales or objects, or make the data set in another folder without the format",
            object.id, object.name, record.sample
        ),
    ).with_code(ErrorCode::UnsupportedOutput)
}

impl Bop {
    fn camera(&self, image: &ImageRecord) -> Value {
        let [fx, skew, cx, fy, cy] = image.camera_matrix_px.expect("checked for all cameras of the format");
        let [w, x, y, z] = image.pose.rotation_wxyz;
        let from_world = DMat3::from_quat(DQuat::from_xyzw(x, y, z, w)).transpose();
        let place_mm = from_world * (-1000.0 * DVec3::from_array(image.pose.position_m));
        json!({
            "cam_K": [fx, skew, cx - 0.5, 0.0, fy, cy - 0.5, 0.0, 0.0, 1.0],
            "depth_scale": self.depth_unit_mm,
            "cam_R_w2c": rows(from_world),
            "cam_t_w2c": place_mm.to_array(),
        })
    }

    fn info(&self, object: &ObjectRecord, silhouette: &[usize], visible_count: usize, depth: &Plane<Length>) -> Value {
        let is_valid = |at: &&usize| stored_depth(depth.samples()[**at], self.units_per_m()) > 0;
        let corners = |bounds: Option<[f64; 4]>| match bounds {
            Some([left, top, right, bottom]) => {
                let (left, top) = (left.floor(), top.floor());
                [left, top, right.ceil() - left, bottom.ceil() - top].map(|x| x as i64)
            }
            None => [-1; 4],
        };
        json!({
            "bbox_obj": corners(object.amodal_box_px),
            "bbox_visib": corners(object.visible_box_px),
            "px_count_all": silhouette.len(),
            "px_count_valid": silhouette.iter().filter(is_valid).count(),
            "px_count_visib": visible_count,
            "visib_fract": if silhouette.is_empty() { 0.0 } else { visible_count as f64 / silhouette.len() as f64 },
        })
    }
}

fn pose(object: &ObjectRecord) -> Value {
    let [w, x, y, z] = object.box_3d.camera.rotation_wxyz;
    let rotation = DMat3::from_quat(DQuat::from_xyzw(x, y, z, w));
    let place_mm = object.box_3d.camera.centre_m.map(|m| 1000.0 * m);
    json!({ "cam_R_m2c": rows(rotation), "cam_t_m2c": place_mm, "obj_id": object.id })
}

fn rows(matrix: DMat3) -> [f64; 9] {
    matrix.transpose().to_cols_array()
}

fn model(size_mm: DVec3) -> Value {
    let [x, y, z] = size_mm.to_array();
    json!({
        "diameter": size_mm.length(),
        "min_x": -x / 2.0, "min_y": -y / 2.0, "min_z": -z / 2.0,
        "size_x": x, "size_y": y, "size_z": z,
    })
}
