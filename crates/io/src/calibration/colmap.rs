//! COLMAP's cameras; the id is the camera's name. All models of COLMAP 4 are read. Its pixel coordinates are the raster's.
//!
//! | file | contents |
//! | --- | --- |
//! | `cameras.txt` | one line per camera: CAMERA_ID MODEL WIDTH HEIGHT PARAMS… |
//! | `cameras.bin` | u64 number of cameras; of each u32 id, i32 model, u64 width, u64 height, f64 parameters; little-endian |

use core::f64::consts::{PI, TAU};
use std::borrow::Cow;

use etendue_projection::model::{
    Division, ExtendedUnified, FieldOfView, KannalaBrandt, ModelError, Panorama, Perspective, ThinPrismFisheye,
};
use etendue_projection::{Calibration, CameraMatrix, Model, plane::DistortionTerms};

use super::{ErrorCode, ReaderResult, TreeError, TreeResult, camera_error, models::invalid_model};

/// Models with one focal length and with two, each with its number of parameters.
const ONE_FOCAL: [(&str, usize); 7] = [
    ("SIMPLE_PINHOLE", 3),
    ("SIMPLE_RADIAL", 4),
    ("RADIAL", 5),
    ("SIMPLE_FISHEYE", 3),
    ("SIMPLE_RADIAL_FISHEYE", 4),
    ("RADIAL_FISHEYE", 5),
    ("SIMPLE_DIVISION", 4),
];
const TWO_FOCALS: [(&str, usize); 10] = [
    ("PINHOLE", 4),
    ("OPENCV", 8),
    ("FULL_OPENCV", 12),
    ("FISHEYE", 4),
    ("OPENCV_FISHEYE", 8),
    ("FOV", 5),
    ("DIVISION", 5),
    ("EUCM", 6),
    ("THIN_PRISM_FISHEYE", 12),
    ("RAD_TAN_THIN_PRISM_FISHEYE", 16),
];
/// Its two parameters are the image size.
const PANORAMA: (&str, usize) = ("EQUIRECTANGULAR", 2);
/// Models by their number in the binary form.
const NUMBERED: [&str; 18] = [
    "SIMPLE_PINHOLE",
    "PINHOLE",
    "SIMPLE_RADIAL",
    "RADIAL",
    "OPENCV",
    "OPENCV_FISHEYE",
    "FULL_OPENCV",
    "FOV",
    "SIMPLE_RADIAL_FISHEYE",
    "RADIAL_FISHEYE",
    "THIN_PRISM_FISHEYE",
    "RAD_TAN_THIN_PRISM_FISHEYE",
    "SIMPLE_DIVISION",
    "DIVISION",
    "SIMPLE_FISHEYE",
    "FISHEYE",
    "EUCM",
    "EQUIRECTANGULAR",
];

pub(super) fn read(text: &str, camera: Option<&str>) -> TreeResult<ReaderResult> {
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let cameras: Vec<CameraLine<'_>> = lines
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .map(|(number, line)| CameraLine::read(number, line))
        .collect::<TreeResult<_>>()?;
    result(&cameras, camera)
}

/// Returns true if a file has the binary form: no text contains a zero.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    bytes.contains(&0)
}

pub(super) fn read_binary(bytes: &[u8], camera: Option<&str>) -> TreeResult<ReaderResult> {
    let mut rest = bytes;
    let count = integer(&mut rest)?;
    let mut cameras = Vec::new();
    for _ in 0..count {
        cameras.push(CameraLine::read_binary(&mut rest)?);
    }
    if !rest.is_empty() {
        return Err(TreeError::at(0, format!("{} bytes follow the {count} cameras; expected none", rest.len())));
    }
    result(&cameras, camera)
}

/// The next `N` bytes.
fn next<const N: usize>(rest: &mut &[u8]) -> TreeResult<[u8; N]> {
    let bytes = rest.split_first_chunk::<N>();
    let Some((bytes, after)) = bytes else {
        return Err(TreeError::at(0, "not a complete cameras.bin of COLMAP: the file ends within a camera"));
    };
    *rest = after;
    Ok(*bytes)
}

