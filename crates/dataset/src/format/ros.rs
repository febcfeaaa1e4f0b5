//! Messages of ROS 2 in CDR (OMG, little-endian), and their definitions.
//!
//! Numbers are aligned to their own size, counted from after the four bytes that state the encoding.

use etendue_core::Plane;
use etendue_core::quantity::{Display, Length};
use etendue_io::calibration::export::ros::CameraInfo;
use glam::DVec2;

use crate::record::Pose;

pub(super) const COMPRESSED_IMAGE: &str = "sensor_msgs/msg/CompressedImage";
pub(super) const IMAGE: &str = "sensor_msgs/msg/Image";
pub(super) const POINT_CLOUD: &str = "sensor_msgs/msg/PointCloud2";
pub(super) const CAMERA_INFO: &str = "sensor_msgs/msg/CameraInfo";
pub(super) const TF_MESSAGE: &str = "tf2_msgs/msg/TFMessage";

const NS: u64 = 1_000_000_000;

/// Time, ns, and coordinate frame of a message.
#[derive(Clone, Copy, Debug)]
pub(super) struct MessageHeader<'a> {
    pub(super) time_ns: u64,
    /// Name of the coordinate frame.
    pub(super) frame: &'a str,
}

/// Fields of the messages, and of the types that they contain.
const DEFINITIONS: [(&str, &str, &[&str]); 13] = [
    (COMPRESSED_IMAGE, "std_msgs/Header header\nstring format\nuint8[] data\n", &[HEADER, TIME]),
    (
        IMAGE,
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data\n",
        &[HEADER, TIME],
    ),
    (
        POINT_CLOUD,
        "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\n\
         uint32 row_step\nuint8[] data\nbool is_dense\n",
        &[HEADER, TIME, POINT_FIELD],
    ),
    (
        CAMERA_INFO,
        "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\nfloat64[9] k\nfloat64[9] r\n\
         float64[12] p\nuint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n",
        &[HEADER, TIME, ROI],
    ),
    (
        TF_MESSAGE,
        "geometry_msgs/TransformStamped[] transforms\n",
        &[STAMPED, HEADER, TIME, TRANSFORM, VECTOR, QUATERNION],
    ),
    (HEADER, "builtin_interfaces/Time stamp\nstring frame_id\n", &[]),
    (TIME, "int32 sec\nuint32 nanosec\n", &[]),
    (POINT_FIELD, "string name\nuint32 offset\nuint8 datatype\nuint32 count\n", &[]),
    (ROI, "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n", &[]),
    (STAMPED, "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n", &[]),
    (TRANSFORM, "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n", &[]),
    (VECTOR, "float64 x\nfloat64 y\nfloat64 z\n", &[]),
    (QUATERNION, "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n", &[]),
];
const HEADER: &str = "std_msgs/Header";
const TIME: &str = "builtin_interfaces/Time";
const POINT_FIELD: &str = "sensor_msgs/PointField";
const ROI: &str = "sensor_msgs/RegionOfInterest";
const STAMPED: &str = "geometry_msgs/TransformStamped";
const TRANSFORM: &str = "geometry_msgs/Transform";
const VECTOR: &str = "geometry_msgs/Vector3";
const QUATERNION: &str = "geometry_msgs/Quaternion";

/// Definition of a message and of the types that it contains, in the form of ROS 2 files.
pub(super) fn definition(name: &str) -> String {
    let definition_of =
        |name: &str| DEFINITIONS.iter().find(|(known, ..)| *known == name).expect("a message that is written");
    let (_, fields, parts) = definition_of(name);
    let mut text = (*fields).to_owned();
    for part in *parts {
        text.push_str(&format!("{}\nMSG: {part}\n{}", "=".repeat(80), definition_of(part).1));
    }
    text
}

/// Message under construction.
struct Cdr(Vec<u8>);

impl Cdr {
    /// Starts a message with a header.
    fn with_header(at: MessageHeader<'_>) -> Self {
        let mut cdr = Self(vec![0, 1, 0, 0]);
        cdr.header(at);
        cdr
    }

    fn header(&mut self, MessageHeader { time_ns, frame }: MessageHeader<'_>) {
        self.u32((time_ns / NS) as u32);
        self.u32((time_ns % NS) as u32);
        self.text(frame);
    }

    fn align(&mut self, size: usize) {
        let length = self.0.len() - 4;
        self.0.resize(4 + length.next_multiple_of(size), 0);
    }

    fn u32(&mut self, value: u32) {
        self.align(4);
        self.0.extend_from_slice(&value.to_le_bytes());
    }

