//! Files of a scene, its job and its report.

use std::{fmt::Write as _, path::Path};

use etendue_core::maths::f64 as maths;
use etendue_scene::record::{Lens, Pose, Scene};
use etendue_scene::written::{File, Table};
use etendue_scene::{record::pose::Aim, record::transform::angles_deg};
use glam::{DMat3, DVec3};

use super::naming::rounded;

/// Result of an import.
pub(super) struct ImportFiles {
    /// Names within the folder, and contents.
    pub(super) files: Vec<(String, Vec<u8>)>,
    /// Conversion report, line by line.
    pub(super) report: Vec<String>,
}

/// Camera of an imported scene.
pub(super) struct ImportedCamera {
    pub(super) name: String,
    pub(super) pose: Pose,
    pub(super) view: View,
    /// Columns and rows.
    pub(super) size_px: [u64; 2],
}

/// View of a camera.
pub(super) enum View {
    /// Full vertical angle, rad.
    Perspective { yfov_rad: f64 },
    /// Full vertical angle of the focal plane, rad; radius of the lens, and focus distance, m.
    Lens { yfov_rad: f64, radius_m: f64, focus_m: f64 },
    /// Visible width, m.
    Orthographic { width_m: f64 },
    /// Ray-traced lens, and height of its sensor, mm.
    Prescription { lens: Box<Lens>, sensor_mm: f64 },
}

/// Height of the sensors of imported cameras, mm: that of a film of 36 mm by 24 mm. It does not affect the view.
const SENSOR_MM: f64 = 24.0;
/// Rows of an image whose file states only its aspect ratio.
const ROWS: f64 = 480.0;

/// Columns and rows of an image of this aspect ratio.
pub(super) fn size_of(aspect: f64) -> [u64; 2] {
    const MAX: f64 = 16_384.0;
    [(ROWS * aspect).round().clamp(1.0, MAX) as u64, ROWS as u64]
}

/// Pose of a camera in the world, m, that looks along `ahead`, with the upper edge of its image towards `up`; both of any length.
pub(super) fn pose_of(position: DVec3, ahead: DVec3, up: DVec3) -> Pose {
    let ahead = ahead.normalize_or(DVec3::X);
    let up = (up - up.dot(ahead) * ahead).normalize_or(ahead.any_orthonormal_vector());
    let turned = DMat3::from_cols(ahead, up.cross(ahead), up);
    let aim = Some(Aim::Rotation(rounded(angles_deg(turned)).into()));
    Pose { position_m: Some(position.to_array().into()), aim, ..Pose::default() }
}

impl ImportedCamera {
    fn to_table(&self) -> Table {
        let [width, height] = self.size_px;
        let (lens, sensor_mm) = self.view.lens();
        let sensor = Table::new()
            .with("width_px", width)
            .with("height_px", height)
            .with("pixel_pitch_um", 1000.0 * sensor_mm / height as f64);
        let pose = self.pose.to_table();
        Table::new().with("name", self.name.as_str()).and(pose).with("lens", lens).with("sensor", sensor)
    }
}

impl View {
    /// Lens, and height of its sensor, mm.
    fn lens(&self) -> (Table, f64) {
        let table = |kind: &str| Table::new().with("type", kind);
        match *self {
            Self::Prescription { ref lens, sensor_mm } => (lens.to_table(), sensor_mm),
            Self::Perspective { yfov_rad } => {
                let focal_mm = 0.5 * SENSOR_MM / maths::tan(0.5 * yfov_rad);
                (table("pinhole").with("focal_length_mm", focal_mm).with("f_number", 8.0), SENSOR_MM)
            }
            Self::Orthographic { width_m } => {
                (table("telecentric").with("field_width_m", width_m).with("f_number", 8.0), SENSOR_MM)
            }
            Self::Lens { yfov_rad, radius_m, focus_m } => {
                // The sensor is large enough that a lens of this radius is of f/2; smaller if the image would be as far away as the object.
                let image_m = |sensor_m: f64| 0.5 * sensor_m / maths::tan(0.5 * yfov_rad);
                let focal_m = |sensor_m: f64| 1.0 / (1.0 / image_m(sensor_m) + 1.0 / focus_m);
                let wanted_m = (4.0 * radius_m).min(0.5 * focus_m);
                let sensor_m = 2.0 * maths::tan(0.5 * yfov_rad) / (1.0 / wanted_m - 1.0 / focus_m);
                let f_number = 0.5 * focal_m(sensor_m) / radius_m;
                let lens = table("thin")
                    .with("focal_length_mm", 1000.0 * focal_m(sensor_m))
                    .with("f_number", f_number)
                    .with("focus_distance_m", focus_m);
                (lens, 1000.0 * sensor_m)
            }
        }
    }
}

/// `scene.toml` and `job.toml`, with the report at the head of the scene.
pub(super) fn import_files(
    source: &Path,
    scene: &Scene,
    cameras: &[ImportedCamera],
    report: Vec<String>,
) -> ImportFiles {
    let name = source.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut head = format!("Converted from {name} by etendue import. Conversion report:");
    for line in &report {
        // A control character in a name must not end the comment.
        let plain: String = line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        write!(head, "\n- {plain}").expect("writing to a String succeeds");
    }
    let cameras: Vec<Table> = cameras.iter().map(ImportedCamera::to_table).collect();
    let output = Table::new().with("radiance", true);
    let job = Table::new().with("scene", "scene.toml").with("cameras", cameras).with("output", output);
    let about = format!(
        "The cameras of {name}. Image size, f-number and samples are Étendue's defaults where the file does not state them as a camera does."
    );
    let files = vec![
        ("scene.toml".to_owned(), File::new(scene.to_table()).head(head).to_string().into_bytes()),
        ("job.toml".to_owned(), File::new(job).head(about).to_string().into_bytes()),
    ];
    ImportFiles { files, report }
}
