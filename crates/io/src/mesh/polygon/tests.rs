use super::*;

fn lift(flat: &[[f64; 2]]) -> Vec<[f64; 3]> {
    // A slanted plane, far from the origin: a projection along an axis would be easier.
    flat.iter().map(|[x, y]| [1e5 + x, 2e5 + y, 0.3 * x - 0.7 * y]).collect()
}

fn area(corners: &[[f64; 3]], triangles: &[[usize; 3]]) -> [f64; 3] {
    triangles.iter().map(|t| newell(&t.map(|i| corners[i]))).fold([0.0; 3], |s, a| std::array::from_fn(|i| s[i] + a[i]))
}

/// The triangles cover the polygon once: each turns as the polygon does, and their areas add up to its area.
fn covers(flat: &[[f64; 2]]) {
    let corners = lift(flat);
    let triangles = triangulate(&corners).expect("simple");
    let total = newell(&corners);
    assert_eq!(triangles.len(), corners.len() - 2);
    for t in &triangles {
        // Coordinates of 2e5 carry 3e-11 of rounding; triangles may have zero area.
        assert!(dot(newell(&t.map(|i| corners[i])), total) >= -1e-8, "{t:?}");
    }
    let sum = area(&corners, &triangles);
    for axis in 0..3 {
        assert!((sum[axis] - total[axis]).abs() < 1e-8, "{sum:?} {total:?}");
    }
}

#[test]
fn a_convex_polygon_is_a_fan() {
    let square = lift(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    assert_eq!(triangulate(&square), Ok(vec![[0, 1, 2], [0, 2, 3]]));
}

#[test]
fn concave_polygons_are_covered_once() {
    covers(&[[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]]); // arrowhead
    covers(&[[1.0, 1.0], [0.0, 3.0], [0.0, 0.0], [3.0, 0.0]]); // arrowhead whose fan would be wrong
    covers(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]]); // L
    covers(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]]); // U
    // The same L the other way round, and with a straight corner.
    covers(&[[0.0, 3.0], [1.0, 3.0], [1.0, 1.0], [3.0, 1.0], [3.0, 0.0], [1.5, 0.0], [0.0, 0.0]]);
}

#[test]
fn a_polygon_that_crosses_itself_is_refused() {
    let bow = lift(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(triangulate(&bow), Err(PolygonError::CrossesItself));
    let uneven_bow = lift(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 3.0]]);
    assert_eq!(triangulate(&uneven_bow), Err(PolygonError::CrossesItself));
    // cos and sin of 72° steps, in the order of a pentagram.
    let star = lift(&[[1.0, 0.0], [-0.809, 0.588], [0.309, -0.951], [0.309, 0.951], [-0.809, -0.588]]);
    assert_eq!(triangulate(&star), Err(PolygonError::CrossesItself));
}

#[test]
fn corners_on_one_line_give_triangles_without_area() {
    let corners = lift(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]);
    assert_eq!(triangulate(&corners).map(|t| t.len()), Ok(2));
}

/// Number of triangles that contain a point.
fn times_covered(flat: &[[f64; 2]], triangles: &[[usize; 3]], p: [f64; 2]) -> usize {
    let holds = |t: &&[usize; 3]| (0..3).all(|i| turn(flat[t[i]], flat[t[(i + 1) % 3]], p) > 0.0);
    triangles.iter().filter(holds).count()
}

#[test]
fn a_hole_is_reached_by_a_bridge_and_not_covered() {
    let outer = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 0.0]];
    let hole = [[4.0, 4.0], [4.0, 6.0], [6.0, 6.0], [6.0, 4.0], [4.0, 4.0]];
    for shift in 0..10 {
        let mut flat = [outer, hole].concat();
        flat.rotate_left(shift);
        covers(&flat);
        let triangles = triangulate(&lift(&flat)).expect("edges that coincide do not cross");
        for (x, y) in (0..40).flat_map(|x| (0..40).map(move |y| (f64::from(x), f64::from(y)))) {
            let p = [0.131 + x * 0.25, 0.117 + y * 0.25];
            let in_hole = p.iter().all(|c| (4.0..6.0).contains(c));
            assert_eq!(times_covered(&flat, &triangles, p), usize::from(!in_hole), "{p:?}, turned by {shift}");
        }
    }
}

#[test]
fn corners_that_coincide_and_corners_on_edges_are_covered() {
    covers(&[[0.0, 0.0], [0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]]);
    let mut touching = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [0.0, 2.0]];
    for _ in 0..touching.len() {
        touching.rotate_left(1);
        covers(&touching);
    }
}

