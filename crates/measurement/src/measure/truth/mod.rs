//! Ground truth of an image from the truth.json of its chart.

pub(crate) mod place;
pub(crate) mod points;
mod truth_file;

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_core::maths::f64::sin;
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::sfr::Strip;
use glam::DVec2;

use super::readings::{Readings, pixels};
use place::{EdgeRegion, PatchPlace, Spoke, StarCentre, StarPlace, TrapPlace};
use truth_file::{CameraRecord, FeatureRecord, TruthFile};

/// Location of the chart's ground truth.
#[derive(Args, Clone, Debug, Default)]
pub struct TruthInput {
    /// The truth.json of `etendue chart`, which describes the content of the image and its position
    #[arg(long, value_name = "truth.json", conflicts_with = "region")]
    pub truth: Option<PathBuf>,
    /// With --truth: camera of the image [default: the first]
    #[arg(long, value_name = "NAME", requires = "truth")]
    pub camera: Option<String>,
}

/// Size of an edge's region as a fraction of the edge's length: along it, and across it (both sides together).
const ALONG_FRACTION: f64 = 0.6;
const ACROSS_FRACTION: f64 = 0.5;
/// Measured part of a star's edge, from its end to its beginning or the other way, and fraction of the distance to its
/// neighbours.
const SPOKE_RANGE: [f64; 2] = [0.15, 0.95];
const CLEAR_FRACTION: f64 = 0.8;
/// Margin left out at a patch's outline, px of the image (lens blur, demosaicing), and the minimum as a fraction of half its
/// side.
const MARGIN_PX: f64 = 2.0;
const MARGIN_FRACTION: f64 = 0.2;
/// Measured part of a uniform surface along each side, where a fall-off must not matter.
const CENTRE_FRACTION: f64 = 0.25;

/// Ground truth of a chart as seen by one of its cameras.
pub(crate) struct Truth {
    file: PathBuf,
    content: TruthFile,
    camera: usize,
}

impl TruthInput {
    /// Reads the ground truth of one of these charts; `None` if none is given.
    pub(crate) fn read(&self, charts: &[&str]) -> Result<Option<Truth>, Error> {
        self.truth.as_deref().map(|file| Truth::read(file, self.camera.as_deref(), charts)).transpose()
    }
}

impl Truth {
    fn read(file: &Path, camera: Option<&str>, charts: &[&str]) -> Result<Self, Error> {
        let truth_file = truth_file::read(file)?;
        let refused =
            |problem: String| Error::coded(ErrorCode::UnsuitableFile, format!("{}: {problem}", file.display()));
        if !charts.contains(&truth_file.chart.as_str()) {
            let supported = charts.join(", ");
            return Err(refused(format!(
                "ground truth of the chart {}; this measurement accepts {supported}",
                truth_file.chart
            )));
        }
        let named = |c: &CameraRecord| camera.is_none_or(|name| c.name == name) && (camera.is_some() || !c.dark);
        let camera = truth_file.cameras.iter().position(named).ok_or_else(|| {
            let names: Vec<&str> = truth_file.cameras.iter().map(|c| c.name.as_str()).collect();
            refused(format!("no camera '{}'; it has {}", camera.unwrap_or_default(), names.join(", ")))
        })?;
        Ok(Self { file: file.to_owned(), content: truth_file, camera })
    }

    pub(crate) fn chart(&self) -> &str {
        &self.content.chart
    }

    fn refused(&self, problem: impl std::fmt::Display) -> Error {
        Error::coded(ErrorCode::UnsuitableFile, format!("{}: {problem}", self.file.display()))
    }

    fn camera_record(&self) -> &CameraRecord {
        &self.content.cameras[self.camera]
    }

    /// Checks that an image has the camera's image size.
    pub(crate) fn fits(&self, image: &Path, readings: &Readings) -> Result<(), Error> {
        self.sized(image, readings.picture_px.0, readings.picture_px.1)
    }

    fn sized(&self, image: &Path, width: usize, height: usize) -> Result<(), Error> {
        let camera = self.camera_record();
        let [columns, rows] = camera.picture_px;
        if (width, height) == (columns, rows) {
            return Ok(());
        }
        let changed =
            if (height, width) == (columns, rows) { "cropped, scaled or rotated by 90°" } else { "cropped or scaled" };
        Err(Error::coded(
            ErrorCode::NotComparable,
            format!(
                "{}: {width} × {height} pixels, but the camera '{}' of {} has {columns} × {rows}; give its full image, not {changed}",
                image.display(),
                camera.name,
                self.file.display()
            ),
        ))
    }

    /// XYZ of the light.
    pub(crate) fn white_xyz(&self) -> [f64; 3] {
        self.content.light.xyz
    }

    /// The centre of a uniform surface that fills the image.
    pub(crate) fn middle(&self, readings: &Readings) -> Result<[usize; 4], Error> {
        self.filled()?;
        let [w, h] = self.camera_record().picture_px.map(|n| n as f64);
        let side = |fraction: f64| [fraction * w, fraction * h];
        pixels(
            side(0.5 - 0.5 * CENTRE_FRACTION),
            side(0.5 + 0.5 * CENTRE_FRACTION),
            readings.picture_px.0,
            readings.picture_px.1,
        )
        .ok_or_else(|| self.refused("the image is too small"))
    }

