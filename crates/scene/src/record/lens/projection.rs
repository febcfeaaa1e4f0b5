//! Viewing directions of a calibrated camera's pixels: a projection with its parameters, or a calibration file.

use std::path::PathBuf;

use super::distortion::Direction;
use crate::asset::{CalibrationChoice, CalibrationFormat};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, exactly, keyed, list, number, path, record, text, variants, words};

record! {
    /// A calibration file.
    pub struct CalibrationFile {
        /// The file.
        required file: Placed<PathBuf> = path(&["yaml", "yml", "json", "xml", "txt", "ini", "bin"]);
        /// Program of the file.
        required format: Placed<CalibrationFormat> = choice();
        /// Camera within the file. Default: the only one.
        optional camera: Placed<String> = text("the name of a camera");
    }
}

impl CalibrationFile {
    /// Returns the camera of the file that is used.
    #[must_use]
    pub fn camera_in_file(&self) -> CalibrationChoice {
        CalibrationChoice { format: self.format.value, camera: self.camera.as_ref().map(|c| c.value.clone()) }
    }
}

variants! {
    /// Viewing direction of a raster point. Points of the normalised image plane become pixels by (fx x + skew y + cx, fy y + cy), in raster
    /// coordinates: pixel centres are at + 0.5.
    pub enum Projection by "type" {
        /// Perspective with OpenCV's distortion.
        "opencv" => OpenCv(OpenCv),
        /// Perspective with r′ = r (1 + k1 r² + k2 r⁴), r in focal lengths.
        "radial" => Radial(Radial),
        /// Fitzgibbon's division model, tan θ = r/(1 + k r²).
        "division" => Division(Division),
        /// The FOV model, r = atan(2 tan θ tan(ω/2))/ω.
        "field_of_view" => FieldOfView(FieldOfView),
        /// OpenCV's fisheye: r = θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸).
        "kannala_brandt" => KannalaBrandt(KannalaBrandt),
        /// A fisheye with tangential and thin-prism terms: r = θ (1 + k1 θ² + …), then the terms in that plane.
        "thin_prism_fisheye" => ThinPrismFisheye(Box<ThinPrismFisheye>),
        /// Mei's unified model: a sphere, a shifted centre ξ, then OpenCV's distortion.
        "unified" => Unified(Unified),
        /// The extended unified model.
        "extended_unified" => ExtendedUnified(ExtendedUnified),
        /// Two spheres.
        "double_sphere" => DoubleSphere(DoubleSphere),
        /// Scaramuzza's polynomial, in pixels.
        "ocam" => Ocam(Ocam),
        /// A polynomial between field angle (rad) and radius, in pixels.
        "f_theta" => FTheta(FTheta),
        /// A table of radii over field angles, given here or from Zemax's "Field Curvature/Distortion".
        "table" => Table(Table),
        /// r = θ: up to 360°.
        "equidistant" => Equidistant(ScaledProjection),
        /// r = 2 sin(θ/2): up to 360°.
        "equisolid" => Equisolid(ScaledProjection),
        /// r = 2 tan(θ/2): below 360°.
        "stereographic" => Stereographic(ScaledProjection),
        /// r = sin θ: up to 180°.
        "orthographic" => Orthographic(ScaledProjection),
        /// r = tan θ: below 180°.
        "rectilinear" => Rectilinear(ScaledProjection),
        /// x = azimuth, y = tan of the elevation: up to 360° about the camera's y axis.
        "cylindrical" => Cylindrical(ScaledProjection),
        /// x = azimuth, y = elevation: the whole sphere.
        "equirectangular" => Equirectangular(ScaledProjection),
    }
}

record! {
    /// A projection without parameters of its own.
    pub struct ScaledProjection {
        /// Its scale.
        inside matrix: Matrix;
    }
}

record! {
    /// The camera matrix.
    pub struct Matrix {
        /// Length of the unit of the normalised plane.
        inside scale: Scale;
        /// fy. Default: fx_px.
        optional fy_px: Placed<f64> = number("px").above(0.0);
        /// Shift right per step down. Default: 0.
        optional skew_px: Placed<f64> = number("px");
        /// The principal point.
        inside centre: Centre;
    }
}