    fn f64s(&mut self, values: &[f64]) {
        self.align(8);
        values.iter().for_each(|value| self.0.extend_from_slice(&value.to_le_bytes()));
    }

    /// Writes a text with its length, which includes the terminating zero.
    fn text(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.0.extend_from_slice(text.as_bytes());
        self.0.push(0);
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.u32(bytes.len() as u32);
        self.0.extend_from_slice(bytes);
    }
}

/// Encoded image, by the extension of its file.
pub(super) fn compressed_image(at: MessageHeader<'_>, extension: &str, image: &[u8]) -> Vec<u8> {
    let mut cdr = Cdr::with_header(at);
    cdr.text(if extension == "jpg" { "jpeg" } else { extension });
    cdr.bytes(image);
    cdr.0
}

/// Depths, m.
pub(super) fn depth_image(at: MessageHeader<'_>, depth: &Plane<Length>) -> Vec<u8> {
    let (width, height) = (depth.width() as u32, depth.height() as u32);
    let mut cdr = Cdr::with_header(at);
    cdr.u32(height);
    cdr.u32(width);
    cdr.text("32FC1");
    cdr.0.push(0);
    cdr.u32(4 * width);
    let numbers: Vec<u8> = depth.samples().iter().flat_map(|depth| depth.to_le_bytes()).collect();
    cdr.bytes(&numbers);
    cdr.0
}

/// Bytes per point: three coordinates and a colour.
const POINT_BYTES: usize = 16;
/// Type code of 32-bit floats.
const FLOAT32: u8 = 7;

/// Points that a camera sees through its pixel centres, in its frame, m, row by row with their colours (red, green, blue from 0 to 1, display-referred); NaN
/// where there is no depth. `tangents` are x/z and y/z of the direction that a raster point sees.
pub(super) fn point_cloud(
    at: MessageHeader<'_>,
    depth: &Plane<Length>,
    colours: &Plane<Display>,
    tangents: impl Fn(DVec2) -> Option<DVec2>,
) -> Vec<u8> {
    let (width, height) = (depth.width(), depth.height());
    let mut cdr = Cdr::with_header(at);
    cdr.u32(height as u32);
    cdr.u32(width as u32);
    cdr.u32(4);
    for (number, name) in ["x", "y", "z", "rgb"].iter().enumerate() {
        cdr.text(name);
        cdr.u32(4 * number as u32);
        cdr.0.push(FLOAT32);
        cdr.u32(1);
    }
    cdr.0.push(0);
    cdr.u32(POINT_BYTES as u32);
    cdr.u32((POINT_BYTES * width) as u32);
    let mut points = Vec::with_capacity(POINT_BYTES * width * height);
    for (i, (z, colour)) in depth.samples().iter().zip(colours.samples()).enumerate() {
        let centre_px = DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let point = match tangents(centre_px).filter(|_| z.is_finite()) {
            Some(DVec2 { x, y }) => [x, y, 1.0].map(|n| (n * f64::from(*z)) as f32),
            None => [f32::NAN; 3],
        };
        point.iter().for_each(|n| points.extend_from_slice(&n.to_le_bytes()));
        // Packed as in the Point Cloud Library: blue in the lowest byte.
        let [red, green, blue] = colour.map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8);
        points.extend_from_slice(&[blue, green, red, 0]);
    }
    cdr.bytes(&points);
    cdr.0.push(0);
    cdr.0
}

/// Camera with its distortion.
pub(super) fn camera_info(at: MessageHeader<'_>, info: &CameraInfo) -> Vec<u8> {
    let [width, height] = info.size_px;
    let mut cdr = Cdr::with_header(at);
    cdr.u32(height as u32);
    cdr.u32(width as u32);
    cdr.text(info.distortion_model);
    cdr.u32(info.coefficients.len() as u32);
    cdr.f64s(&info.coefficients);
    cdr.f64s(info.matrix.as_flattened());
    cdr.f64s(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    cdr.f64s(info.projection.as_flattened());
    // No binning and no region of interest.
    (0..6).for_each(|_| cdr.u32(0));
    cdr.0.push(0);
    cdr.0
}

/// Transform from the world to a camera.
pub(super) fn transform(camera: MessageHeader<'_>, pose: &Pose) -> Vec<u8> {
    let [w, x, y, z] = pose.rotation_wxyz;
    let mut cdr = Cdr(vec![0, 1, 0, 0]);
    cdr.u32(1);
    cdr.header(MessageHeader { frame: "world", ..camera });
    cdr.text(camera.frame);
    cdr.f64s(&pose.position_m);
    cdr.f64s(&[x, y, z, w]);
    cdr.0
}
