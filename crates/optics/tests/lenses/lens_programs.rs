//! The published prescriptions compared with optiland and rayoptics (tests/oracles/lenses.py, ghosts.py).

use etendue_optics::prescription::coating::Coating;
use etendue_optics::prescription::ghost::GhostPair;
use etendue_optics::prescription::surface::Surface;
use etendue_optics::prescription::trace::LensRay;
use etendue_optics::prescription::{Focus, published};
use etendue_optics::{Lens, Prescription, PrescriptionLens, PrescriptionParameters};
use etendue_spectra::glass;
use glam::{DVec2, DVec3};
use serde_json::Value;

const FIGURES: &str = include_str!("../../../../tests/oracles/figures/lenses.json");
const ASPHERIC: &str = include_str!("../../../../tests/oracles/figures/aspheric.json");
const GHOSTS: &str = include_str!("../../../../tests/oracles/figures/ghosts.json");

fn figures() -> Value {
    serde_json::from_str(FIGURES).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_slice(&list(value))
}

fn published_lenses(figures: &Value) -> impl Iterator<Item = (&Value, Prescription)> {
    figures["lenses"].as_array().expect("lenses").iter().map(|lens| {
        let published = published::named(lens["name"].as_str().expect("a name")).expect("a published lens");
        let clear = |s: Surface| Surface { coating: Coating::Constant(1.0), ..s };
        let surfaces = published.surfaces().into_iter().map(clear).collect();
        let focus = Focus::Fixed { back_focus_mm: number(&lens["back_mm"]) };
        let parameters = PrescriptionParameters::new(surfaces, focus);
        (lens, Prescription::new(parameters).expect("a lens"))
    })
}

#[test]
fn paraxial_quantities_agree() {
    for (figures, lens) in published_lenses(&figures()) {
        for row in figures["paraxial"].as_array().expect("rows") {
            let p = lens.paraxial_at(number(&row["nm"]));
            let to_image = number(&figures["back_mm"]);
            let own = |key: &str| match key {
                "focal_length_mm" => p.focal_length_mm,
                "back_focus_mm" => p.back_focus_mm,
                "front_focus_mm" => p.front_focus_mm,
                "entrance_pupil_mm" => p.entrance_pupil_position_mm,
                "entrance_diameter_mm" => 2.0 * p.entrance_radius_mm,
                "exit_diameter_mm" => 2.0 * p.exit_radius_mm,
                "exit_pupil_from_image_mm" => p.exit_pupil_position_mm - to_image,
                other => panic!("{other}"),
            };
            for program in ["optiland", "rayoptics"] {
                for (key, value) in row[program].as_object().expect("figures") {
                    let relative = own(key) / number(value) - 1.0;
                    assert!(relative.abs() < 1e-5, "{} {program} {key}: {} {value}", figures["name"], own(key));
                }
            }
        }
    }
}

#[test]
fn real_rays_agree() {
    for (figures, lens) in published_lenses(&figures()) {
        let mut compared = 0;
        for row in figures["rays"].as_array().expect("rays") {
            let ray = LensRay { point: vector(&row["point_mm"]), direction: vector(&row["direction"]).normalize() };
            // The programs ignored clear apertures: clipped rays have no counterpart.
            let Ok((out, _)) = lens.to_sensor(ray, number(&row["nm"])) else { continue };
            let at = out.point + out.direction * ((lens.sensor_position_mm() - out.point.z) / out.direction.z);
            compared += 1;
            for program in ["optiland", "rayoptics"] {
                let [image, direction] = ["image_mm", "direction"].map(|key| list(&row[program][key]));
                let miss = at.truncate() - DVec2::from_slice(&image);
                assert!(miss.length() < 1e-6, "{} {program} {miss} {row}", figures["name"]);
                assert!(
                    (out.direction - DVec3::from_slice(&direction)).length() < 1e-7,
                    "{} {program}",
                    figures["name"]
                );
            }
        }
        assert!(compared >= 20, "{}: {compared} rays", figures["name"]);
    }
}

/// Checks that a ray's end behind the last surface agrees with both programs' to 1e-6 mm.
fn agrees(lens: &Prescription, out: LensRay, row: &Value) {
    let at = out.point + out.direction * ((lens.sensor_position_mm() - out.point.z) / out.direction.z);
    for program in ["optiland", "rayoptics"] {
        let [image, direction] = ["image_mm", "direction"].map(|key| list(&row[program][key]));
        let miss = at.truncate() - DVec2::from_slice(&image);
        assert!(miss.length() < 1e-6, "{program} {miss} {row}");
        assert!((out.direction - DVec3::from_slice(&direction)).length() < 1e-7, "{program} {row}");
    }
}