keyed! {
    /// The unit of the normalised plane on the sensor.
    pub enum Scale {
        /// fx.
        fx_px => Columns(Placed<f64>) = number("px").above(0.0);
        /// Focal length without distortion.
        focal_length_mm => Millimetres(Placed<f64>) = number("mm").above(0.0);
        /// Horizontal field of view, centred.
        field_of_view_deg => FieldOfView(Placed<f64>) = number("degrees").above(0.0).at_most(360.0);
    }
}

record! {
    /// The principal point.
    pub struct Centre {
        /// Principal-point column (OpenCV plus 0.5). Default: "principal_point_px".
        optional cx_px: Placed<f64> = number("px");
        /// Principal-point row; see "cx_px".
        optional cy_px: Placed<f64> = number("px");
    }
}

record! {
    /// OpenCV's perspective camera.
    pub struct OpenCv {
        /// Camera matrix.
        inside matrix: Matrix;
        /// distCoeffs in OpenCV's order, 4, 5, 8, 12 or 14.
        optional distortion: Vec<Placed<f64>> = list(number(""), 1);
    }
}

record! {
    /// The radial polynomial.
    pub struct Radial {
        /// Camera matrix.
        inside matrix: Matrix;
        /// Coefficient of r².
        required k1: Placed<f64> = number("");
        /// Coefficient of r⁴. Default: 0.
        optional k2: Placed<f64> = number("");
        /// Direction of the mapping from r to r′.
        required direction: Placed<Direction> = choice();
    }
}

record! {
    /// The division model.
    pub struct Division {
        /// Camera matrix.
        inside matrix: Matrix;
        /// k, per square of the focal length.
        required k: Placed<f64> = number("");
    }
}

record! {
    /// The FOV model.
    pub struct FieldOfView {
        /// Camera matrix.
        inside matrix: Matrix;
        /// ω, between 0 and π.
        required omega_rad: Placed<f64> = number("rad").above(0.0);
    }
}

record! {
    /// The polynomial fisheye.
    pub struct KannalaBrandt {
        /// Camera matrix.
        inside matrix: Matrix;
        /// k1, k2, k3, k4.
        required k: Placed<[Placed<f64>; 4]> = exactly(number(""));
    }
}

record! {
    /// The fisheye with tangential and thin-prism terms.
    pub struct ThinPrismFisheye {
        /// Camera matrix.
        inside matrix: Matrix;
        /// k1 … k6 of the angle's polynomial (COLMAP RAD_TAN_THIN_PRISM_FISHEYE, Aria Fisheye624). Default: 0.
        optional k: Placed<[Placed<f64>; 6]> = exactly(number(""));
        /// Radial k1 … k4 in the fisheye plane, before p and s (COLMAP THIN_PRISM_FISHEYE). Default: 0.
        optional plane_k: Placed<[Placed<f64>; 4]> = exactly(number(""));
        /// p1, p2 (OpenCV). Default: 0.
        optional p: Placed<[Placed<f64>; 2]> = exactly(number(""));
        /// s1, s2 (x, by r² and r⁴), s3, s4 (y). Default: 0.
        optional s: Placed<[Placed<f64>; 4]> = exactly(number(""));
    }
}

record! {
    /// The unified model.
    pub struct Unified {
        /// Camera matrix.
        inside matrix: Matrix;
        /// ξ.
        required xi: Placed<f64> = number("").at_least(0.0);
        /// k1, k2, p1, p2.
        optional distortion: Placed<[Placed<f64>; 4]> = exactly(number(""));
    }
}

record! {
    /// The extended unified model.
    pub struct ExtendedUnified {
        /// Camera matrix.
        inside matrix: Matrix;
        /// α.
        required alpha: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// β.
        required beta: Placed<f64> = number("").above(0.0);
    }
}

