//! Point-spread functions over the field from tables, on a film.

use etendue_core::Plane;
use etendue_core::WavelengthRange;
use etendue_core::maths::f64::{exp, sin_cos};
use etendue_core::quantity::{Irradiance, Variance};
use etendue_core::random::Pixel;
use etendue_optics::effects::{
    FieldSpread, FilmPart, PointSpread, SpreadMethod, SpreadRandomNumbers, SpreadTable, SpreadTableParameters,
    WavelengthTable,
};
use etendue_optics::{Effects, EffectsError, EffectsParameters};
use etendue_projection::Raster;
use glam::{DMat2, DVec2};

const BAND: WavelengthRange = WavelengthRange::new(545.0, 555.0);
const PIXEL_MM: f64 = 0.004;
const SIZE: [usize; 2] = [601, 401];
/// Samples of a table: an eighth of a mm in steps of 1.25 µm.
const SIDE: usize = 101;
const STEP_MM: f64 = 0.00125;

fn raster() -> Raster {
    Raster::centred(SIZE[0], SIZE[1], PIXEL_MM).expect("legal")
}

/// A function at a field position; `light` gives its light at an offset along the radius and across it, mm.
fn function(place_mm: DVec2, light: impl Fn(f64, f64) -> f64) -> FieldSpread {
    let outwards = place_mm.try_normalize().unwrap_or(DVec2::NEG_Y);
    let middle = (SIDE / 2) as f64;
    let sample = |i: usize| {
        let offset = (DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) - middle) * STEP_MM;
        light(outwards.dot(offset), outwards.perp_dot(offset)) as f32
    };
    let light = (0..SIDE * SIDE).map(sample).collect();
    FieldSpread { place_mm, pitch_um: 1e3 * STEP_MM, width: SIDE, light, point: [SIDE / 2; 2] }
}

/// Widths of a Gaussian along the radius and across it, and its offset outwards and sideways from its point, mm.
#[derive(Clone, Copy)]
struct Shape {
    widths: [f64; 2],
    offset: [f64; 2],
}

impl Shape {
    /// At a distance from the axis, mm; on the axis it is round and centred on its point.
    fn at(radius_mm: f64) -> Self {
        Self {
            widths: [0.008 + 0.002 * radius_mm * radius_mm, 0.008 + 0.001 * radius_mm * radius_mm],
            offset: [0.0005 * radius_mm, 0.0003 * radius_mm],
        }
    }

    fn light(self, along: f64, across: f64) -> f64 {
        let [a, b] = [(along - self.offset[0]) / self.widths[0], (across - self.offset[1]) / self.widths[1]];
        exp(-0.5 * (a * a + b * b))
    }

    fn function(radius_mm: f64, direction: DVec2) -> FieldSpread {
        let shape = Self::at(radius_mm);
        function(direction * radius_mm, |along, across| shape.light(along, across))
    }

    /// Centroid and second moments about the point along the radius and across it, mm, mm².
    fn moments(self) -> (DVec2, DMat2) {
        let offset = DVec2::from(self.offset);
        let spread = DMat2::from_diagonal(DVec2::from(self.widths) * DVec2::from(self.widths));
        (offset, spread + DMat2::from_cols(offset * offset.x, offset * offset.y))
    }
}

fn table(fields: Vec<FieldSpread>, patches: Option<[usize; 2]>) -> Result<SpreadTable, EffectsError> {
    let parameters = SpreadTableParameters { wavelengths: vec![WavelengthTable { nm: None, fields }], patches };
    SpreadTable::new(parameters, &raster())
}

/// Functions every 0.15 mm along a direction.
fn growing_functions(direction: DVec2) -> Vec<FieldSpread> {
    (0..=10).map(|i| Shape::function(0.15 * f64::from(i), direction)).collect()
}

fn effects(table: SpreadTable, spread_by: Option<SpreadMethod>) -> Effects {
    let psf = Some(PointSpread::Table(table));
    Effects::new(EffectsParameters { psf, spread_by, margin: Some(0.0), ..Default::default() }, &raster())
        .expect("legal")
}

fn spread(table: &SpreadTable, film: &Plane<Irradiance>, variance: Option<&Plane<Variance>>) -> Plane<Irradiance> {
    let effects = effects(table.clone(), Some(SpreadMethod::Film));
    effects.prepared(&raster(), BAND, FilmPart::Whole).apply(BAND, film, variance).0
}