fn integer(rest: &mut &[u8]) -> TreeResult<u64> {
    next(rest).map(u64::from_le_bytes)
}

fn result(cameras: &[CameraLine<'_>], camera: Option<&str>) -> TreeResult<ReaderResult> {
    let line = chosen(cameras, camera)?;
    let (model, matrix) = line.camera()?;
    let calibration = Calibration::new(model, matrix, line.size_px).map_err(camera_error(line.number))?;
    Ok(ReaderResult::new(line.id.as_ref(), calibration, Vec::new()))
}

/// A camera; `number` is its line, 0 in the binary form.
struct CameraLine<'a> {
    number: usize,
    id: Cow<'a, str>,
    model: &'a str,
    size_px: [usize; 2],
    parameters: Vec<f64>,
}

/// Number of parameters of a model, if it is known.
fn parameter_count(model: &str) -> Option<usize> {
    let mut all = ONE_FOCAL.iter().chain(&TWO_FOCALS).chain([&PANORAMA]);
    all.find(|(name, _)| *name == model).map(|(_, count)| *count)
}

fn chosen<'a, 'b>(cameras: &'b [CameraLine<'a>], camera: Option<&str>) -> TreeResult<&'b CameraLine<'a>> {
    const SHOWN: usize = 24;
    let more = if cameras.len() > SHOWN { ", …" } else { "" };
    let names = cameras.iter().take(SHOWN).map(|c| c.id.as_ref()).collect::<Vec<_>>().join(", ") + more;
    match (cameras, camera) {
        ([], _) => Err(TreeError::at(0, "contains no camera; expected a line CAMERA_ID MODEL WIDTH HEIGHT PARAMS…")),
        (all, Some(requested)) => all.iter().find(|c| c.id == requested).ok_or_else(|| {
            TreeError::coded(
                ErrorCode::UnknownName,
                0,
                format!("contains no camera \"{requested}\"; it contains {names}"),
            )
        }),
        ([one], None) => Ok(one),
        _ => Err(TreeError::coded(
            ErrorCode::UnknownName,
            0,
            format!("contains the cameras {names}; select one by its id"),
        )),
    }
}

impl<'a> CameraLine<'a> {
    fn read(number: usize, text: &'a str) -> TreeResult<Self> {
        let mut words = text.split_whitespace();
        let mut word = |what: &str| {
            words.next().ok_or_else(|| {
                TreeError::at(
                    number,
                    format!("the line ends before {what}; expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS…"),
                )
            })
        };
        let (id, model) = (word("the id")?, word("the model")?);
        let size_px = [count(number, word("the width")?)?, count(number, word("the height")?)?];
        let parameters = words.map(|word| finite(number, word)).collect::<TreeResult<_>>()?;
        Ok(Self { number, id: id.into(), model, size_px, parameters })
    }

    fn read_binary(rest: &mut &[u8]) -> TreeResult<Self> {
        let id = next(rest).map(u32::from_le_bytes)?;
        let number = next(rest).map(i32::from_le_bytes)?;
        let unknown = || {
            TreeError::coded(
                ErrorCode::UnsupportedFile,
                0,
                format!(
                    "camera {id} has the model number {number}; expected 0 to {}, those of COLMAP 4",
                    NUMBERED.len() - 1
                ),
            )
        };
        let model = usize::try_from(number).ok().and_then(|number| NUMBERED.get(number)).ok_or_else(unknown)?;
        let size_px = [count(0, &integer(rest)?.to_string())?, count(0, &integer(rest)?.to_string())?];
        let parameter = |_| finite(0, &next(rest).map(f64::from_le_bytes)?.to_string());
        let parameters = (0..parameter_count(model).unwrap_or_default()).map(parameter).collect::<TreeResult<_>>()?;
        Ok(Self { number: 0, id: id.to_string().into(), model, size_px, parameters })
    }

