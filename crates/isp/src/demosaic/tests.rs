use super::*;
use crate::raw::Filter::{self, Blue, Clear, Green, Infrared, Red};
use crate::raw::Mosaic;

fn phases() -> [Mosaic; 4] {
    [[Red, Green, Green, Blue], [Green, Red, Blue, Green], [Green, Blue, Red, Green], [Blue, Green, Green, Red]]
        .map(|f| Mosaic::tile(2, 2, f.to_vec()).expect("Bayer"))
}

fn interpolated(method: Demosaic, samples: &[f32], width: usize, mosaic: &Mosaic) -> Vec<[f32; 3]> {
    match mosaic {
        Mosaic::Tile(tile) => method.apply(samples, width, tile),
        Mosaic::Mono => unreachable!("the phases are tiles"),
    }
}

const METHODS: [Demosaic; 3] = [Demosaic::Bilinear, Demosaic::MalvarHeCutler, Demosaic::HamiltonAdams];

#[test]
fn a_ramp_is_exact_inside_and_flat_colours_everywhere() {
    let (width, height) = (12, 9);
    let ramp: Vec<f32> = (0..width * height).map(|i| ((i % width) * 8 + (i / width) * 4) as f32).collect();
    for (mosaic, method) in phases().iter().flat_map(|m| METHODS.map(|method| (m, method))) {
        let plane = interpolated(method, &ramp, width, mosaic);
        for (x, y) in (3..height - 3).flat_map(|y| (3..width - 3).map(move |x| (x, y))) {
            // Sums of small integers over powers of two: no rounding.
            assert_eq!(plane[y * width + x], [(x * 8 + y * 4) as f32; 3], "{method:?} {x} {y}");
        }
        let colour = [0.5, 0.25, 0.75];
        let flat: Vec<f32> = (0..64).map(|i| colour[mosaic.channel_at(i % 8, i / 8)]).collect();
        assert!(interpolated(method, &flat, 8, mosaic).iter().all(|rgb| *rgb == colour), "{method:?}");
    }
}

#[test]
fn what_was_measured_stays() {
    let samples: Vec<f32> = (0..120).map(|i| (i * 37 % 101) as f32 / 101.0).collect();
    for (mosaic, method) in phases().iter().flat_map(|m| METHODS.map(|method| (m, method))) {
        let plane = interpolated(method, &samples, 12, mosaic);
        assert!((0..120).all(|i| plane[i][mosaic.channel_at(i % 12, i / 12)] == samples[i]), "{method:?}");
    }
}

fn square(x: f64) -> f64 {
    x * x
}

/// Root-mean-square error of a grey disc with a soft edge (2 px), away from the edge.
fn disc_error(method: Demosaic, mosaic: &Mosaic) -> f64 {
    let n = 48;
    let truth = |i: usize| {
        let (x, y) = ((i % n) as f64 - 23.3, (i / n) as f64 - 22.6);
        (0.5 + 0.25 * (15.0 - (x * x + y * y).sqrt())).clamp(0.1, 0.9)
    };
    let samples: Vec<f32> = (0..n * n).map(|i| truth(i) as f32).collect();
    let plane = interpolated(method, &samples, n, mosaic);
    let inside = |i: &usize| (4..n - 4).contains(&(i % n)) && (4..n - 4).contains(&(i / n));
    let squares = (0..n * n).filter(inside).flat_map(|i| plane[i].map(|v| square(f64::from(v) - truth(i))));
    (squares.clone().sum::<f64>() / squares.count() as f64).sqrt()
}

#[test]
fn gradients_make_edges_sharper_than_bilinear() {
    for mosaic in phases() {
        let [bilinear, malvar, adams] = METHODS.map(|m| disc_error(m, &mosaic));
        // Malvar, He & Cutler 2004 report 5.5 dB over bilinear on photographs: a factor of 1.9.
        assert!(malvar < bilinear / 1.5 && adams < bilinear / 1.5, "{bilinear} {malvar} {adams}");
    }
}

#[test]
fn the_outermost_pixels_are_the_mirrors() {
    let padded = PaddedRow::new(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0], 3, 2);
    assert_eq!(padded.row(0, 0), [3.0, 2.0, 1.0, 2.0, 3.0, 2.0, 1.0]);
    assert_eq!(padded.row(0, -2), padded.row(2, 0));
    assert_eq!(padded.row(2, 2), padded.row(0, 0));
    assert_eq!(padded.row(1, 2), padded.row(1, 0));
}

fn tile(width: usize, filters: &[Filter]) -> Tile {
    match Mosaic::tile(width, filters.len() / width, filters.to_vec()) {
        Ok(Mosaic::Tile(tile)) => tile,
        _ => unreachable!("a legal tile"),
    }
}

