//! Cityscapes (Cordts et al. 2016): `cityscapes/leftImg8bit/SPLIT/CAMERA` with images, and `cityscapes/gtFine/SPLIT/CAMERA` with `labelIds` (8 bits) and
//! `instanceIds` (16 bits).
//!
//! A camera is a city ("_" in its name becomes "-"), a sample a sequence, and the file's last number the frame. The label of a pixel follows from its class's
//! name. Sky is 23, a pixel without a ray 3 (out of roi), an object without a class or with one unknown to Cityscapes 0 (unlabeled). Objects of labels that
//! have instances are label × 1000 + their index among those of the label in the image, in the order of their identities; from the 1001st on they have only the
//! label, like a group.

use std::collections::BTreeMap;

use etendue::{Error, ErrorCode, GroundTruth, OutputFolder};
use etendue_io::png::{encode_grey8, encode_grey16};

use crate::records::{FormatWriter, Records, write};
use crate::{picture::SampleImage, record::ImageRecord, set::Set};

pub(super) struct Cityscapes {
    /// Labels by class id.
    labels: BTreeMap<u32, Label>,
}

/// Label of Cityscapes: its id, its name, and whether instances are distinguished.
#[derive(Clone, Copy)]
struct Label {
    id: u8,
    has_instances: bool,
}

const OUT_OF_ROI: u8 = 3;
const SKY: u8 = 23;

/// Names of the labels by id, from `cityscapesscripts/helpers/labels.py`.
const NAMES: [&str; 34] = [
    "unlabeled",
    "ego vehicle",
    "rectification border",
    "out of roi",
    "static",
    "dynamic",
    "ground",
    "road",
    "sidewalk",
    "parking",
    "rail track",
    "building",
    "wall",
    "fence",
    "guard rail",
    "bridge",
    "tunnel",
    "pole",
    "polegroup",
    "traffic light",
    "traffic sign",
    "vegetation",
    "terrain",
    "sky",
    "person",
    "rider",
    "car",
    "truck",
    "bus",
    "caravan",
    "trailer",
    "train",
    "motorcycle",
    "bicycle",
];
/// First label with instances; all later ones have them too.
const FIRST_WITH_INSTANCES: usize = 24;
const MAX_INSTANCES: u16 = 1000;

impl Cityscapes {
    /// # Errors
    /// If `cityscapes_labels` names a class that the scene does not have, or a label that Cityscapes does not; where two cameras would be one city.
    pub(super) fn new(set: &Set) -> Result<Self, Error> {
        let stated = set.variations.as_ref().map_or(&[][..], |variations| &variations.cityscapes_labels);
        for (_, label) in stated {
            if label_of(&label.value).is_none() {
                let problem = format!("Cityscapes has no label \"{}\"; give one of {}", label.value, NAMES.join(", "));
                return Err(Error::coded(ErrorCode::UnsupportedOutput, format!("{}: {problem}", label.place)));
            }
        }
        let mut cities: Vec<String> = set.cameras.iter().map(|camera| city(camera)).collect();
        cities.sort_unstable();
        if let Some(pair) = cities.windows(2).find(|pair| pair[0] == pair[1]) {
            let problem = "two cameras have the same city name, since \"_\" becomes \"-\"; rename one";
            return Err(Error::argument("formats", format!("`formats` cityscapes: {}: {problem}", pair[0]))
                .with_code(ErrorCode::UnsupportedOutput));
        }
        let label = |name: &str| {
            let stated = stated.iter().find(|(class, _)| class.value == name).map(|(_, label)| label.value.as_str());
            label_of(stated.unwrap_or(name))
        };
        let labels = set.classes.iter().filter_map(|(name, id)| Some((*id, label(name)?))).collect();
        Ok(Self { labels })
    }
}

fn label_of(name: &str) -> Option<Label> {
    let name = name.replace(['-', '_'], " ");
    let id = NAMES.iter().position(|known| *known == name)?;
    Some(Label { id: id as u8, has_instances: id >= FIRST_WITH_INSTANCES })
}

fn city(camera: &str) -> String {
    camera.replace('_', "-")
}

impl FormatWriter for Cityscapes {
    fn write_image(&self, set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, split) = image.sample;
        let record = &image.record;
        let city = city(&record.camera);
        let stem = format!("{}/{city}/{city}_{sample:06}_{:06}", split.name(), record.frame);
        write(folder, &format!("cityscapes/leftImg8bit/{stem}_leftImg8bit.png"), &image.bytes)?;
        let labels: Vec<u8> = self.labels(image.truth);
        let instances = self.instances(set, record, &labels, image.truth);
        let (width, height) = (record.width_px, record.height_px);
        for (kind, bytes) in [
            ("labelIds", encode_grey8(width, height, &labels)),
            ("instanceIds", encode_grey16(width, height, &instances)),
        ] {
            let name = format!("cityscapes/gtFine/{stem}_gtFine_{kind}.png");
            write(folder, &name, &bytes.map_err(|error| Error::Run(format!("{name}: {error}")))?)?;
        }
        Ok(())
    }

    fn finish(&self, _set: &Set, _records: &Records, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }
}

impl Cityscapes {
    fn labels(&self, truth: &GroundTruth) -> Vec<u8> {
        let pixels = truth.semantic.samples().iter().zip(truth.instance.samples()).zip(truth.distance.samples());
        let label = |((class, instance), distance): ((&u32, &u32), &f32)| match (*instance, *distance) {
            (0, far) if far == f32::INFINITY => SKY,
            (0, none) if none.is_nan() => OUT_OF_ROI,
            _ => self.labels.get(class).map_or(0, |label| label.id),
        };
        pixels.map(label).collect()
    }

    fn instances(&self, set: &Set, record: &ImageRecord, labels: &[u8], truth: &GroundTruth) -> Vec<u16> {
        let mut counts: BTreeMap<u8, u16> = BTreeMap::new();
        let mut numbers: BTreeMap<u32, u16> = BTreeMap::new();
        for (object, _, _) in record.visible() {
            let label = set.class_id(object.class.as_deref()).and_then(|class| self.labels.get(&class));
            let Some(label) = label.filter(|label| label.has_instances) else { continue };
            let count = counts.entry(label.id).or_default();
            if *count < MAX_INSTANCES {
                numbers.insert(object.id, u16::from(label.id) * 1000 + *count);
                *count += 1;
            }
        }
        let number = |(label, id): (&u8, &u32)| numbers.get(id).copied().unwrap_or_else(|| u16::from(*label));
        labels.iter().zip(truth.instance.samples()).map(number).collect()
    }
}
