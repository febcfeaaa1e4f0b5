//! Positions of detected chart points.

use super::cameras::{fisheye, perspective};
use super::paint::{View, checkerboard, dots, noisy};
use etendue_metrology::Image;
use etendue_metrology::patch_statistics::centroid_shift;
use etendue_metrology::target::{Grid, Target, TargetError, TargetQuery, find};
use glam::{DVec2, DVec3};

const BOARD: TargetQuery = TargetQuery { target: Some(Target::Checkerboard), size: None };
const DOTS: TargetQuery = TargetQuery { target: Some(Target::Dots), size: None };

/// Distances of detected points from their true positions, sorted; panics if the grid is not the whole chart.
fn errors(view: &View, grid: &Grid, size: [usize; 2]) -> Vec<f64> {
    assert_eq!((grid.size, grid.nodes.len()), (size, size[0] * size[1]), "the whole chart");
    let mut errors: Vec<f64> = grid
        .nodes
        .iter()
        .map(|n| {
            let chart = DVec2::new(n.index[0] as f64, n.index[1] as f64);
            (view.image(chart).expect("in the field") - n.at).length()
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    errors
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

#[test]
fn corners_of_a_barrel_are_found_to_two_hundredths_of_a_pixel() {
    let camera = perspective(420.0, &[-0.25, 0.06, 0.001, -0.0007], [640, 480]);
    let view = View::new(&camera, [0.25, -0.3, 0.1], DVec2::new(5.0, 3.5), DVec3::new(0.2, 0.1, 9.5));
    let image = view.render(24, &checkerboard(11, 8));
    let sharp = errors(&view, &find(&image, BOARD).expect("a board"), [11, 8]);
    assert!(sharp[sharp.len() - 1] < 0.02, "{sharp:?}");
    let noisy = find(&noisy(&image, 0.02, 1), BOARD).expect("a board");
    let stated = rms(&noisy.nodes.iter().map(|n| std::f64::consts::SQRT_2 * n.uncertainty_px).collect::<Vec<_>>());
    let ratio = rms(&errors(&view, &noisy, [11, 8])) / stated;
    // 176 coordinates: their mean square has a relative standard deviation of 11 %, its root 5 %; the limit is four of them.
    assert!((ratio - 1.0).abs() < 0.22, "{ratio}");
}

#[test]
fn blurred_and_small_squares_are_found() {
    let camera = perspective(420.0, &[-0.1, 0.0, 0.0, 0.0], [640, 480]);
    let view = View::new(&camera, [0.1, 0.2, 0.7], DVec2::new(5.0, 3.5), DVec3::new(0.0, 0.0, 24.0));
    let image = view.render(8, &checkerboard(11, 8));
    // Squares of 17 px, supersampled to 1/8 px: a few hundredths of the window's mean.
    let small = errors(&view, &find(&image, BOARD).expect("a board"), [11, 8]);
    assert!(small[small.len() - 1] < 0.05, "{small:?}");
    let near = View::new(&camera, [0.1, 0.2, 0.7], DVec2::new(5.0, 3.5), DVec3::new(0.0, 0.0, 14.0));
    let mut soft = near.render(4, &checkerboard(11, 8));
    (0..20).for_each(|_| soft = smoothed(&soft));
    // A standard deviation of 4.5 px: the profile is nearly Gaussian, the model's is not quite.
    let soft = errors(&near, &find(&soft, BOARD).expect("a board"), [11, 8]);
    assert!(soft[soft.len() - 1] < 0.05, "{soft:?}");
}

/// Means of three pixels, across and down: a variance of 2/3 px² more.
fn smoothed(image: &Image) -> Image {
    let (width, height) = (image.width(), image.height());
    let at = |image: &Image, x: usize, y: usize, axis: usize| {
        let [sx, sy] = [usize::from(axis == 0), usize::from(axis == 1)];
        let before = image.at(x.saturating_sub(sx), y.saturating_sub(sy));
        let after = image.at((x + sx).min(width - 1), (y + sy).min(height - 1));
        (before + image.at(x, y) + after) / 3.0
    };
    let pass = |image: &Image, axis: usize| {
        let samples = (0..width * height).map(|i| at(image, i % width, i / width, axis)).collect();
        Image::from_samples(width, height, samples).expect("as large")
    };
    pass(&pass(image, 0), 1)
}

#[test]
fn dots_of_a_fisheye_lie_where_the_discs_centres_of_area_are_seen() {
    let camera = fisheye(210.0, [800, 600]);
    let view = View::new(&camera, [0.05, -0.04, 0.02], DVec2::new(10.0, 7.0), DVec3::new(0.0, 0.0, 6.0));
    let image = view.render(8, &dots(21, 15, 0.25));
    for (image, tolerance) in [(&image, 0.02), (&image.map(|v| 1.0 - v), 0.02)] {
        let grid = find(image, DOTS).expect("dots");
        assert_eq!((grid.size, grid.nodes.len()), ([21, 15], 315));
        // Areas of dots of 10 to 240 px², each to some hundredths of a pixel.
        assert!((grid.disc_radius_steps.expect("dots") / 0.25 - 1.0).abs() < 3e-3, "{:?}", grid.disc_radius_steps);
        for n in &grid.nodes {
            let chart = DVec2::new(n.index[0] as f64, n.index[1] as f64);
            let shift = centroid_shift(|p| view.image(p), chart, 0.25).expect("in the field");
            let error = (view.image(chart).expect("in the field") + shift - n.at).length();
            assert!(error < tolerance, "{:?}: {error}", n.index);
        }
    }
}

#[test]
fn the_photons_of_bright_dots_count_in_their_uncertainty() {
    let camera = perspective(500.0, &[], [640, 480]);
    let view = View::new(&camera, [0.0; 3], DVec2::new(5.0, 3.5), DVec3::new(0.0, 0.0, 12.0));
    // Bright dots: a variance in proportion to the light, five times as much deviation in the dots as around them.
    let image: Image = view.render(16, &dots(11, 8, 0.3)).map(|v| if v < 0.899 { 0.9 - v + 0.036 } else { 0.036 });
    let unit = noisy(&Image::filled(640, 480, 0.0), 1.0, 5);
    let both = image.samples().iter().zip(unit.samples());
    let shot = both.map(|(v, n): (&f32, &f32)| v + 0.03 * v.max(0.0).sqrt() * n);
    let grid = find(&Image::from_samples(640, 480, shot.collect()).expect("as large"), DOTS).expect("dots");
    let stated = rms(&grid.nodes.iter().map(|n| std::f64::consts::SQRT_2 * n.uncertainty_px).collect::<Vec<_>>());
    let ratio = rms(&errors(&view, &grid, [11, 8])) / stated;
    // 176 coordinates: 5 %; the limit is four of them, and as much for the edges, whose variance is in between.
    assert!((ratio - 1.0).abs() < 0.3, "{ratio}");
}

#[test]
fn shading_does_not_move_dots() {
    let camera = perspective(500.0, &[], [640, 480]);
    let view = View::new(&camera, [0.0; 3], DVec2::new(5.0, 3.5), DVec3::new(0.0, 0.0, 12.0));
    let image = view.render(16, &dots(11, 8, 0.3));
    let shaded = (0..image.samples().len()).map(|i| {
        let [x, y] = [(i % 640) as f32 / 640.0, (i / 640) as f32 / 480.0];
        image.samples()[i] * (1.0 - 0.5 * x) * (1.0 - 0.3 * y * y)
    });
    let shaded = Image::from_samples(640, 480, shaded.collect()).expect("as large");
    let grid = find(&shaded, DOTS).expect("dots");
    // Seen frontally without distortion, a disc's centroid is its centre's image. The light decreases across the image, with a
    // curvature below a thousandth within the neighbourhood of a dot.
    let actual = errors(&view, &grid, [11, 8]);
    assert!(actual[actual.len() - 1] < 0.01, "{actual:?}");
}

#[test]
fn a_staggered_grid_is_a_square_one_on_its_corner() {
    let camera = perspective(500.0, &[-0.1, 0.0, 0.0, 0.0], [640, 480]);
    let view = View::new(&camera, [0.2, -0.1, 0.0], DVec2::new(5.0, 4.0), DVec3::new(0.0, 0.0, 14.0));
    // Dots at positions where column and row are both even or both odd.
    let all = dots(11, 9, 0.35);
    let staggered = move |p: DVec2| {
        let [x, y] = p.round().to_array().map(|c| c as i32);
        if (x + y) % 2 == 0 { all(p) } else { 0.9 }
    };
    let grid = find(&view.render(8, &staggered), DOTS).expect("dots");
    assert_eq!(grid.nodes.len(), 50);
    let nearest = |at: DVec2| {
        let places =
            (0..99).filter(|i| (i % 11 + i / 11) % 2 == 0).map(|i| DVec2::new(f64::from(i % 11), f64::from(i / 11)));
        let off = places.map(|p| {
            let shift = centroid_shift(|q| view.image(q), p, 0.35).expect("in the field");
            (view.image(p).expect("in the field") + shift - at).length()
        });
        off.fold(f64::INFINITY, f64::min)
    };
    assert!(grid.nodes.iter().all(|n| nearest(n.at) < 0.02));
    // The disc's radius over the step, √2.
    assert!((grid.disc_radius_steps.expect("dots") * std::f64::consts::SQRT_2 / 0.35 - 1.0).abs() < 5e-3);
}

#[test]
fn a_picture_without_a_chart_is_refused() {
    let plain = Image::filled(320, 240, 0.5);
    let noise = noisy(&plain, 0.1, 7);
    for image in [&plain, &noise] {
        for query in [BOARD, DOTS, TargetQuery::default()] {
            let result = find(image, query);
            assert!(matches!(result, Err(TargetError::None { .. } | TargetError::Gaps { .. })), "{result:?}");
        }
    }
}

/// Seen obliquely at the edge of a fisheye, where one diagonal of every square is shorter than a side or nearly so: misread as 18
/// × 8.
#[test]
fn dots_seen_askew_are_numbered_by_rows_and_columns() {
    let camera = fisheye(150.0, [640, 480]);
    for (rotation, place) in [
        ([0.0, 0.0, 0.0], DVec3::new(-7.0, -6.0, 5.0)),
        ([0.8, 0.8, 0.4], DVec3::new(1.0, 1.0, 7.0)),
        ([-0.7, 0.9, 0.2], DVec3::new(0.0, 1.0, 6.0)),
    ] {
        let view = View::new(&camera, rotation, DVec2::new(5.0, 3.5), place);
        let grid = find(&view.render(6, &dots(11, 8, 0.3)), DOTS).expect("dots");
        let mut size = grid.size;
        size.sort_unstable();
        assert!(size == [8, 11] && grid.nodes.len() >= 86, "{rotation:?}: {:?}, {}", grid.size, grid.nodes.len());
        let places = || (0..88).map(|i| DVec2::new(f64::from(i % 11), f64::from(i / 11)));
        let from = |p: DVec2, at: DVec2| (view.image(p).expect("in the field") - at).length();
        let chart = |at: DVec2| places().min_by(|a, b| from(*a, at).total_cmp(&from(*b, at))).expect("points");
        for n in &grid.nodes {
            let neighbours = [[n.index[0] + 1, n.index[1]], [n.index[0], n.index[1] + 1]];
            for other in neighbours.into_iter().filter_map(|index| grid.node(index)) {
                assert_eq!((chart(other.at) - chart(n.at)).length(), 1.0, "{rotation:?}: {:?}", n.index);
            }
        }
    }
}

#[test]
fn two_charts_are_refused() {
    let camera = perspective(500.0, &[], [640, 480]);
    let view = View::new(&camera, [0.0; 3], DVec2::new(8.0, 3.5), DVec3::new(0.0, 0.0, 16.0));
    let (left, right) = (checkerboard(7, 7), checkerboard(6, 5));
    let boards = move |p: DVec2| if p.x < 7.5 { left(p) } else { right(p - DVec2::new(10.2, 1.1)) };
    let detect = |paint: &(dyn Fn(DVec2) -> f64 + Sync), query| find(&view.render(6, &|p| paint(p)), query);
    // The chart with the stated size is complete.
    assert_eq!(detect(&boards, TargetQuery { size: Some([7, 7]), ..BOARD }).map(|g| g.size), Ok([7, 7]));
    for query in [BOARD, TargetQuery::default(), TargetQuery { size: Some([8, 7]), ..BOARD }] {
        assert_eq!(detect(&boards, query), Err(TargetError::Several { points: [49, 30] }), "{query:?}");
    }
    let (left, right) = (dots(7, 7, 0.3), dots(6, 5, 0.3));
    let both = move |p: DVec2| if p.x < 7.5 { left(p) } else { right((p - DVec2::new(10.2, 1.1)) * 1.2) };
    assert_eq!(detect(&both, DOTS), Err(TargetError::Several { points: [49, 30] }));
    let (left, right) = (checkerboard(7, 7), dots(6, 5, 0.3));
    let mixed = move |p: DVec2| if p.x < 7.5 { left(p) } else { right(p - DVec2::new(10.2, 1.1)) };
    assert_eq!(detect(&mixed, TargetQuery::default()), Err(TargetError::Several { points: [49, 30] }));
    assert_eq!(detect(&mixed, DOTS).map(|g| g.size), Ok([6, 5]));
}
