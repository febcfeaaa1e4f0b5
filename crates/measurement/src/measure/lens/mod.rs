//! `measure lens`: properties of a lens, without rendering.

mod body;
mod ghosts;
mod request;

use std::fmt::Write as _;

use etendue_core::wavelength::{MAX_NM, MIN_NM};
use etendue_io::failure::{Error, ErrorCode, check_integer, check_number};
use etendue_optics::lens::{FieldReport, ImageReport, LensReport, OtherBundle};
use etendue_optics::{Lens, PRINCIPAL_NM, PrescriptionLens};
use etendue_pipeline::plan::CameraBody;
use glam::DVec2;
use serde_json::{Value, json};

use crate::report::fixed;

pub use request::LensRequest;

/// Properties of a lens: first order and by field height.
#[derive(Clone, Debug)]
pub struct LensMeasurement {
    body: CameraBody,
    remarks: Vec<String>,
    fields: usize,
    wavelength_nm: Option<f64>,
}

/// Measures a lens without rendering.
///
/// # Errors
/// If the camera or lens file cannot be used.
pub fn lens(request: &LensRequest) -> Result<LensMeasurement, Error> {
    check_integer("fields", request.fields, request::FIELDS)?;
    let wavelength_nm = request.wavelength_nm;
    if let Some(nm) = wavelength_nm {
        check_number("wavelength_nm", nm, MIN_NM..=MAX_NM, "nm")?;
    }
    let (body, remarks) = body::body(request)?;
    if wavelength_nm.is_some() && !matches!(body.lens, Lens::Prescription(_)) {
        let kind = body.lens.kind();
        return Err(Error::argument(
            "wavelength_nm",
            format!(
                "`wavelength_nm`: a lens without a prescription ({kind}) has first-order figures at one wavelength only; leave it out"
            ),
        ).with_code(ErrorCode::NoEffect));
    }
    Ok(LensMeasurement { body, remarks, fields: request.fields as usize, wavelength_nm })
}

impl LensMeasurement {
    /// The measurement as JSON; unknown or non-finite values are null.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut value = match &self.body.lens {
            Lens::Prescription(lens) => traced_json(lens, &self.report(lens)),
            _ => simple_json(&self.body, self.fields),
        };
        value["remarks"] = json!(self.remarks);
        value
    }

    fn report(&self, lens: &PrescriptionLens) -> LensReport {
        lens.report_at(self.fields, self.wavelength_nm.unwrap_or(lens.prescription().reference_nm()))
    }

    /// The measurement as readable tables.
    #[must_use]
    pub fn text(&self) -> String {
        let text = match &self.body.lens {
            Lens::Prescription(lens) => traced_text(lens, &self.report(lens)),
            _ => simple_text(&self.body, self.fields),
        };
        text + &remarks_text(&self.remarks)
    }
}

/// Notes that a plan would make on the camera; empty if none.
fn remarks_text(remarks: &[String]) -> String {
    let lines: String = remarks.iter().map(|remark| format!("  {remark}\n")).collect();
    if lines.is_empty() { lines } else { format!("\nremarks\n{lines}") }
}

fn traced_json(lens: &PrescriptionLens, r: &LensReport) -> Value {
    let p = &r.first_order;
    json!({
        "first_order_wavelength_nm": r.first_order_nm,
        "fields_wavelength_nm": PRINCIPAL_NM,
        "focal_length_mm": p.focal_length_mm,
        "f_number": r.f_number,
        "transmittance": r.transmittance,
        "focus_distance_m": finite(r.focus_distance_m),
        "magnification": r.magnification,
        "front_focus_from_first_vertex_mm": p.front_focus_mm,
        "back_focus_from_last_vertex_mm": p.back_focus_mm,
        "front_principal_from_first_vertex_mm": p.front_principal_mm,
        "rear_principal_from_last_vertex_mm": p.rear_principal_mm,
        "entrance_pupil_from_first_vertex_mm": p.entrance_pupil_position_mm,
        "entrance_pupil_diameter_mm": 2.0 * p.entrance_radius_mm,
        "obscured_ratio": lens.obscured_ratio(),
        "exit_pupil_from_last_vertex_mm": finite(p.exit_pupil_position_mm),
        "exit_pupil_diameter_mm": finite(2.0 * p.exit_radius_mm),
        "petzval_radius_mm": finite(p.petzval_radius_mm),
        "sensor_from_last_vertex_mm": r.sensor_mm,
        "field_of_view_deg": r.field_of_view_rad.map(f64::to_degrees),
        "axial_colour_f_mm": r.axial_colour_f_mm,
        "axial_colour_c_mm": r.axial_colour_c_mm,
        "fields": r.fields.iter().map(|field| field_json(lens, field)).collect::<Vec<_>>(),
    })
}