    /// Refuses a sheet that does not fill the camera's view.
    pub(crate) fn filled(&self) -> Result<(), Error> {
        match self.content.view.fills_the_field {
            true => Ok(()),
            false => {
                Err(self
                    .refused("the sheet does not fill the camera's view; measure a `region` of it, without `truth`"))
            }
        }
    }

    /// Luminance times exposure time of each camera that sees the light, in order, cd s/m².
    pub(crate) fn exposures(&self) -> Result<Vec<(&str, f64)>, Error> {
        let lit = self.content.cameras.iter().filter(|c| !c.dark);
        let exposure = |c: &'_ CameraRecord| c.exposure_s.map(|s| s * self.content.light.luminance_cd_m2);
        lit.map(|c| exposure(c).map(|h| (c.name.as_str(), h)).ok_or_else(|| self.refused("a camera has no exposure")))
            .collect()
    }

    /// The patches that are entirely in the image and large enough, and the names of the others.
    pub(crate) fn patches(&self, readings: &Readings) -> Result<(Vec<PatchPlace>, Vec<String>), Error> {
        let (mut patch_places, mut left_out) = (Vec::new(), Vec::new());
        for (patch, places) in self.content.patches.iter().zip(&self.camera_record().patches_px) {
            let ink = self.content.inks.iter().find(|ink| ink.name == patch.ink);
            let ink = ink.ok_or_else(|| self.refused(format!("the patch {} has no ink", patch.name)))?;
            match complete_points(places).and_then(|outline| square(&outline, readings)) {
                Some(at) => patch_places.push(PatchPlace {
                    name: patch.name.clone(),
                    at,
                    luminance_cd_m2: ink.luminance_cd_m2,
                    xyz: ink.xyz,
                }),
                None => left_out.push(patch.name.clone()),
            }
        }
        if patch_places.is_empty() {
            return Err(self.refused("no patch is entirely in the image and large enough to be measured"));
        }
        Ok((patch_places, left_out))
    }

    /// Refuses an image that shows these patches mirrored or turned, or does not show them.
    pub(crate) fn shown(&self, image: &Path, patches: &[PatchPlace], readings: &Readings) -> Result<(), Error> {
        place::orientation_error(patches, readings).map_or(Ok(()), |problem| {
            Err(Error::coded(
                ErrorCode::NotMeasurable,
                format!("{}: {problem} ({})", image.display(), self.file.display()),
            ))
        })
    }

    /// Frequency (Hz) and duty cycle of a modulated lamp, by its patch's name.
    pub(crate) fn lamp(&self, name: &str) -> Option<(f64, f64)> {
        let lamps = self.content.sizes.get("lamps")?.as_array()?;
        let lamp = lamps.iter().find(|lamp| lamp["name"].as_str() == Some(name))?;
        Some((lamp["frequency_hz"].as_f64()?, lamp["duty_cycle"].as_f64()?))
    }

    /// Light from the bottom of a light trap relative to the white's.
    pub(crate) fn light_of_traps(&self) -> Option<f64> {
        self.content.size("luminance_of_a_trap_s_bottom_over_white_about")
    }

    /// Light traps that are entirely in the image, with the white midway to their neighbours.
    pub(crate) fn traps(&self, readings: &Readings) -> Result<Vec<TrapPlace>, Error> {
        let opening = self.content.size("opening_mm").zip(self.content.size("pitch_mm"));
        let (opening, pitch) = opening.ok_or_else(|| self.refused("lacks the sizes of the traps"))?;
        let trap = |places: &Vec<Option<[f64; 2]>>| {
            let outline = complete_points(places)?;
            let trap = square(&outline, readings)?;
            let whites = place::squares_beside(&outline, opening, pitch).into_iter();
            let whites: Vec<[usize; 4]> = whites.filter_map(|(middle, half)| within(middle, half, readings)).collect();
            (!whites.is_empty()).then_some(TrapPlace { trap, whites })
        };
        let trap_places: Vec<TrapPlace> = self.camera_record().patches_px.iter().filter_map(trap).collect();
        if trap_places.is_empty() {
            return Err(self.refused("no trap is entirely in the image, large enough and next to white"));
        }
        Ok(trap_places)
    }

    /// The Siemens star.
    pub(crate) fn star(&self) -> Result<StarPlace, Error> {
        let incomplete = || self.refused("the star is not entirely in the image");
        let feature = |kind: &str| self.visible_features().find(|(f, _)| f.kind == kind).map(|(_, points)| points);
        let (centre, edge) = (feature("centre").ok_or_else(incomplete)?[0], feature("rim").ok_or_else(incomplete)?);
        let ground = self
            .camera_record()
            .patches_px
            .first()
            .and_then(|places| complete_points(places))
            .ok_or_else(incomplete)?;
        let radii = |outline: &[DVec2]| outline.iter().map(|p| (*p - centre).length()).collect::<Vec<f64>>();
        let cycles = self.content.size("cycles").ok_or_else(incomplete)? as u32;
        Ok(StarPlace {
            centre_px: centre.into(),
            cycles,
            inner_px: radii(&ground).into_iter().fold(0.0, f64::max),
            outer_px: radii(&edge).into_iter().fold(f64::INFINITY, f64::min),
        })
    }

