//! Sheets are partitions: the areas of the pieces add up to the sheet, no point is covered twice, and no corner is within another
//! piece's edge.

use etendue_charts::design::{
    Backlit, Checkerboard, Circles, ColorChecker, ContrastPatches, DeadLeaves, DepthWedge, Dots, Flare, FlatField,
    GridSize, LedFlicker, OecfSteps, Points, SiemensStar, SlantedEdges, SlantedStar,
};
use etendue_charts::shape::{Sheet, area};
use etendue_charts::{Chart, Drawing, Footprint};
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use glam::DVec2;

fn test_footprint() -> Footprint {
    Footprint {
        distance_m: 2.0,
        outer_mm: DVec2::new(2300.0, 1840.0),
        inner_mm: DVec2::new(2000.0, 1600.0),
        pixel_mm: 1.8,
        fills: true,
    }
}

fn charts() -> Vec<Chart> {
    let size = GridSize::default();
    let few = GridSize { columns: Some(5), rows: Some(4), pitch_mm: None };
    vec![
        Chart::Dots(Dots { size: few, dot_ratio: 0.5 }),
        Chart::Checkerboard(Checkerboard { size }),
        Chart::Circles(Circles { size: few, asymmetric: false }),
        Chart::Circles(Circles { size, asymmetric: true }),
        Chart::FlatField(FlatField { reflectance: 0.9 }),
        Chart::Backlit(Backlit),
        Chart::SlantedEdges(SlantedEdges { size, angle_deg: 5.0, contrast: 4.0 }),
        Chart::SlantedEdges(SlantedEdges { size: few, angle_deg: -43.0, contrast: 40.0 }),
        Chart::SlantedStar(SlantedStar { size, spokes: 8, angle_deg: 5.0, contrast: 4.0 }),
        Chart::SiemensStar(SiemensStar { cycles: 36, binary: false }),
        Chart::SiemensStar(SiemensStar { cycles: 12, binary: true }),
        Chart::DeadLeaves(DeadLeaves { smallest_px: 20.0, largest_ratio: 0.2 }),
        Chart::OecfSteps(OecfSteps { steps: 12, density: 2.0, backlit: false }),
        Chart::OecfSteps(OecfSteps { steps: 20, density: 3.0, backlit: true }),
        Chart::ColorChecker(ColorChecker),
        Chart::ContrastPatches(ContrastPatches { size, decades: 3.0 }),
        Chart::Flare(Flare { size, trap_ratio: 0.25 }),
        Chart::LedFlicker(LedFlicker { frequencies_hz: vec![90.0, 200.0, 411.0], duty_cycles: vec![0.1, 0.5] }),
        Chart::Points(Points { size: few, diameter_px: 0.5 }),
        Chart::DepthWedge(DepthWedge { steps: 5, far_ratio: 3.0 }),
    ]
}

fn drawings() -> Vec<(&'static str, Drawing)> {
    charts().iter().map(|chart| (chart.name(), chart.draw(&test_footprint(), 1).expect("a legal chart"))).collect()
}

fn sheets(drawing: &Drawing) -> impl Iterator<Item = &Sheet> {
    drawing.panels.iter().map(|panel| &panel.sheet)
}

#[test]
fn areas_add_up() {
    for (name, drawing) in drawings() {
        for sheet in sheets(&drawing) {
            let areas: Vec<f64> = sheet.pieces.iter().map(|piece| area(&piece.outline)).collect();
            let sheet_area = sheet.size_mm.element_product();
            assert!(areas.iter().all(|a| *a > 0.0), "{name}: a piece is turned over or empty");
            // Sums of a few thousand areas round to 1e-12.
            assert!((areas.iter().sum::<f64>() / sheet_area - 1.0).abs() < 1e-9, "{name}");
        }
    }
}

/// Depth of a point inside a convex outline: its minimum distance from an edge, negative outside.
fn depth(outline: &[DVec2], point: DVec2) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let inside = |(a, b): (&DVec2, &DVec2)| (*b - *a).normalize().perp_dot(point - *a);
    outline.iter().zip(next).map(inside).fold(f64::INFINITY, f64::min)
}

#[test]
fn no_point_is_covered_twice_or_left_out() {
    let mut random = NoiseStream::new(1, 0, 0, 0, Pixel { x: 0, y: 0 }, NoiseDraw::Shot);
    for (name, drawing) in drawings() {
        for sheet in sheets(&drawing) {
            for _ in 0..200 {
                let at = (DVec2::new(random.unit_f64(), random.unit_f64()) - 0.5) * sheet.size_mm;
                let depths = sheet.pieces.iter().map(|piece| depth(&piece.outline, at));
                let (mut within, mut near) = (0, false);
                depths.for_each(|d| {
                    within += usize::from(d > 0.0);
                    near |= d.abs() < 1e-9;
                });
                assert!(within == 1 || near, "{name}: {at} lies in {within} pieces");
            }
        }
    }
}

#[test]
fn neighbours_share_their_corners() {
    for (name, drawing) in drawings() {
        for sheet in sheets(&drawing).filter(|sheet| sheet.pieces.len() < 4000) {
            let corners: Vec<DVec2> = sheet.pieces.iter().flat_map(|piece| piece.outline.iter().copied()).collect();
            for piece in &sheet.pieces {
                let next = piece.outline.iter().cycle().skip(1);
                for (a, b) in piece.outline.iter().zip(next) {
                    let (along, length) = ((*b - *a).normalize(), (*b - *a).length());
                    let splits = |c: &DVec2| {
                        let t = (*c - *a).dot(along);
                        t > 1e-9 * length && t < length * (1.0 - 1e-9) && along.perp_dot(*c - *a).abs() < 1e-9
                    };
                    assert!(!corners.iter().any(splits), "{name}: a corner lies within the edge {a} {b}");
                }
            }
        }
    }
}