/// Returns `None` for infinity, which JSON cannot express.
fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

fn field_json(lens: &PrescriptionLens, field: &FieldReport) -> Value {
    let image = field.image.as_ref();
    let spot = image.and_then(|i| i.spot);
    let [lateral_f, lateral_c] = [image.and_then(|i| i.lateral_f), image.and_then(|i| i.lateral_c)];
    json!({
        "height_mm": field.height_mm,
        "relative_illumination": field.relative_illumination,
        "angle_deg": image.map(|i| i.angle_rad.to_degrees()),
        "distortion": image.and_then(|i| i.distortion),
        "equidistant_distortion": image.map(|i| i.equidistant_distortion),
        "tangential_focus_mm": image.map(|i| i.tangential_mm),
        "sagittal_focus_mm": image.map(|i| i.sagittal_mm),
        "spot_rms_mm": spot.map(|s| s.rms_mm),
        "spot_rms_error_mm": spot.map(|s| s.rms_error_mm),
        "spot_radius_mm": spot.map(|s| s.radius_mm),
        "spot_centroid_mm": spot.map(|s| s.centroid_mm),
        "spot_centroid_error_mm": spot.map(|s| s.centroid_error_mm),
        "lateral_colour_f_mm": lateral_f.map(|l| l.centroid_mm),
        "lateral_colour_f_error_mm": lateral_f.map(|l| l.centroid_error_mm),
        "lateral_colour_f_chief_mm": lateral_f.and_then(|l| l.chief_mm),
        "lateral_colour_c_mm": lateral_c.map(|l| l.centroid_mm),
        "lateral_colour_c_error_mm": lateral_c.map(|l| l.centroid_error_mm),
        "lateral_colour_c_chief_mm": lateral_c.and_then(|l| l.chief_mm),
        "other_bundles": image.map_or(&[][..], |i| &i.other_bundles).iter().map(bundle_json).collect::<Vec<_>>(),
        "ghosts": ghosts::json(lens, field.height_mm),
    })
}

fn bundle_json(bundle: &OtherBundle) -> Value {
    let spot = &bundle.spot;
    json!({
        "light": bundle.light,
        "spot_rms_mm": spot.rms_mm,
        "spot_rms_error_mm": spot.rms_error_mm,
        "spot_radius_mm": spot.radius_mm,
        "spot_centroid_mm": spot.centroid_mm,
        "spot_centroid_error_mm": spot.centroid_error_mm,
    })
}