/// Reference: takes the first ear by a search of all corners each time.
fn by_all_corners(flat: &[[f64; 2]]) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let corner = |i: usize| [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
        let is_ear = |i: &usize| {
            let [a, b, c] = corner(*i).map(|i| flat[i]);
            let inside = |p: [f64; 2]| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            let blocks = |p: [f64; 2]| p != a && p != b && p != c && inside(p);
            let enters = |p: [f64; 2]| turn(a, b, p) > 0.0 && turn(b, c, p) > 0.0;
            let leads_inside = |j: usize| {
                let [before, twin, after] = corner(j).map(|i| flat[i]);
                turn(a, b, c) > 0.0 && j != *i && twin == b && (enters(before) || enters(after))
            };
            turn(a, b, c) >= 0.0 && !left.iter().any(|&i| blocks(flat[i])) && !(0..n).any(leads_inside)
        };
        let is_between_equals = |i: &usize| flat[corner(*i)[0]] == flat[corner(*i)[2]];
        let ears: Vec<usize> = (0..n).filter(is_ear).collect();
        let ear = ears.iter().copied().find(is_between_equals).or(ears.first().copied())?;
        triangles.push(corner(ear));
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    Some(triangles)
}

/// Spikes of these radii about the origin, as a simple polygon.
fn spikes(radii: impl ExactSizeIterator<Item = f64>) -> Vec<[f64; 2]> {
    let n = radii.len() as f64;
    let corner = |(i, r): (usize, f64)| {
        let angle = std::f64::consts::TAU * i as f64 / n;
        [r * etendue_core::maths::f64::cos(angle), r * etendue_core::maths::f64::sin(angle)]
    };
    radii.enumerate().map(corner).collect()
}

/// All pairs of edges would be 10¹⁰ here, and so would all corners for each ear.
#[test]
fn polygons_of_many_corners_are_covered() {
    const N: usize = 100_000;
    let gear: Vec<[f64; 2]> = spikes((0..N).map(|i| if i % 2 == 0 { 1.0 } else { 0.7 }));
    let ragged: Vec<[f64; 2]> = spikes((0..N).map(|i| 0.2 + (i * 7919 % 1009) as f64 / 500.0));
    let tooth = |i: usize| [[i as f64, 1.0], [i as f64 + 0.5, 0.1 + (i % 97) as f64 * 1e-3]];
    let mut comb: Vec<[f64; 2]> = (0..N / 2).rev().flat_map(tooth).collect();
    comb.extend([[-1.0, 0.0], [(N / 2) as f64, 0.0]]);
    for flat in [gear, ragged, comb] {
        let corners: Vec<[f64; 3]> = flat.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        let triangles = triangulate(&corners).expect("simple");
        assert_eq!(triangles.len(), flat.len() - 2);
        let doubled: f64 = triangles.iter().map(|t| turn(flat[t[0]], flat[t[1]], flat[t[2]])).sum();
        let expected = newell(&corners)[2].abs();
        assert!((doubled.abs() - expected).abs() < 1e-9 * expected, "{doubled} {expected}");
    }
}

proptest::proptest! {
    /// Random outlines on a coarse grid: corners coincide, lie on edges, and are collinear. Those that cross themselves are refused before ears are searched
    /// for.
    #[test]
    fn the_first_ear_is_found_as_by_looking_at_all_corners(
        corners in proptest::collection::vec((0_i32..9, 0_i32..9), 4..10)
    ) {
        let flat: Vec<[f64; 2]> = corners.iter().map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect();
        if !edges_cross(&flat) {
            proptest::prop_assert_eq!(clip_ears(&flat), by_all_corners(&flat));
        }
    }

    #[test]
    fn ragged_outlines_are_cut_as_by_looking_at_all_corners(
        radii in proptest::collection::vec(0.01_f64..3.0, 5..200)
    ) {
        let flat = spikes(radii.into_iter());
        proptest::prop_assert_eq!(clip_ears(&flat), by_all_corners(&flat));
    }

    /// A polygon that is star-shaped about the origin is simple, and rarely convex.
    #[test]
    fn star_shaped_polygons_are_covered_once(radii in proptest::collection::vec(0.2_f64..3.0, 5..24)) {
        let n = radii.len() as f64;
        let flat: Vec<[f64; 2]> = radii.iter().enumerate().map(|(i, r)| {
            let angle = std::f64::consts::TAU * i as f64 / n;
            [r * etendue_core::maths::f64::cos(angle), r * etendue_core::maths::f64::sin(angle)]
        }).collect();
        covers(&flat);
    }
}

fn by_all_pairs(flat: &[Point2]) -> bool {
    let edges: Vec<PolygonEdge> =
        (0..flat.len()).filter_map(|i| PolygonEdge::new(i, flat[i], flat[(i + 1) % flat.len()])).collect();
    edges.iter().any(|a| edges.iter().any(|b| a.crosses(b)))
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(4000))]

    /// Corners on a coarse grid coincide, lie on edges, and are collinear.
    #[test]
    fn the_sweep_finds_what_all_pairs_find(corners in proptest::collection::vec((0_i32..7, 0_i32..7), 3..12)) {
        let flat: Vec<Point2> = corners.iter().map(|(x, y)| [f64::from(*x), f64::from(*y)]).collect();
        proptest::prop_assert_eq!(edges_cross(&flat), by_all_pairs(&flat));
    }

    #[test]
    fn the_sweep_finds_crossings_anywhere(corners in proptest::collection::vec((0.0_f64..1.0, 0.0_f64..1.0), 3..9)) {
        let flat: Vec<Point2> = corners.iter().map(|(x, y)| [*x, *y]).collect();
        proptest::prop_assert_eq!(edges_cross(&flat), by_all_pairs(&flat));
    }
}