/// Measured spread of points: sum, centroid relative to the point and second moments about it, mm, mm².
fn moments(table: &SpreadTable, pixels: &[[usize; 2]]) -> Vec<(f64, DVec2, DMat2)> {
    /// Columns and rows about a point that belong to it.
    const NEIGHBOURHOOD_PX: usize = 28;
    let mut film = Plane::new(SIZE[0], SIZE[1]);
    pixels.iter().for_each(|pixel| film.set(pixel[0], pixel[1], 1.0));
    let image = spread(table, &film, None);
    let of = |[column, row]: &[usize; 2]| {
        let (mut sum, mut centroid, mut second) = (0.0, DVec2::ZERO, DMat2::ZERO);
        for y in row - NEIGHBOURHOOD_PX..=row + NEIGHBOURHOOD_PX {
            for x in column - NEIGHBOURHOOD_PX..=column + NEIGHBOURHOOD_PX {
                let light = f64::from(image.at(x, y));
                let offset = (DVec2::new(x as f64, y as f64) - DVec2::new(*column as f64, *row as f64)) * PIXEL_MM;
                sum += light;
                centroid += offset * light;
                second += DMat2::from_cols(offset * offset.x, offset * offset.y) * light;
            }
        }
        (sum, centroid / sum, second * (1.0 / sum))
    };
    pixels.iter().map(of).collect()
}

fn place(pixel: [usize; 2]) -> DVec2 {
    raster().sensor_mm(DVec2::new(pixel[0] as f64 + 0.5, pixel[1] as f64 + 0.5))
}

/// At patches and between them, in all quadrants.
const PLACES: [[usize; 2]; 10] = [
    [300, 200],
    [120, 100],
    [480, 60],
    [540, 350],
    [60, 330],
    [300, 40],
    [40, 200],
    [450, 200],
    [210, 290],
    [390, 260],
];

#[test]
fn points_are_spread_as_the_tables_say() {
    for direction in [DVec2::NEG_Y, DVec2::Y, DVec2::X, DVec2::new(-0.6, 0.8)] {
        let table = table(growing_functions(direction), None).expect("legal");
        assert!(table.patches()[0] > 1, "{:?}", table.patches());
        for (pixel, (sum, found_centroid, found_second)) in PLACES.into_iter().zip(moments(&table, &PLACES)) {
            let at = place(pixel);
            let outwards = at.try_normalize().unwrap_or(DVec2::X);
            let turn = DMat2::from_cols(outwards, outwards.perp());
            let (centroid, second) = Shape::at(at.length()).moments();
            let scale = second.x_axis.x + second.y_axis.y;
            let expected = turn * second * turn.transpose();
            let off = (found_second - expected).to_cols_array().into_iter().fold(0.0, |a: f64, v| a.max(v.abs()));
            // Each pixel takes the functions of its own position, not the point's: light changes by the divergence of the centroids, centroids by
            // that of the second moments.
            assert!((sum - 1.0).abs() < 0.004, "{pixel:?}: {sum}");
            assert!((found_centroid - turn * centroid).length() < 0.01 * scale.sqrt(), "{pixel:?}: {found_centroid}");
            assert!(off < 0.01 * scale, "{direction} {pixel:?}: {off} of {scale}");
        }
    }
}

#[test]
fn tails_point_away_from_the_axis_in_every_quadrant() {
    // Light at the point and, a tenth of it, in a tail to three times 10 µm, in any direction.
    let comet = |direction: DVec2| {
        function(direction * 0.3, |along, across| {
            let head = exp(-0.5 * (along * along + across * across) / (0.003 * 0.003));
            let tail = if (0.0..0.04).contains(&along) && across.abs() < 0.25 * along + 0.002 { 0.1 } else { 0.0 };
            head + tail
        })
    };
    for direction in [DVec2::NEG_Y, DVec2::Y, DVec2::X, DVec2::NEG_X] {
        let table = table(vec![comet(direction)], Some([5, 5])).expect("legal");
        let corners = [[150, 100], [450, 100], [450, 300], [150, 300], [300, 60], [300, 340], [60, 200], [540, 200]];
        for (pixel, (_, centroid, _)) in corners.into_iter().zip(moments(&table, &corners)) {
            let outwards = place(pixel).normalize();
            assert!(centroid.dot(outwards) > 0.005, "{direction} {pixel:?}: {centroid}");
            assert!(centroid.normalize().dot(outwards) > 0.999, "{direction} {pixel:?}: {centroid}");
        }
    }
}