fn traced_text(lens: &PrescriptionLens, r: &LensReport) -> String {
    let p = &r.first_order;
    let focus =
        if r.focus_distance_m.is_finite() { format!("{} m", r.focus_distance_m) } else { "infinity".to_owned() };
    let mm = |x: f64| fixed(x, 4);
    let mut text = String::new();
    let obscured = match lens.obscured_ratio() {
        0.0 => String::new(),
        ratio => format!(", the inner {ratio:.4} of it obscured"),
    };
    let mut line = |name: &str, value: String| {
        // Writing to a text does not fail.
        let _ = writeln!(text, "{name:<22} {value}");
    };
    line("first order at", format!("{} nm (fields at {PRINCIPAL_NM} nm)", r.first_order_nm));
    line("focal length", format!("{:.4} mm, f/{:.3}", p.focal_length_mm, r.f_number));
    line("transmittance", format!("{:.4} on the axis", r.transmittance));
    line(
        "focus",
        format!("{focus}, magnification {:.5}, sensor {:.4} mm behind the last vertex", r.magnification, r.sensor_mm),
    );
    line(
        "focal points",
        format!("{} mm from the first vertex, {} mm from the last", mm(p.front_focus_mm), mm(p.back_focus_mm)),
    );
    line("principal planes", format!("{} mm, {} mm", mm(p.front_principal_mm), mm(p.rear_principal_mm)));
    line(
        "entrance pupil",
        format!("{} mm, {:.4} mm across{obscured}", mm(p.entrance_pupil_position_mm), 2.0 * p.entrance_radius_mm),
    );
    line("exit pupil", format!("{} mm, {:.4} mm across", mm(p.exit_pupil_position_mm), 2.0 * p.exit_radius_mm));
    line("Petzval radius", format!("{:.3} mm", p.petzval_radius_mm));
    line("field of view", r.field_of_view_rad.map_or("unknown".to_owned(), |a| format!("{:.3}°", a.to_degrees())));
    line("axial colour", format!("F {} mm, C {} mm", mm(r.axial_colour_f_mm), mm(r.axial_colour_c_mm)));
    text += &fields_text(&r.fields);
    text += &bundles_text(&r.fields);
    text += &ghosts::text(lens, r.fields.iter().map(|field| field.height_mm));
    text
}

const FIELDS: &str = "\nheight   angle    distortion  light    spot rms         spot max  tangential  sagittal  colour of centroids  of chief rays\n\
     mm       deg      %           of axis  µm               µm        mm          mm        F, C µm              F, C µm\n";

fn fields_text(fields: &[FieldReport]) -> String {
    let rows: String = fields.iter().map(field_row).collect();
    let images = || fields.iter().filter_map(|field| field.image.as_ref());
    let spots = images().filter_map(|image| image.spot).map(|spot| spot.centroid_error_mm);
    let colours = images().flat_map(|image| [image.lateral_f, image.lateral_c]).flatten();
    let largest = |errors: &mut dyn Iterator<Item = f64>| errors.reduce(f64::max);
    let line = |name: &str, error: Option<f64>| error.map(|mm| format!("{name} to {} µm", error_um(mm)));
    let centroids = line("centroids of the d line", largest(&mut spots.into_iter()));
    let colours = line("colour of centroids", largest(&mut colours.map(|colour| colour.centroid_error_mm)));
    let lines: Vec<String> = centroids.into_iter().chain(colours).collect();
    if lines.is_empty() { format!("{FIELDS}{rows}") } else { format!("{FIELDS}{rows}{}\n", lines.join(", ")) }
}

/// An estimated error of a length in mm, in µm.
fn error_um(mm: f64) -> String {
    let um = 1000.0 * mm;
    if um < 1e-4 { "0.0001".to_owned() } else { format!("{um:.4}") }
}

fn field_row(field: &FieldReport) -> String {
    let (height, light) = (field.height_mm, field.relative_illumination);
    let Some(image) = &field.image else { return format!("{height:<8.3} –        –           {light:<8.4}\n") };
    let ImageReport { angle_rad, distortion, spot, lateral_f, lateral_c, .. } = image;
    let micrometres = |mm: Option<f64>| mm.map_or("–".to_owned(), |mm| fixed(1000.0 * mm, 2));
    let distortion = distortion.map_or("–".to_owned(), |d| fixed(100.0 * d, 3));
    let rms =
        spot.map_or("–".to_owned(), |s| format!("{} ± {}", fixed(1000.0 * s.rms_mm, 3), error_um(s.rms_error_mm)));
    let max_radius = micrometres(spot.map(|s| s.radius_mm));
    let pair = |f: Option<f64>, c: Option<f64>| format!("{} {}", micrometres(f), micrometres(c));
    let centroids = pair(lateral_f.map(|l| l.centroid_mm), lateral_c.map(|l| l.centroid_mm));
    let chiefs = pair(lateral_f.and_then(|l| l.chief_mm), lateral_c.and_then(|l| l.chief_mm));
    format!(
        "{height:<8.3} {:<8.3} {distortion:<11} {light:<8.4} {rms:<16} {max_radius:<9} {:<11} {:<9} {centroids:<20} {chiefs}\n",
        angle_rad.to_degrees(),
        fixed(image.tangential_mm, 4),
        fixed(image.sagittal_mm, 4),
    )
}

