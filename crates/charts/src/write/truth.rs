//! Ground truth of a chart: sizes, light, features, patches, and their positions in each camera's image.

use std::fmt::Write as _;

use etendue_core::CameraPose;
use glam::{DVec2, DVec3};
use serde_json::{Map, Value, json};

use super::ChartSpecification;
use crate::drawing::{Feature, FeatureKind, Patch};
use crate::ink::{Ink, Paint};
use crate::shape::{centroid, disc};
use crate::{camera_station::CameraStation, light::Panel, ray_camera::RasterRay};

/// Points of a dot's outline that are projected.
const OUTLINE_POINTS: usize = 32;

/// `truth.json`.
pub(super) fn truth(request: &ChartSpecification<'_>) -> String {
    let drawing = request.drawing;
    let mut facts = json!({
        "format": 1,
        "program": "etendue",
        "chart": request.chart.name(),
        "seed": request.seed,
        "sizes": drawing.facts,
        "conventions": {
            "sheet_mm": "mm, x right, y down as the camera sees it, origin at the sheet's centre",
            "world_m": "m, x forward, y left, z up",
            "raster_px": "px, x right, y down, the top-left corner of the image is (0, 0), pixel centres at +0.5; null: outside \
                          the image. From the rays of the ground truth (587.56 nm, through the pupil's centre), for the full \
                          image: dark columns and rows of a raw file, regions and binning are not included",
            "image_centroids_px": "of discs: the centroid of the disc's image, which is not the image of its centre",
            "electrons": "mean photoelectrons of a pixel at the image centre, by channel, at the exposure of the camera file, \
                          before all sensor effects except the quantum efficiency",
        },
        "seen": {
            "distance_m": request.footprint.distance_m,
            "field_mm": request.footprint.outer_mm.to_array(),
            "whole_field_mm": request.footprint.inner_mm.to_array(),
            "pixel_mm": request.footprint.pixel_mm,
            "fills_the_field": request.footprint.fills,
        },
        "light": {
            "kind": if drawing.is_illuminated { "uniform, from all directions" } else { "emitted by the chart, in the dark" },
            "illuminant": request.light.name(),
            "luminance_cd_m2": request.light.luminance_cd_m2(),
            "xyz": request.light.white_xyz(),
        },
        "panels": drawing.panels.iter().map(panel).collect::<Vec<_>>(),
        "inks": drawing.inks.iter().map(|one| ink(one, request)).collect::<Vec<_>>(),
        "features": drawing.features.iter().map(|f| feature(f, &drawing.panels)).collect::<Vec<_>>(),
        "patches": drawing.patches.iter().map(|p| patch(p, request)).collect::<Vec<_>>(),
        "cameras": cameras(request),
    });
    if !request.changes.is_empty() {
        facts["conventions"]["changed_keys"] = json!(
            "changes of the job's keys that are applied after the chart is drawn: all other values are those of the chart without these changes"
        );
        facts["changed_keys"] = json!(request.changes);
    }
    let mut text = String::new();
    format_json(&facts, 0, &mut text);
    text.push('\n');
    text
}

/// Depth to which tables and lists are broken into lines.
const LINE_DEPTH: usize = 3;

/// Readable JSON: one line for each entry of a value that contains tables or long lists, to a depth.
fn format_json(value: &Value, depth: usize, text: &mut String) {
    let indent = "  ".repeat(depth + 1);
    let mut list = |open: char, close: char, entries: Vec<(String, &Value)>| {
        text.push(open);
        for (i, (key, entry)) in entries.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            let _ = write!(text, "{comma}\n{indent}{key}");
            format_json(entry, depth + 1, text);
        }
        let _ = write!(text, "\n{}{close}", "  ".repeat(depth));
    };
    match value {
        Value::Object(map) if depth < LINE_DEPTH && !map.is_empty() => {
            list('{', '}', map.iter().map(|(key, entry)| (format!("{key:?}: "), entry)).collect());
        }
        Value::Array(all) if depth < LINE_DEPTH && all.iter().any(|v| v.is_object() || v.is_array()) => {
            list('[', ']', all.iter().map(|entry| (String::new(), entry)).collect());
        }
        plain => text.push_str(&plain.to_string()),
    }
}

fn panel(panel: &Panel) -> Value {
    let column = |i: usize| (panel.rotation.col(i) / 1e3).to_array();
    let rows: [[f64; 4]; 3] = std::array::from_fn(|r| [column(0)[r], column(1)[r], column(2)[r], panel.position_m[r]]);
    json!({ "name": panel.name, "size_mm": panel.sheet.size_mm.to_array(), "sheet_mm_to_world_m": rows })
}

fn ink(ink: &Ink, request: &ChartSpecification<'_>) -> Value {
    let light = request.light;
    let lab = ink.lab(light);
    let kind = match &ink.paint {
        Paint::Grey(_) => "flat reflectance",
        Paint::Spectral(_) => "measured reflectance",
        Paint::Luminous(_) => "emits light",
        Paint::Pulses { .. } => "emits pulses, their mean",
        Paint::Texture { .. } => "texture, its mean",
    };
    let mut facts = json!({
        "name": ink.name,
        "kind": kind,
        "luminous_fraction": ink.luminous_fraction(light),
        "luminance_cd_m2": ink.luminance_cd_m2(light),
        "lab": [lab.l, lab.a, lab.b],
        "xyz": ink.xyz(light),
    });
    if let Some(response) = request.response {
        let channels = (response.electrons)(&ink.radiance(light)).into_iter();
        facts["electrons"] = channels.map(|(name, electrons)| (name, json!(electrons))).collect::<Map<_, _>>().into();
    }
    facts
}