#[test]
fn corners_and_edges_use_the_neighbours_that_exist() {
    // R G R G
    // G B G B
    // R G R G
    let samples: Vec<f32> =
        [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]].as_flattened().iter().map(|v| *v as f32).collect();
    let plane: Vec<[f32; 3]> = interpolate_bilinear(&samples, 4, &tile(2, &[Red, Green, Green, Blue]));
    assert_eq!(plane[0], [1.0, (2.0 + 5.0) / 2.0, 6.0]);
    assert_eq!(plane[1], [(1.0 + 3.0) / 2.0, 2.0, 6.0]);
    assert_eq!(plane[2], [3.0, (2.0 + 4.0 + 7.0) / 3.0, (6.0 + 8.0) / 2.0]);
    assert_eq!(plane[7], [(3.0 + 11.0) / 2.0, (4.0 + 7.0 + 12.0) / 3.0, 8.0]);
    assert_eq!(plane[11], [11.0, 12.0, 8.0]);
}

#[test]
fn two_and_four_channels_work_alike() {
    let rccc = tile(2, &[Red, Clear, Clear, Clear]);
    let ramp: Vec<f32> = (0..63).map(|i| (i % 9 * 8 + i / 9 * 4) as f32).collect();
    let plane: Vec<[f32; 2]> = interpolate_bilinear(&ramp, 9, &rccc);
    for (x, y) in (1..6).flat_map(|y| (1..8).map(move |x| (x, y))) {
        assert_eq!(plane[y * 9 + x], [(x * 8 + y * 4) as f32; 2]);
    }
    let rgbi = tile(2, &[Red, Green, Infrared, Blue]);
    let colours = [0.1, 0.2, 0.3, 0.4];
    let flat: Vec<f32> = (0..64).map(|i| colours[rgbi.at(i % 8, i / 8)]).collect();
    let plane: Vec<[f32; 4]> = interpolate_bilinear(&flat, 8, &rgbi);
    // A mean of equal numbers rounds at most a few times.
    assert!(plane.iter().all(|v| (0..4).all(|c| (v[c] - colours[c]).abs() < 1e-7)));
}

#[test]
fn a_quad_bayer_tile_reaches_two_pixels_far() {
    let quad = [Red, Red, Green, Green, Red, Red, Green, Green, Green, Green, Blue, Blue, Green, Green, Blue, Blue];
    let quad = tile(4, &quad);
    let colours = [0.5, 0.25, 0.75];
    let flat: Vec<f32> = (0..99).map(|i| colours[quad.at(i % 11, i / 11)]).collect();
    assert!(interpolate_bilinear::<3>(&flat, 11, &quad).iter().all(|rgb| *rgb == colours));
}

#[test]
fn an_impulse_shows_the_filters_of_the_paper() {
    let Ok(Mosaic::Tile(tile)) = Mosaic::tile(2, 2, vec![Red, Green, Green, Blue]) else { unreachable!("Bayer") };
    let impulse = |at: [usize; 2]| {
        let mut samples = vec![0.0; 81];
        samples[at[1] * 9 + at[0]] = 8.0;
        interpolate_malvar(&samples, 9, &tile)
    };
    // A red pixel at (4, 4): its own green and blue, and its contributions to others.
    let red = impulse([4, 4]);
    let at = |plane: &[[f32; 3]], x: usize, y: usize| plane[y * 9 + x];
    assert_eq!(at(&red, 4, 4), [8.0, 4.0, 6.0]);
    assert_eq!(at(&red, 6, 4), [0.0, -1.0, -1.5]);
    assert_eq!(at(&red, 5, 4), [4.0, 0.0, 0.0]);
    assert_eq!(at(&red, 5, 5), [2.0, 0.0, 0.0]);
    // A green pixel in a red row, at (5, 4).
    let green = impulse([5, 4]);
    assert_eq!(at(&green, 5, 4), [5.0, 8.0, 5.0]);
    assert_eq!(at(&green, 7, 4), [-1.0, 0.0, 0.5]);
    assert_eq!(at(&green, 5, 6), [0.5, 0.0, -1.0]);
    assert_eq!(at(&green, 4, 5), [-1.0, 0.0, -1.0]);
    assert_eq!(at(&green, 4, 4), [0.0, 2.0, 0.0]);
}

#[test]
fn a_grey_edge_along_the_pixels_is_exact() {
    let Ok(Mosaic::Tile(tile)) = Mosaic::tile(2, 2, vec![Green, Red, Blue, Green]) else { unreachable!("Bayer") };
    let upright: Vec<f32> = (0..144).map(|i| if i % 12 < 6 { 0.25 } else { 0.75 }).collect();
    let level: Vec<f32> = (0..144).map(|i| if i / 12 < 7 { 0.25 } else { 0.75 }).collect();
    for edge in [upright, level] {
        let plane = interpolate_hamilton_adams(&edge, 12, &tile);
        // Green is interpolated along the edge, so it is exact. Red and blue follow it at half of their positions.
        assert!((0..144).all(|i| plane[i][GREEN] == edge[i]));
        let exact = (0..144).filter(|i| plane[*i] == [edge[*i]; 3]).count();
        assert!(exact == 144, "{exact} of 144");
    }
}