/// Fields whose light arrives in several bundles; empty if none.
fn bundles_text(fields: &[FieldReport]) -> String {
    let row = |field: &FieldReport, bundle: &OtherBundle| {
        let OtherBundle { light, spot } = bundle;
        let at = fixed(spot.centroid_mm, 4);
        format!("{:<8.3} {light:<9.4} {at:<9} {}\n", field.height_mm, fixed(1000.0 * spot.rms_mm, 2))
    };
    let others = |field: &FieldReport| field.image.as_ref().map_or_else(Vec::new, |image| image.other_bundles.clone());
    let rows: String = fields.iter().flat_map(|f| others(f).into_iter().map(move |bundle| row(f, &bundle))).collect();
    if rows.is_empty() {
        return rows;
    }
    format!(
        "\nfurther bundles: light of a field point that takes another path through the lens; it reaches the image at another \
         position\nheight   light     at        spot rms\nmm       of spot   mm        µm\n{rows}"
    )
}

/// Field points of a lens without a prescription: along the half diagonal of the image, from the principal point.
fn field_points(body: &CameraBody, fields: usize) -> Vec<(DVec2, f64)> {
    let edge = fields.max(2) - 1;
    let raster = &body.raster;
    let size = DVec2::new(raster.width() as f64, raster.height() as f64);
    let corner = raster.sensor_mm(size);
    (0..=edge).map(|i| corner * (i as f64 / edge as f64)).map(|at| (at, at.length())).collect()
}

/// Angle from the axis in degrees, distortion against c tan θ, illumination relative to the axis.
fn simple_field(lens: &Lens, at_mm: DVec2) -> (Option<f64>, Option<f64>, f64) {
    let angle = lens.angle_between_rad(DVec2::ZERO, at_mm).map(f64::to_degrees);
    let ideal = lens.tangent(at_mm).map(|t| t.length() * lens.principal_distance_mm());
    let distortion = ideal.filter(|r| r.is_finite() && *r > 0.0).map(|r| at_mm.length() / r - 1.0);
    (angle, distortion, lens.projected_solid_angle_sr(at_mm) / lens.projected_solid_angle_sr(DVec2::ZERO))
}

fn simple_json(body: &CameraBody, fields: usize) -> Value {
    let field = |(at, height): (DVec2, f64)| {
        let (angle_deg, distortion, light) = simple_field(&body.lens, at);
        json!({ "height_mm": height, "angle_deg": angle_deg, "distortion": distortion, "relative_illumination": light })
    };
    let rows: Vec<Value> = field_points(body, fields).into_iter().map(field).collect();
    json!({ "optics": etendue_plan_report::camera_facts::optics(body), "fields": rows })
}

fn simple_text(body: &CameraBody, fields: usize) -> String {
    let lens = &body.lens;
    let wavelength = lens.first_order_nm().map_or_else(String::new, |nm| format!(" at {nm} nm"));
    let mut text = format!(
        "{}, {:.4} mm, f/{:.3}{wavelength}, T {:.3}\nheight   angle    distortion  light\nmm       deg      %           of axis\n",
        lens.kind(),
        lens.focal_length_mm(),
        lens.f_number(),
        lens.t_number()
    );
    for (at, height) in field_points(body, fields) {
        let (angle, distortion, light) = simple_field(lens, at);
        let angle = angle.map_or("–".to_owned(), |a| format!("{a:.3}"));
        let distortion = distortion.map_or("–".to_owned(), |d| fixed(100.0 * d, 3));
        let _ = writeln!(text, "{height:<8.3} {angle:<8} {distortion:<11} {light:.4}");
    }
    text
}
