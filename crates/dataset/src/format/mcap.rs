//! MCAP (Foxglove, the format's specification): `mcap/SPLIT/NNNNNN.mcap`, messages of ROS 2, one file per sample.
//!
//! | topic | message | of each frame |
//! | --- | --- | --- |
//! | `/CAMERA/image/compressed` | `sensor_msgs/msg/CompressedImage` | the encoded image |
//! | `/CAMERA/depth` | `sensor_msgs/msg/Image`, 32FC1 | depth along the axis, m; +∞ and NaN as in REP 118 |
//! | `/CAMERA/points` | `sensor_msgs/msg/PointCloud2` | the same as points in the camera's frame (x right, y down, z forward), m, with the image's colours; 16 bytes per pixel; NaN where there is no surface |
//! | `/CAMERA/camera_info` | `sensor_msgs/msg/CameraInfo` | camera matrix and distortion, as in calibration files of rigs; pixel centres at whole numbers |
//! | `/tf` | `tf2_msgs/msg/TFMessage` | `world` to the camera, whose frame has its name (x right, y down, z forward) |
//!
//! Times are simulated times at the middle of the exposure, from 0 on (as with `use_sim_time`); earlier ones are 0. Messages are in order of time, uncompressed
//! and without chunks; the summary holds schemas, channels and statistics.

use std::{cell::RefCell, collections::BTreeMap};

use etendue::{Error, ErrorCode, OutputFolder, RosView, ros_view};
use etendue_io::calibration::export::ros::CameraInfo;
use glam::DVec2;

use super::ros;
use crate::records::{FormatWriter, Records, write};
use crate::set::{Set, topic_name};
use crate::{picture::SampleImage, record::SampleRecord};

const MAGIC: &[u8] = b"\x89MCAP0\r\n";
/// Last second of a ROS time stamp, which has 32 bits: 19 January 2038, counted from 1970.
const LAST_S: i64 = i32::MAX as i64;

/// A message of a topic.
struct McapMessage {
    time_ns: u64,
    topic: String,
    schema: &'static str,
    data: Vec<u8>,
}

/// Messages of the current sample.
#[derive(Default)]
pub(super) struct Mcap(RefCell<Vec<McapMessage>>);

impl FormatWriter for Mcap {
    fn write_image(&self, _set: &Set, picture: &SampleImage<'_>, _folder: &mut OutputFolder) -> Result<(), Error> {
        let record = &picture.record;
        let time = record.exact_time();
        let time_ns = u64::try_from(time.nanoseconds()).ok().filter(|_| time.whole_s() <= LAST_S);
        let Some(time_ns) = time_ns else {
            let problem = format!("an image of camera {} has the time {time} s", record.camera);
            return Err(Error::coded(
                ErrorCode::UnsupportedOutput,
                format!("{problem}; MCAP with ROS messages stores times from 0 to {LAST_S} s"),
            ));
        };
        let at = ros::MessageHeader { time_ns, frame: record.camera.as_str() };
        let camera = RosCamera::new(picture)?;
        let topic = |name: &str| format!("/{}/{name}", topic_name(&record.camera));
        let messages = [
            (
                topic("image/compressed"),
                ros::COMPRESSED_IMAGE,
                ros::compressed_image(at, &record.extension, &picture.bytes),
            ),
            (topic("depth"), ros::IMAGE, ros::depth_image(at, &picture.truth.depth)),
            (topic("points"), ros::POINT_CLOUD, camera.points(at, picture)),
            (topic("camera_info"), ros::CAMERA_INFO, ros::camera_info(at, &camera.info())),
            ("/tf".to_owned(), ros::TF_MESSAGE, ros::transform(at, &record.pose)),
        ];
        let message = |(topic, schema, data)| McapMessage { time_ns, topic, schema, data };
        self.0.borrow_mut().extend(messages.map(message));
        Ok(())
    }

    fn sample(&self, _set: &Set, record: &SampleRecord, folder: &mut OutputFolder) -> Result<(), Error> {
        let mut messages = self.0.take();
        // Messages of the same time stay in the order of cameras.
        messages.sort_by_key(|message| message.time_ns);
        write(folder, &format!("mcap/{}/{:06}.mcap", record.split.name(), record.sample), &file(&messages))
    }

    fn finish(&self, _set: &Set, _records: &Records, _folder: &mut OutputFolder) -> Result<(), Error> {
        Ok(())
    }
}

/// Camera of an image.
enum RosCamera {
    /// Camera matrix of rectilinear images: fx, skew, cx, fy, cy in raster coordinates.
    Rectilinear {
        matrix_px: [f64; 5],
        size_px: [usize; 2],
    },
    Distorted(Box<RosView>),
}

impl RosCamera {
    fn new(image: &SampleImage<'_>) -> Result<Self, Error> {
        let record = &image.record;
        match record.camera_matrix_px {
            Some(matrix_px) => Ok(Self::Rectilinear { matrix_px, size_px: [record.width_px, record.height_px] }),
            None => ros_view(image.camera())
                .map(|view| Self::Distorted(Box::new(view)))
                .map_err(|why| Error::coded(ErrorCode::UnsupportedOutput, format!("camera {}: {why}", record.camera))),
        }
    }