#[test]
fn a_uniform_irradiance_stays_uniform_and_variance_falls() {
    let table = table(growing_functions(DVec2::NEG_Y), None).expect("legal");
    let effects = effects(table, Some(SpreadMethod::Film));
    let film = Plane::filled(SIZE[0], SIZE[1], 2.0);
    let variance: Plane<Variance> = Plane::filled(SIZE[0], SIZE[1], 0.5);
    let (mean, noise) = effects.prepared(&raster(), BAND, FilmPart::Whole).apply(BAND, &film, Some(&variance));
    let noise = noise.expect("it was there");
    for (x, y) in [(300, 200), (160, 150), (441, 309), (300, 41)] {
        assert!((mean.at(x, y) - 2.0).abs() < 1e-5, "({x}, {y}): {}", mean.at(x, y));
        assert!(noise.at(x, y) < 0.3, "({x}, {y}): {}", noise.at(x, y));
    }
}

#[test]
fn between_wavelengths_functions_are_mixed_and_beyond_them_held() {
    let round = |width: f64| vec![function(DVec2::ZERO, |a, b| exp(-0.5 * (a * a + b * b) / (width * width)))];
    let wavelengths = vec![
        WavelengthTable { nm: Some(500.0), fields: round(0.006) },
        WavelengthTable { nm: Some(600.0), fields: round(0.012) },
    ];
    let table = SpreadTable::new(SpreadTableParameters { wavelengths, patches: None }, &raster()).expect("legal");
    assert_eq!(table.patches(), [1, 1]);
    for (nm, fraction) in [(450.0, 0.0), (500.0, 0.0), (525.0, 0.25), (560.0, 0.6), (600.0, 1.0), (700.0, 1.0)] {
        let frequency = DVec2::new(12.0, 9.0);
        let of = |width: f64| {
            let phase = core::f64::consts::TAU * width * frequency.length();
            exp(-0.5 * phase * phase)
        };
        let expected = (1.0 - fraction) * of(0.006) + fraction * of(0.012);
        let actual = table.transfer(nm, DVec2::new(0.1, 0.2), frequency).length();
        assert!((actual - expected).abs() < 1e-5, "{nm}: {actual} for {expected}");
        // The film's band of 10 nm about it, from the measured spread of a point.
        let effects = effects(table.clone(), Some(SpreadMethod::Film));
        let band = WavelengthRange::new(nm - 5.0, nm + 5.0);
        let mut film: Plane<Irradiance> = Plane::new(SIZE[0], SIZE[1]);
        film.set(300, 200, 1.0);
        let image = effects.prepared(&raster(), band, FilmPart::Whole).apply(band, &film, None).0;
        let wave = |(i, light): (usize, &f32)| {
            let offset = DVec2::new((i % SIZE[0]) as f64 - 300.0, (i / SIZE[0]) as f64 - 200.0) * PIXEL_MM;
            f64::from(*light) * sin_cos(core::f64::consts::TAU * frequency.dot(offset)).1
        };
        let actual: f64 = image.samples().iter().enumerate().map(wave).sum();
        assert!((actual - expected).abs() < 2e-3, "{nm}: {actual} for {expected}");
    }
}

#[test]
fn samples_are_displaced_by_narrow_functions_and_wide_ones_are_refused() {
    let narrow = |radius_mm: f64| {
        let width = 0.0012 + 0.0005 * radius_mm;
        function(DVec2::NEG_Y * radius_mm, |a, b| {
            let a = a - 0.002 * radius_mm;
            exp(-0.5 * (a * a + b * b) / (width * width))
        })
    };
    let narrow = table((0..=6).map(|i| narrow(0.25 * f64::from(i))).collect(), Some([5, 5])).expect("legal");
    let of_samples = effects(narrow, Some(SpreadMethod::Samples));
    let cores = of_samples.sample_spread(&raster(), WavelengthRange::new(500.0, 600.0)).expect("it is narrow");
    for (pixel, outwards) in [([580, 200], DVec2::X), ([300, 10], DVec2::NEG_Y)] {
        let samples = 40_000;
        let sample = |i: u32| {
            let u = |by: f64| (f64::from(i) * by).fract();
            let numbers = SpreadRandomNumbers {
                choice: u(0.569_840_290_998),
                place: DVec2::new(u(0.754_877_666_247), u(0.618_033_988_75)),
            };
            cores.sample_offset(Pixel { x: pixel[0], y: pixel[1] }, &[550.0], numbers).0
        };
        let mean = (0..samples).map(sample).sum::<DVec2>() / f64::from(samples);
        let radius_mm = place([pixel[0] as usize, pixel[1] as usize]).length();
        let expected = outwards * 0.002 * radius_mm / PIXEL_MM;
        // Light beyond a pixel is partly spread by the film: the mean of the rest lies nearer to the point.
        assert!((mean - expected).length() < 0.06, "{mean} for {expected}");
    }
    let psf = Some(PointSpread::Table(table(growing_functions(DVec2::X), None).expect("legal")));
    let result = Effects::new(
        EffectsParameters { psf, spread_by: Some(SpreadMethod::Samples), ..Default::default() },
        &raster(),
    );
    assert!(matches!(result, Err(EffectsError::WideCore { .. })), "{result:?}");
}

