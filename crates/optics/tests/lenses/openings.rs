//! Light that reaches a sensor point through several openings of a lens is included in its étendue and in its samples.

use etendue_optics::prescription::trace::LensRay;
use etendue_optics::prescription::{Focus, Surface};
use etendue_optics::{Lens, Prescription, PrescriptionLens, PrescriptionParameters};
use etendue_spectra::glass::Dispersion;
use glam::{DVec2, DVec3};

const NM: f64 = 587.56;

fn lens(surfaces: Vec<Surface>, back_focus_mm: f64, radius_mm: f64) -> Lens {
    let focus = Focus::Fixed { back_focus_mm };
    let parameters = PrescriptionParameters::new(surfaces, focus);
    Lens::prescription(
        PrescriptionLens::new(Prescription::new(parameters).expect("a lens"), None, radius_mm).expect("lit"),
    )
}

/// A singlet far behind its stop, with so much spherical aberration that light through its edge reaches the stop again: a sensor point sees a ring of
/// light about the pupil, or parts of one.
fn folded(stop_mm: f64) -> Lens {
    let glass = Dispersion::Constant { n: 1.5168 };
    let surfaces = vec![
        Surface::stop(stop_mm, 0.8),
        Surface::sphere(12.0, 4.0, glass, 5.6),
        Surface::sphere(-9.5, 0.0, Dispersion::AIR, 5.6),
    ];
    lens(surfaces, 9.7, 3.0)
}

/// ∫ τ cos⁴ θ dt over a fine grid of all slopes at which the last surface can be reached, and the number of open parts of its middle row.
fn counted(lens: &Lens, s_mm: f64, side: usize) -> (f64, usize) {
    let Lens::Prescription(prescribed) = lens else { panic!("a prescription") };
    let lens = prescribed.prescription();
    let last = lens.surfaces().last().expect("a surface");
    let back_mm = lens.sensor_position_mm() - lens.last_vertex_mm();
    let reach = last.semi_aperture_mm / back_mm * 1.3;
    let from = DVec3::new(s_mm, 0.0, lens.sensor_position_mm());
    let step = 2.0 * reach / side as f64;
    let weight = |x: f64, y: f64| {
        let t = DVec2::new(x - s_mm / back_mm, y);
        let secant2 = 1.0 + t.length_squared();
        let ray = LensRay { point: from, direction: DVec3::new(t.x, t.y, -1.0) / secant2.sqrt() };
        lens.to_scene(ray, NM).map_or(0.0, |(_, transmittance)| transmittance / (secant2 * secant2))
    };
    let at = |i: usize| -reach + step * (i as f64 + 0.5);
    let row: Vec<bool> = (0..side).map(|i| weight(at(i), 0.0) > 0.0).collect();
    let parts = row.windows(2).filter(|w| !w[0] && w[1]).count() + usize::from(row[0]);
    // Symmetric about the meridional plane.
    let sum: f64 =
        (side / 2..side).flat_map(|j| (0..side).map(move |i| (i, j))).map(|(i, j)| weight(at(i), at(j))).sum();
    (2.0 * sum * step * step, parts)
}

/// The mean weight of a render's samples.
fn sampled(lens: &Lens, s_mm: f64) -> f64 {
    const COUNT: u32 = 200_000;
    let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
    let points = (0..COUNT).map(|i| (step * f64::from(i) + 0.5).fract());
    let rays = points.filter_map(|pupil| lens.ray(DVec2::new(s_mm, 0.0), pupil, NM));
    rays.map(|ray| ray.weight_sr).sum::<f64>() / f64::from(COUNT)
}

#[test]
fn etendue_and_samples_hold_every_opening() {
    for stop_mm in [15.0, 25.0] {
        let lens = folded(stop_mm);
        for (s_mm, openings) in [(0.0, 3), (0.4, 3), (0.8, 2), (1.0, 2), (1.2, 2)] {
            let (exact, parts) = counted(&lens, s_mm, 1600);
            assert_eq!(parts, openings, "parts of the meridian");
            let message = format!("stop at {stop_mm} mm, {s_mm} mm from the axis: {exact} sr");
            // The grid counts a thin ring to about 1e-3, samples scatter by 2e-3.
            let projected_solid_angle_sr = lens.projected_solid_angle_sr(DVec2::new(s_mm, 0.0));
            assert!(
                (projected_solid_angle_sr / exact - 1.0).abs() < 2e-3,
                "{message}, étendue {projected_solid_angle_sr}"
            );
            let sampled_sr = sampled(&lens, s_mm);
            assert!((sampled_sr / exact - 1.0).abs() < 6e-3, "{message}, samples {sampled_sr}");
        }
    }
}

#[test]
fn relative_illumination_is_that_of_all_openings() {
    let lens = folded(25.0);
    let Lens::Prescription(prescribed) = &lens else { panic!("a prescription") };
    let report = prescribed.report(4);
    let axis_sr = counted(&lens, 0.0, 1600).0;
    for field in &report.fields[..3] {
        let exact = counted(&lens, field.height_mm, 1600).0 / axis_sr;
        assert!((field.relative_illumination - exact).abs() < 2e-3, "{field:?} for {exact}");
    }
}
