//! A lens that treats each wavelength differently keeps the spectrum of what it sees.

use etendue_tests::Job;
use glam::DVec2;

/// A uniform surround through a double Gauss with a filter whose edge is at 550 nm. A ray that was found for one wavelength
/// says nothing of the others: were they kept, bands beyond the edge would get the light of rays of shorter wavelengths.
#[test]
fn a_uniform_surround_keeps_its_spectrum_through_a_filter_and_glasses() {
    let shot = Job::new(
        r#"
        [scene]
        environment = { type = "uniform", radiance_w_m2_sr_nm = 1 }
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        sensor = { width_px = 4, height_px = 4, pixel_pitch_um = 3000 }
        [cameras.lens]
        type = "prescription"
        published = "double-gauss"
        focus_distance_m = "infinity"
        ir_cut = { edge_nm = 550, edge_width_nm = 2, effective_index = 1.8 }
        [render]
        spp = 4096
        replicates = 16
        wavelength_range_nm = [400, 700]
        band_width_nm = 50
        [output]
        irradiance = true
        "#,
    )
    .shot();
    let body = &shot.camera().body;
    let irradiance = shot.irradiance();
    let (mut worst, mut sum) = (0.0_f64, 0.0);
    for (pixel, band) in (0..16).flat_map(|pixel| (0..6).map(move |band| (pixel, band))) {
        let centre = DVec2::new(f64::from(pixel % 4) + 0.5, f64::from(pixel / 4) + 0.5);
        let expected = mean_weight(body, centre, 400.0 + 50.0 * f64::from(band));
        let at = (band * 16 + pixel) as usize;
        let actual = f64::from(irradiance.mean[at]);
        if band > 3 || expected == 0.0 {
            // The edge moves to the blue only.
            assert_eq!(actual, 0.0, "band {band} lies beyond the filter's edge");
        } else if band < 2 {
            let sigma = f64::from(irradiance.variance[at]).sqrt();
            // 32 estimates: 5 σ of 16 replicates; the midpoint rule over pixels, bands and pupil is good to 0.5 %.
            worst = worst.max(((actual - expected).abs() - 0.005 * expected) / sigma);
            sum += actual / expected;
        }
    }
    assert!(worst < 5.0, "{worst} σ");
    assert!((sum / 32.0 - 1.0).abs() < 0.01, "{}", sum / 32.0);
}

/// Mean weight of a pixel's rays in a band of 50 nm, by lattices over pixel, pupil and band.
fn mean_weight(body: &etendue_pipeline::plan::CameraBody, centre_px: DVec2, low_nm: f64) -> f64 {
    let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
    let count = 4000;
    let weight = |i: u32| {
        let u = (step * f64::from(i) + 0.5).fract();
        let offset = (DVec2::new(0.819_172_513_396_164, 0.671_043_606_703_789_2) * f64::from(i)).fract() - 0.5;
        let nm = low_nm + 50.0 * (0.549_700_477_901_970_6 * f64::from(i)).fract();
        let sensor_mm = body.raster.sensor_mm(centre_px + offset);
        body.lens.ray(sensor_mm, u, nm).map_or(0.0, |ray| ray.weight_sr)
    };
    (0..count).map(weight).sum::<f64>() / f64::from(count)
}