record! {
    /// The double sphere.
    pub struct DoubleSphere {
        /// Camera matrix.
        inside matrix: Matrix;
        /// ξ, between −1 and 1.
        required xi: Placed<f64> = number("");
        /// α.
        required alpha: Placed<f64> = number("").at_least(0.0).at_most(1.0);
    }
}

record! {
    /// The affine map x′ = x + e y, y′ = d x + c y of the polynomials in pixels.
    pub struct AffineMap {
        /// Scale of the rows. Default: 1.
        optional c: Placed<f64> = number("");
        /// Shift down per step to the right. Default: 0.
        optional d: Placed<f64> = number("");
        /// Shift to the right per step down. Default: 0.
        optional e: Placed<f64> = number("");
    }
}

record! {
    /// Scaramuzza's model.
    pub struct Ocam {
        /// Principal point.
        inside centre: Centre;
        /// a₀ (negative), a₁, a₂ …, in px to the power 1 − i.
        required polynomial: Vec<Placed<f64>> = list(number(""), 1);
        /// The affine map.
        inside stretch: AffineMap;
    }
}

record! {
    /// The f-theta polynomial.
    pub struct FTheta {
        /// Principal point.
        inside centre: Centre;
        /// c₁, c₂, … (there is no c₀).
        required polynomial: Vec<Placed<f64>> = list(number(""), 1);
        /// Direction of the mapping.
        required maps: Placed<FThetaSense> = choice();
        /// Largest field angle of the polynomial.
        required greatest_angle_deg: Placed<f64> = number("degrees").above(0.0).at_most(180.0);
        /// The affine map.
        inside stretch: AffineMap;
    }
}

words! {
    /// Direction of an f-theta polynomial.
    pub enum FThetaSense {
        /// From the field angle, rad, to the radius, px.
        "angle_to_radius" => AngleToRadius,
        /// From the radius, px, to the field angle, rad.
        "radius_to_angle" => RadiusToAngle,
    }
}

record! {
    /// A projection by a table, symmetrical about the axis: a smooth curve through its points; nothing is seen beyond them.
    pub struct Table check(check_table) {
        /// Principal point.
        inside centre: Centre;
        /// Source of the points.
        inside source: TableSource;
        /// With "angle_deg": increasing radii on the sensor.
        optional radius_mm: Vec<Placed<f64>> = list(number("mm").above(0.0), 2);
        /// With "file": focal length of its distortion. Default: the file's.
        optional focal_length_mm: Placed<f64> = number("mm").above(0.0);
    }
}

keyed! {
    /// Source of a projection table.
    pub enum TableSource {
        /// Zemax "Field Curvature/Distortion" text, fields in degrees.
        file => File(Placed<PathBuf>) = path(&["txt"]);
        /// Increasing field angles, without the axis.
        angle_deg => Angles(Vec<Placed<f64>>) = list(number("degrees").above(0.0).at_most(180.0), 2);
    }
}

fn check_table(table: &Table, errors: &mut DescriptionErrors) {
    match (&table.source, &table.radius_mm, &table.focal_length_mm) {
        (TableSource::File(_), Some(radii), _) => {
            let place = radii.first().map_or(&table.place, |first| &first.place);
            errors.add(
                ErrorCode::NoEffect,
                place,
                "\"radius_mm\" has no effect here, it belongs to \"angle_deg\"",
                "remove it",
            );
        }
        (TableSource::Angles(_), None, _) => {
            errors.add(
                ErrorCode::MissingKey,
                &table.place,
                "the key \"radius_mm\" is missing",
                "add \"radius_mm\", one for each angle",
            );
        }
        (TableSource::Angles(_), _, Some(focal_length)) => {
            let problem = "\"focal_length_mm\" has no effect here, it belongs to \"file\"";
            errors.add(ErrorCode::NoEffect, &focal_length.place, problem, "remove it");
        }
        (TableSource::Angles(angles), Some(radii), None) if angles.len() != radii.len() => {
            let problem = format!("the numbers of angles ({}) and radii ({}) differ", angles.len(), radii.len());
            errors.add(ErrorCode::WrongCount, &table.place, problem, "give equal numbers");
        }
        _ => {}
    }
}