    fn camera(&self) -> TreeResult<(Model, CameraMatrix)> {
        let Some(count) = parameter_count(self.model) else {
            let all = ONE_FOCAL.iter().chain(&TWO_FOCALS).chain([&PANORAMA]);
            let known = all.map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
            return Err(TreeError::coded(
                ErrorCode::UnsupportedFile,
                self.number,
                format!("unknown camera model {}; expected one of {known}", self.model),
            ));
        };
        if self.parameters.len() != count {
            let what =
                format!("the number of parameters is {}; the model {} has {count}", self.parameters.len(), self.model);
            return Err(TreeError::at(self.number, what));
        }
        let (matrix, k) = self.matrix();
        Ok((model(self.model, k).map_err(invalid_model(self.number))?, matrix))
    }

    /// The camera matrix and the coefficients after it.
    fn matrix(&self) -> (CameraMatrix, &[f64]) {
        let p = &self.parameters;
        let camera_matrix = |fx, fy, cx, cy| CameraMatrix { fx, fy, skew: 0.0, cx, cy };
        if self.model == PANORAMA.0 {
            return (camera_matrix(p[0] / TAU, p[1] / PI, 0.5 * p[0], 0.5 * p[1]), &[]);
        }
        if ONE_FOCAL.iter().any(|(name, _)| *name == self.model) {
            return (camera_matrix(p[0], p[0], p[1], p[2]), &p[3..]);
        }
        (camera_matrix(p[0], p[1], p[2], p[3]), &p[4..])
    }
}

/// The model of the coefficients after the camera matrix, whose number the tables state.
fn model(name: &str, k: &[f64]) -> Result<Model, ModelError> {
    match (name, k) {
        ("THIN_PRISM_FISHEYE", &[k1, k2, p1, p2, k3, k4, sx1, sy1]) => {
            let (numerator, prism) = ([k1, k2, k3, k4], [sx1, 0.0, sy1, 0.0]);
            thin_prism(&[], DistortionTerms { numerator, tangential: [p1, p2], prism, ..Default::default() })
        }
        // The first tangential coefficient belongs to x here, as OpenCV's second does.
        ("RAD_TAN_THIN_PRISM_FISHEYE", &[.., p0, p1, s0, s1, s2, s3]) => {
            let prism = [s0, s1, s2, s3];
            thin_prism(&k[..6], DistortionTerms { tangential: [p1, p0], prism, ..Default::default() })
        }
        ("EQUIRECTANGULAR", _) => Ok(Model::Panorama(Panorama::Equirectangular)),
        ("FOV", [omega]) => FieldOfView::new(*omega).map(Model::FieldOfView),
        ("SIMPLE_DIVISION" | "DIVISION", [k]) => Division::new(*k).map(Model::Division),
        ("EUCM", [alpha, beta]) => ExtendedUnified::new(*alpha, *beta).map(Model::ExtendedUnified),
        (name, k) if name.ends_with("FISHEYE") => fisheye(k).map(Model::KannalaBrandt),
        ("SIMPLE_RADIAL", [k1]) => Perspective::from_opencv(&[*k1, 0.0, 0.0, 0.0]).map(Model::Perspective),
        ("RADIAL", [k1, k2]) => Perspective::from_opencv(&[*k1, *k2, 0.0, 0.0]).map(Model::Perspective),
        (_, k) => Perspective::from_opencv(k).map(Model::Perspective),
    }
}

fn fisheye(k: &[f64]) -> Result<KannalaBrandt, ModelError> {
    let mut six = [0.0; 6];
    six[..k.len()].copy_from_slice(k);
    KannalaBrandt::long(six)
}

fn thin_prism(k: &[f64], terms: DistortionTerms) -> Result<Model, ModelError> {
    ThinPrismFisheye::new(fisheye(k)?, terms).map(Model::ThinPrismFisheye)
}

fn count(line: usize, word: &str) -> TreeResult<usize> {
    let count = word.parse::<usize>().ok().filter(|n| (1..=1_000_000).contains(n));
    count.ok_or_else(|| TreeError::at(line, format!("found \"{word}\"; expected a number of pixels of at least 1")))
}

fn finite(line: usize, word: &str) -> TreeResult<f64> {
    let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
    number.ok_or_else(|| TreeError::at(line, format!("found \"{word}\"; expected a finite number")))
}