/// An aspheric surface of the reference data.
fn aspheric_surface(row: &Value, stop: bool) -> Surface {
    let glass = match &row["glass"] {
        Value::Null => glass::Dispersion::AIR,
        of_abbe => glass::Dispersion::from_abbe(number(&of_abbe[0]), number(&of_abbe[1])).expect("a glass"),
    };
    let radius_mm = row["radius_mm"].as_f64().unwrap_or(f64::INFINITY);
    let plain = Surface::sphere(radius_mm, number(&row["thickness_mm"]), glass, number(&row["semi_aperture_mm"]));
    let mut surface = Surface { conic: number(&row["conic"]), stop, ..plain };
    let terms = list(&row["terms"]);
    surface.asphere[1..=terms.len()].copy_from_slice(&terms);
    surface
}

#[test]
fn rays_through_aspheres_agree() {
    let figures: Value = serde_json::from_str(ASPHERIC).expect("JSON");
    let rows = figures["surfaces"].as_array().expect("surfaces");
    let surfaces = rows.iter().enumerate().map(|(i, row)| aspheric_surface(row, i == 0)).collect();
    let focus = Focus::Fixed { back_focus_mm: number(&figures["back_mm"]) };
    let parameters = PrescriptionParameters::new(surfaces, focus);
    let lens = Prescription::new(parameters).expect("a lens");
    let mut compared = 0;
    for row in figures["rays"].as_array().expect("rays") {
        let ray = LensRay { point: vector(&row["point_mm"]), direction: vector(&row["direction"]).normalize() };
        let Ok((out, _)) = lens.to_sensor(ray, number(&row["nm"])) else { continue };
        agrees(&lens, out, row);
        compared += 1;
    }
    assert!(compared >= 70, "{compared} rays");
}

#[test]
fn ghosts_agree() {
    let figures: Value = serde_json::from_str(GHOSTS).expect("JSON");
    let published = published::named(figures["lens"].as_str().expect("a name")).expect("a published lens");
    let focus = Focus::Fixed { back_focus_mm: number(&figures["back_mm"]) };
    let parameters = PrescriptionParameters::new(published.surfaces(), focus);
    let lens = Prescription::new(parameters).expect("a lens");
    for row in figures["rays"].as_array().expect("rays") {
        let [front, rear] = ["front", "rear"].map(|key| row[key].as_u64().expect("a surface") as usize);
        let ray = LensRay { point: vector(&row["point_mm"]), direction: vector(&row["direction"]).normalize() };
        let ghost = lens.ghost(GhostPair { front, rear }, ray, number(&row["nm"])).expect("through");
        agrees(&lens, ghost.ray, row);
    }
}

#[test]
fn relative_illumination_agrees() {
    for (figures, lens) in published_lenses(&figures()) {
        let illumination = &figures["illumination"];
        let heights = list(&illumination["heights_mm"]);
        let lens =
            Lens::prescription(PrescriptionLens::new(lens, None, heights[heights.len() - 1] * 1.05).expect("lit"));
        let axis = lens.projected_solid_angle_sr(DVec2::ZERO);
        let (relative, absolute) = (list(&illumination["relative"]), list(&illumination["projected_sr"]));
        for ((height, relative), absolute) in heights.iter().zip(relative).zip(absolute) {
            let own = lens.projected_solid_angle_sr(DVec2::new(0.0, -height));
            assert!(
                (own / axis / relative - 1.0).abs() < 5e-3,
                "{} {height}: {} {relative}",
                figures["name"],
                own / axis
            );
            assert!((own / absolute - 1.0).abs() < 5e-3, "{} {height}: {own} {absolute}", figures["name"]);
        }
    }
}

#[test]
fn catalogue_indices_agree() {
    for row in figures()["catalogue"].as_array().expect("rows") {
        let glass = glass::by_name(row["glass"].as_str().expect("a name")).expect("in the catalogue");
        let own = glass.dispersion.index(number(&row["nm"]));
        for program in ["optiland", "opticalglass"] {
            assert!((own - number(&row[program])).abs() < 2e-6, "{row}: {own}");
        }
    }
}