    /// Strips along the edges of stars that are entirely in the image, clear of their neighbours.
    pub(crate) fn spokes(&self, readings: &Readings) -> Result<Vec<EdgeRegion>, Error> {
        let wedges = self.content.size("dark_wedges").ok_or_else(|| self.refused("lacks the number of wedges"))?;
        let clear = CLEAR_FRACTION * sin(core::f64::consts::PI / wedges);
        let visible_edges: Vec<(&FeatureRecord, Vec<DVec2>)> = self.visible_features().collect();
        let centres = visible_edges.iter().filter(|(f, _)| f.kind == "centre");
        let star = |(feature, points): &(&FeatureRecord, Vec<DVec2>)| Some((feature.index?, points[0]));
        let stars: Vec<([usize; 2], DVec2)> = centres.filter_map(star).collect();
        let spoke = |(feature, ends): &(&FeatureRecord, Vec<DVec2>)| {
            let (index, centre) = *stars.iter().find(|(index, _)| Some(*index) == feature.index)?;
            let part = |fraction: f64| ends[0].lerp(ends[1], fraction);
            spoke(index, centre, [part(SPOKE_RANGE[0]), part(SPOKE_RANGE[1])], clear, readings)
        };
        let spokes: Vec<EdgeRegion> =
            visible_edges.iter().filter(|(f, _)| f.kind == "edge").filter_map(spoke).collect();
        if spokes.is_empty() {
            return Err(self.refused("no star of this chart is entirely in the image"));
        }
        Ok(spokes)
    }

    /// Features that are entirely in the image.
    fn visible_features(&self) -> impl Iterator<Item = (&FeatureRecord, Vec<DVec2>)> {
        let pairs = self.content.features.iter().zip(&self.camera_record().features_px);
        pairs.filter_map(|(feature, places)| Some((feature, complete_points(places)?)))
    }

    /// Regions around the edges of squares that are entirely in the image.
    pub(crate) fn edges(&self, readings: &Readings) -> Result<Vec<[usize; 4]>, Error> {
        let edges = self.visible_features().filter(|(f, _)| f.kind == "edge");
        let regions: Vec<[usize; 4]> = edges.filter_map(|(_, ends)| region(&ends, readings)).collect();
        if regions.is_empty() {
            return Err(self.refused("no edge of this chart is entirely in the image"));
        }
        Ok(regions)
    }
}

/// The points of an outline or edge, if all are in the image.
fn complete_points(places: &[Option<[f64; 2]>]) -> Option<Vec<DVec2>> {
    let points: Option<Vec<DVec2>> = places.iter().map(|p| p.map(DVec2::from)).collect();
    points.filter(|points| !points.is_empty())
}

/// The pixels of the largest square inside an outline, less its margin.
fn square(outline: &[DVec2], readings: &Readings) -> Option<[usize; 4]> {
    let (middle, half) = place::largest_square(outline);
    within(middle, half - MARGIN_PX.max(MARGIN_FRACTION * half), readings)
}

/// The pixels of a square with this centre and half side, which must contain two readings each way.
fn within(middle: DVec2, half: f64, readings: &Readings) -> Option<[usize; 4]> {
    let (low, high) = ((middle - half).into(), (middle + half).into());
    let is_large_enough = readings.between(low, high).is_some_and(|at| at[2] > 1 && at[3] > 1);
    pixels(low, high, readings.picture_px.0, readings.picture_px.1).filter(|_| is_large_enough && half > 0.0)
}

/// A strip along a part of a star's edge, in the image, which widens outwards.
fn spoke(index: [usize; 2], centre: DVec2, ends: [DVec2; 2], clear: f64, readings: &Readings) -> Option<EdgeRegion> {
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let at = pixels(low.into(), high.into(), readings.picture_px.0, readings.picture_px.1)?;
    let step = readings.period.0 as f64;
    let strip = Strip {
        ends_px: ends.map(|end| readings.place(end.into())),
        half_widths_px: ends.map(|end| clear * (end - centre).length() / step),
    };
    Some(EdgeRegion { at, spoke: Some(Spoke { strip, star: StarCentre { index, centre_px: centre.into() } }) })
}

/// Region around an edge from one end to the other.
fn region(ends: &[DVec2], readings: &Readings) -> Option<[usize; 4]> {
    let [a, b] = [*ends.first()?, *ends.get(1)?];
    let run = (b - a).abs();
    let length = run.max_element();
    let half = 0.5
        * length
        * if run.y > run.x {
            DVec2::new(ACROSS_FRACTION, ALONG_FRACTION)
        } else {
            DVec2::new(ALONG_FRACTION, ACROSS_FRACTION)
        };
    let middle = 0.5 * (a + b);
    pixels((middle - half).into(), (middle + half).into(), readings.picture_px.0, readings.picture_px.1)
}