fn feature(feature: &Feature, panels: &[Panel]) -> Value {
    let panel = &panels[feature.panel];
    let mut facts = json!({
        "kind": feature.kind.name(),
        "sheet_mm": feature.points_mm.iter().map(|p| p.to_array()).collect::<Vec<_>>(),
        "world_m": feature.points_mm.iter().map(|p| panel.world_m(*p).to_array()).collect::<Vec<_>>(),
    });
    let mut add = |key: &str, value: Option<Value>| {
        if let Some(value) = value {
            facts[key] = value;
        }
    };
    add("index", feature.index.map(|i| json!(i)));
    add("diameter_mm", feature.radius_mm.map(|r| json!(2.0 * r)));
    add("panel", (feature.panel > 0).then(|| json!(panel.name)));
    facts
}

fn patch(patch: &Patch, request: &ChartSpecification<'_>) -> Value {
    let ink = &request.drawing.inks[patch.ink];
    json!({
        "name": patch.name,
        "ink": ink.name,
        "panel": request.drawing.panels[patch.panel].name,
        "outline_sheet_mm": patch.outline_mm.iter().map(|p| p.to_array()).collect::<Vec<_>>(),
    })
}

/// Pose, exposure and feature positions of each camera. Cameras of one pose share the positions.
fn cameras(request: &ChartSpecification<'_>) -> Vec<Value> {
    let starts = request.ray_camera.starts();
    let mut views: Vec<(CameraPose, Map<String, Value>)> = Vec::new();
    let mut station_json = |station: &CameraStation| {
        let pose = station.pose();
        let known = views.iter().find(|(other, _)| *other == pose).map(|(_, view_json)| view_json.clone());
        let view_json = known.unwrap_or_else(|| {
            let view = CameraView { request, starts: &starts, pose };
            let view_json = if station.dark { Map::new() } else { view.visible_positions() };
            views.push((pose, view_json.clone()));
            view_json
        });
        let mut facts = camera(request, station, &pose);
        facts.extend(view_json);
        Value::Object(facts)
    };
    request.stations.iter().map(&mut station_json).collect()
}

fn camera(request: &ChartSpecification<'_>, station: &CameraStation, pose: &CameraPose) -> Map<String, Value> {
    let rows: [[f64; 4]; 3] = std::array::from_fn(|i| {
        let row = pose.rotation.row(i);
        [row.x, row.y, row.z, pose.position_m[i]]
    });
    let exposure_s = station.exposure_s.or(request.response.map(|m| m.exposure_s));
    let white = request.response.zip(exposure_s).map(|(response, exposure_s)| {
        response.saturation_fraction(request.light.radiance()) * exposure_s / response.exposure_s
    });
    let mut facts = Map::new();
    facts.insert("name".into(), json!(station.name));
    facts.insert("file".into(), json!(super::job::camera_file(station)));
    facts.insert("dark".into(), json!(station.dark));
    let size = request.ray_camera.size_px;
    facts.insert("picture_px".into(), json!([size.x as u32, size.y as u32]));
    facts.insert("exposure_s".into(), json!(exposure_s));
    facts.insert("saturation_share_of_the_light".into(), json!(white));
    facts.insert("camera_to_world".into(), json!(rows));
    facts
}

/// A camera with its pose.
struct CameraView<'a> {
    request: &'a ChartSpecification<'a>,
    starts: &'a [(DVec2, RasterRay)],
    pose: CameraPose,
}

impl CameraView<'_> {
    fn visible_positions(&self) -> Map<String, Value> {
        let drawing = self.request.drawing;
        let points = |feature: &Feature| {
            let raster_point = |p: &DVec2| self.raster(&drawing.panels[feature.panel], *p);
            feature.points_mm.iter().map(raster_point).collect::<Vec<Value>>()
        };
        let outline = |patch: &Patch| {
            let raster_point = |p: &DVec2| self.raster(&drawing.panels[patch.panel], *p);
            patch.outline_mm.iter().map(raster_point).collect::<Vec<Value>>()
        };
        let mut visible = Map::new();
        if !drawing.features.is_empty() {
            visible.insert("features_px".into(), drawing.features.iter().map(points).collect());
        }
        if drawing.features.iter().any(|f| f.kind == FeatureKind::Dot) {
            visible.insert("image_centroids_px".into(), drawing.features.iter().map(|f| self.centroid(f)).collect());
        }
        if !drawing.patches.is_empty() {
            visible.insert("patches_px".into(), drawing.patches.iter().map(outline).collect());
        }
        visible
    }

    fn project(&self, panel: &Panel, point_mm: DVec2) -> Option<DVec2> {
        let point_m: DVec3 = self.pose.rotation.transpose() * (panel.world_m(point_mm) - self.pose.position_m);
        self.request.ray_camera.project(self.starts, point_m)
    }

    fn raster(&self, panel: &Panel, point_mm: DVec2) -> Value {
        self.project(panel, point_mm).map_or(Value::Null, |at| json!(at.to_array()))
    }

    /// The centroid of a disc's image; null if it is not fully visible.
    fn centroid(&self, feature: &Feature) -> Value {
        let panel = &self.request.drawing.panels[feature.panel];
        let Some(radius) = feature.radius_mm else { return Value::Null };
        let outline = disc(feature.points_mm[0], radius, OUTLINE_POINTS, 0.0);
        let image: Option<Vec<DVec2>> = outline.iter().map(|p| self.project(panel, *p)).collect();
        image.map_or(Value::Null, |image| json!(centroid(&image).to_array()))
    }
}