    fn info(&self) -> CameraInfo {
        match self {
            Self::Rectilinear { matrix_px: [fx, skew, cx, fy, cy], size_px } => {
                // ROS has pixel centres at whole numbers.
                let rows = [[*fx, *skew, cx - 0.5], [0.0, *fy, cy - 0.5], [0.0, 0.0, 1.0]];
                CameraInfo {
                    size_px: *size_px,
                    distortion_model: "plumb_bob",
                    coefficients: vec![0.0; 5],
                    matrix: rows,
                    projection: rows.map(|[a, b, c]| [a, b, c, 0.0]),
                }
            }
            Self::Distorted(view) => view.info.clone(),
        }
    }

    fn points(&self, at: ros::MessageHeader<'_>, image: &SampleImage<'_>) -> Vec<u8> {
        let (depth, colours) = (&image.truth.depth, image.display);
        match self {
            Self::Rectilinear { matrix_px: [fx, skew, cx, fy, cy], .. } => ros::point_cloud(at, depth, colours, |px| {
                let y = (px.y - cy) / fy;
                Some(DVec2::new((px.x - cx - skew * y) / fx, y))
            }),
            Self::Distorted(view) => ros::point_cloud(at, depth, colours, |px| view.tangents(px)),
        }
    }
}

/// Opcodes of the written records.
mod opcode {
    pub(super) const HEADER: u8 = 0x01;
    pub(super) const FOOTER: u8 = 0x02;
    pub(super) const SCHEMA: u8 = 0x03;
    pub(super) const CHANNEL: u8 = 0x04;
    pub(super) const MESSAGE: u8 = 0x05;
    pub(super) const STATISTICS: u8 = 0x0b;
    pub(super) const DATA_END: u8 = 0x0f;
}

/// Bytes of a file of messages.
fn file(messages: &[McapMessage]) -> Vec<u8> {
    let mut schemas: BTreeMap<&str, u16> = BTreeMap::new();
    let mut channels: BTreeMap<&str, (u16, u16)> = BTreeMap::new();
    let mut described = Vec::new();
    for message in messages {
        let next = schemas.len() as u16 + 1;
        let schema = *schemas.entry(message.schema).or_insert_with(|| {
            record(&mut described, opcode::SCHEMA, &schema_record(next, message.schema));
            next
        });
        let next = channels.len() as u16 + 1;
        channels.entry(&message.topic).or_insert_with(|| {
            record(&mut described, opcode::CHANNEL, &channel_record(next, schema, &message.topic));
            (next, schema)
        });
    }
    let mut bytes = MAGIC.to_vec();
    record(&mut bytes, opcode::HEADER, &[text("ros2"), text(concat!("etendue ", env!("CARGO_PKG_VERSION")))].concat());
    bytes.extend_from_slice(&described);
    let mut counts: BTreeMap<u16, u64> = BTreeMap::new();
    for message in messages {
        let (channel, _) = channels[message.topic.as_str()];
        let count = counts.entry(channel).or_default();
        record(&mut bytes, opcode::MESSAGE, &message_record(channel, *count as u32, message));
        *count += 1;
    }
    // A check sum of 0 means none.
    record(&mut bytes, opcode::DATA_END, &0_u32.to_le_bytes());
    let summary_start = bytes.len() as u64;
    bytes.extend_from_slice(&described);
    record(&mut bytes, opcode::STATISTICS, &statistics(messages, schemas.len(), channels.len(), &counts));
    let footer = [summary_start.to_le_bytes().as_slice(), &0_u64.to_le_bytes(), &0_u32.to_le_bytes()].concat();
    record(&mut bytes, opcode::FOOTER, &footer);
    bytes.extend_from_slice(MAGIC);
    bytes
}

fn record(bytes: &mut Vec<u8>, opcode: u8, content: &[u8]) {
    bytes.push(opcode);
    bytes.extend_from_slice(&(content.len() as u64).to_le_bytes());
    bytes.extend_from_slice(content);
}

/// Texts and maps are preceded by their length in bytes.
fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

fn schema_record(id: u16, name: &str) -> Vec<u8> {
    [id.to_le_bytes().to_vec(), text(name), text("ros2msg"), text(&ros::definition(name))].concat()
}

fn channel_record(id: u16, schema: u16, topic: &str) -> Vec<u8> {
    let no_metadata = 0_u32.to_le_bytes().to_vec();
    [id.to_le_bytes().to_vec(), schema.to_le_bytes().to_vec(), text(topic), text("cdr"), no_metadata].concat()
}

fn message_record(channel: u16, sequence: u32, message: &McapMessage) -> Vec<u8> {
    let time = message.time_ns.to_le_bytes();
    [&channel.to_le_bytes()[..], &sequence.to_le_bytes(), &time, &time, &message.data].concat()
}

fn statistics(messages: &[McapMessage], schemas: usize, channels: usize, counts: &BTreeMap<u16, u64>) -> Vec<u8> {
    let time = |message: Option<&McapMessage>| message.map_or(0, |message| message.time_ns).to_le_bytes();
    let none = 0_u32.to_le_bytes();
    let mut bytes = (messages.len() as u64).to_le_bytes().to_vec();
    bytes.extend_from_slice(&(schemas as u16).to_le_bytes());
    bytes.extend_from_slice(&(channels as u32).to_le_bytes());
    // No attachments, metadata or chunks.
    bytes.extend_from_slice(&[none, none, none].concat());
    bytes.extend_from_slice(&[time(messages.first()), time(messages.last())].concat());
    bytes.extend_from_slice(&(counts.len() as u32 * 10).to_le_bytes());
    for (channel, count) in counts {
        bytes.extend_from_slice(&channel.to_le_bytes());
        bytes.extend_from_slice(&count.to_le_bytes());
    }
    bytes
}