#[test]
fn functions_that_make_no_table_are_refused() {
    let at = |radius: f64| Shape::function(radius, DVec2::X);
    let refused = |fields| table(fields, None).expect_err("no table");
    assert_eq!(refused(vec![]), EffectsError::SpreadTable);
    assert_eq!(refused(vec![at(0.2), at(0.1)]), EffectsError::SpreadTable);
    assert_eq!(refused(vec![at(0.1), at(0.1)]), EffectsError::SpreadTable);
    assert!(matches!(refused(vec![FieldSpread { pitch_um: 4.1, ..at(0.0) }]), EffectsError::CoarseFunction { .. }));
    let wide = FieldSpread { width: 1, light: vec![1.0; 4000], point: [0, 0], ..at(0.0) };
    assert!(matches!(refused(vec![wide]), EffectsError::WideFunction { reach_px: 1250, .. }));
    let dark = FieldSpread { light: vec![0.0; SIDE * SIDE], ..at(0.0) };
    assert_eq!(refused(vec![dark]), EffectsError::Dark);
    let mut light = vec![1.0; SIDE * SIDE];
    light[SIDE + 3] = -0.5;
    let negative = FieldSpread { light, ..at(0.0) };
    assert!(matches!(refused(vec![negative]), EffectsError::NoLight { column: 3, row: 1, .. }));
    let wavelengths = |list: [Option<f64>; 2], second: usize| {
        let second = (0..second).map(|i| at(0.1 * i as f64)).collect();
        let [a, b] = list;
        vec![WavelengthTable { nm: a, fields: vec![at(0.0), at(0.1)] }, WavelengthTable { nm: b, fields: second }]
    };
    for (list, second) in [([Some(500.0), Some(600.0)], 1), ([Some(600.0), Some(500.0)], 2), ([None, Some(500.0)], 2)] {
        let parameters = SpreadTableParameters { wavelengths: wavelengths(list, second), patches: None };
        assert_eq!(SpreadTable::new(parameters, &raster()).expect_err("no table"), EffectsError::SpreadTable);
    }
}

/// Functions of constant width whose centroids move outwards by a tenth of it, undetected by second moments, need more than one patch.
#[test]
fn centroids_that_move_take_patches() {
    let moved = |max_mm: f64| {
        let at = |i: u32| {
            let radius_mm = 0.15 * f64::from(i);
            let fraction = radius_mm / 1.5;
            let shape = Shape { widths: [0.008; 2], offset: [max_mm * fraction * fraction, 0.0] };
            function(DVec2::Y * radius_mm, move |along, across| shape.light(along, across))
        };
        let table = table((0..=10).map(at).collect(), None).expect("legal");
        assert!(table.keeps_shapes());
        table.patches()[0]
    };
    assert_eq!(moved(0.0), 1);
    assert!(moved(0.0008) > 1, "{}", moved(0.0008));
}

/// A table that does not begin on the axis is held inwards; the resulting error of the light there is reported.
#[test]
fn light_within_the_first_distance_is_reported() {
    let one = Shape { widths: [0.008; 2], offset: [0.002, 0.0] };
    let field = function(DVec2::Y * 0.5, |along, across| one.light(along, across));
    let error = table(vec![field], None).expect("legal").light_error();
    assert!((error / (0.002 / 0.5) - 1.0).abs() < 0.01, "{error}");
}
