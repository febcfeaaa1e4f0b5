//! The corner of four squares by a local model of the image.
//!
//! ```text
//! I(p) = m + g · d + c P + b (1 − P²)      P = S(l₁) S(l₂)      d = p − q      lᵢ = nᵢ · d + κᵢ (tᵢ · d)²
//! ```
//!
//! q is the corner, t₁ and t₂ the edges' directions there, n their normals, κ their curvature. S is the profile of a blurred
//! edge, tanh(l/s), averaged over a pixel's width: S(l) = s ln cosh((l + ½)/s) − s ln cosh((l − ½)/s). A pixel is a square of
//! variance 1/12 px² along any direction, as is this width. The model therefore fits edges of any sharpness, even those blurred
//! by pixels only, without the bias of gradients there. b is the additional brightness of the edges: squares of one kind larger
//! than those of the other (print, bleeding light), or an image that is not linear in light. Least squares of twelve parameters
//! over the pixels within a radius (Gauss & Newton, damped).
//!
//! The standard uncertainty of q is that due to the residuals rᵢ, treated as noise: with aᵢ the change of q for a change of pixel
//! i, the larger of σ² Σ aᵢ² and Σᵢⱼ k aᵢ rᵢ aⱼ rⱼ over pixels less than four apart (k falls linearly, Newey & West 1987, Conley
//! 1999). Compressed or demosaiced images, and misfits of the model, have correlated residuals.
//!
//! Limitations: asymmetric blur (coma shifts the corner by its centroid), squares of unequal brightness on one side.

use etendue_core::maths::f64::{atan2, exp, ln_1p, sin_cos};
use glam::DVec2;

use crate::Image;
use crate::linear::{Cholesky, Matrix};

/// A corner and the standard uncertainty of its coordinates (root mean square of both), px.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: DVec2,
    pub(super) uncertainty_px: f64,
}

/// Number of parameters of the model: q, θ₁, θ₂, κ₁, κ₂, s, m, c, g, b.
const COUNT: usize = 12;
type Numbers = [f64; COUNT];

/// Sharpest and softest profile, px.
const SOFTNESS_PX: [f64; 2] = [0.05, 6.0];

/// Fits the corner near `start`, whose edges have the directions of `steps`, to the pixels within `radius` px; `None` if the
/// model does not converge within half of that.
pub(super) fn fit_corner(image: &Image, start: DVec2, steps: [DVec2; 2], radius: f64) -> Option<Corner> {
    const STEPS: usize = 40;
    let pixels = pixels(image, start, radius)?;
    let mut at = first_guess(&pixels, start, steps);
    let (mut normal, mut squares) = equations(&pixels, &at);
    let mut lambda = 1e-3;
    for _ in 0..STEPS {
        let Some(next) = moved(&at, &normal.0, &normal.1, lambda) else {
            lambda *= 10.0;
            continue;
        };
        let (next_normal, next_squares) = equations(&pixels, &next);
        if next_squares > squares {
            lambda *= 10.0;
            if lambda > 1e6 {
                break;
            }
            continue;
        }
        let shift = DVec2::new(next[0] - at[0], next[1] - at[1]).length();
        // Undamped, convergence is quadratic: the next step would be a millionth.
        let settled = lambda < 1e-2 && shift < 1e-3 && squares - next_squares <= 1e-4 * squares;
        (at, normal, squares) = (next, next_normal, next_squares);
        lambda = (0.1 * lambda).max(1e-9);
        if settled {
            break;
        }
    }
    let corner = DVec2::new(at[0], at[1]);
    let variance = squares / (pixels.len() - COUNT) as f64;
    let covariance = Cholesky::new(&normal.0, 1e-14)?.inverse();
    let white = variance * (covariance.at(0, 0) + covariance.at(1, 1));
    let uncertainty_px = (0.5 * white.max(correlated(&pixels, &at, &covariance))).sqrt();
    ((corner - start).length() < 0.5 * radius).then_some(Corner { at: corner, uncertainty_px })
}

/// The variance of q, both coordinates together, from correlated residuals.
fn correlated(pixels: &[(DVec2, f64)], at: &Numbers, covariance: &Matrix) -> f64 {
    const REACH: isize = 4;
    let corner = pixels.iter().fold(DVec2::INFINITY, |low, (p, _)| low.min(*p));
    let side = pixels.iter().fold(0.0, |side: f64, (p, _)| side.max((*p - corner).max_element())) as isize + 1;
    let mut gradient_sums = vec![DVec2::ZERO; (side * side) as usize];
    let place = |p: DVec2| ((p.y - corner.y) as isize, (p.x - corner.x) as isize);
    for (p, value) in pixels {
        let (model, by) = model(at, *p);
        let lever = |row: usize| by.iter().enumerate().map(|(i, b)| covariance.at(row, i) * b).sum::<f64>();
        let (y, x) = place(*p);
        gradient_sums[(y * side + x) as usize] = (model - value) * DVec2::new(lever(0), lever(1));
    }
    let near = |y: isize, x: isize, by: [isize; 2]| {
        let (v, u) = (y + by[0], x + by[1]);
        let inside = (0..side).contains(&v) && (0..side).contains(&u);
        if inside { gradient_sums[(v * side + u) as usize] } else { DVec2::ZERO }
    };
    let weight = |by: isize| 1.0 - by.abs() as f64 / REACH as f64;
    let offsets = || (1 - REACH..REACH).flat_map(|v| (1 - REACH..REACH).map(move |u| [v, u]));
    let shared = |p: DVec2| {
        let (y, x) = place(p);
        let around: DVec2 = offsets().map(|by| weight(by[0]) * weight(by[1]) * near(y, x, by)).sum();
        gradient_sums[(y * side + x) as usize].dot(around)
    };
    pixels.iter().map(|(p, _)| shared(*p)).sum()
}

/// Centres and values within a radius; `None` if the image does not contain them all.
fn pixels(image: &Image, centre: DVec2, radius: f64) -> Option<Vec<(DVec2, f64)>> {
    let inside = |size: usize, c: f64| c - radius >= 0.0 && c + radius <= size as f64;
    if !(inside(image.width(), centre.x) && inside(image.height(), centre.y)) {
        return None;
    }
    let range = |c: f64, size: usize| ((c - radius) as usize)..((c + radius).ceil() as usize).min(size);
    let all = range(centre.y, image.height()).flat_map(|y| range(centre.x, image.width()).map(move |x| (x, y)));
    let placed = all.map(|(x, y)| (DVec2::new(x as f64 + 0.5, y as f64 + 0.5), f64::from(image.at(x, y))));
    let near: Vec<_> = placed.filter(|(p, _)| (*p - centre).length_squared() <= radius * radius).collect();
    (near.len() > 2 * COUNT).then_some(near)
}

fn first_guess(pixels: &[(DVec2, f64)], start: DVec2, steps: [DVec2; 2]) -> Numbers {
    let [a, b] = steps.map(|s| atan2(s.y, s.x));
    let mut numbers = [start.x, start.y, a, b, 0.0, 0.0, 0.7, 0.0, 1.0, 0.0, 0.0, 0.0];
    let count = pixels.len() as f64;
    let mean = pixels.iter().map(|(_, v)| v).sum::<f64>() / count;
    numbers[7] = 0.0;
    let (mut product, mut square) = (0.0, 0.0);
    for (p, value) in pixels {
        let shape = model(&numbers, *p).0;
        product += shape * (value - mean);
        square += shape * shape;
    }
    (numbers[7], numbers[8]) = (mean, product / square);
    numbers
}

/// −ln of the deviation of a profile from its limit that counts as zero.
const FLAT_LEVEL: f64 = 20.0;

/// S, dS/dl and dS/ds.
fn profile(l: f64, s: f64) -> [f64; 3] {
    // s ln(2 cosh(x/s)) = |x| + s ln(1 + e), e = exp(−2 |x|/s).
    let end = |x: f64| {
        let ratio = 2.0 * x.abs() / s;
        if ratio > FLAT_LEVEL {
            return [x.abs(), x.signum(), 0.0];
        }
        let e = exp(-ratio);
        let log = ln_1p(e);
        [x.abs() + s * log, x.signum() * (1.0 - e) / (1.0 + e), log + ratio * e / (1.0 + e)]
    };
    let (high, low) = (end(l + 0.5), end(l - 0.5));
    std::array::from_fn(|i| high[i] - low[i])
}

/// The model at a pixel and its derivatives.
fn model(n: &Numbers, pixel: DVec2) -> (f64, Numbers) {
    let [x, y, angle_1, angle_2, bend_1, bend_2, s, m, c, slope_x, slope_y, falloff] = *n;
    let d = pixel - DVec2::new(x, y);
    let edge = |angle: f64, bend: f64| {
        let (sin, cos) = sin_cos(angle);
        let (t, n) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
        let (along, across) = (t.dot(d), n.dot(d));
        let by_place = -(n + 2.0 * bend * along * t);
        (profile(across + bend * along * along, s), by_place, 2.0 * bend * along * across - along, along * along)
    };
    let ([s1, d1, e1], q1, a1, b1) = edge(angle_1, bend_1);
    let ([s2, d2, e2], q2, a2, b2) = edge(angle_2, bend_2);
    let product = s1 * s2;
    let value = m + slope_x * d.x + slope_y * d.y + c * product + falloff * (1.0 - product * product);
    // dI/dP.
    let c = c - 2.0 * falloff * product;
    let q = c * (d1 * s2 * q1 + s1 * d2 * q2) - DVec2::new(slope_x, slope_y);
    let by = [
        q.x,
        q.y,
        c * d1 * s2 * a1,
        c * s1 * d2 * a2,
        c * d1 * s2 * b1,
        c * s1 * d2 * b2,
        c * (e1 * s2 + s1 * e2),
        1.0,
        product,
        d.x,
        d.y,
        1.0 - product * product,
    ];
    (value, by)
}

/// JᵀJ and Jᵀr, with the sum of squared residuals.
fn equations(pixels: &[(DVec2, f64)], at: &Numbers) -> ((Matrix, Numbers), f64) {
    let (mut upper, mut gradient, mut squares) = ([[0.0; COUNT]; COUNT], [0.0; COUNT], 0.0);
    for (p, value) in pixels {
        let (model, by) = model(at, *p);
        let residual = model - value;
        squares += residual * residual;
        for i in 0..COUNT {
            gradient[i] += by[i] * residual;
            for j in i..COUNT {
                upper[i][j] += by[i] * by[j];
            }
        }
    }
    // Edges sharper than the pixels can resolve leave s unchanged.
    upper[6][6] += 1e-6 * upper[8][8];
    let row = |i: usize| std::array::from_fn::<f64, COUNT, _>(|j| upper[i.min(j)][i.max(j)]);
    ((Matrix::from_rows(COUNT, (0..COUNT).map(row)), gradient), squares)
}

fn moved(at: &Numbers, normal: &Matrix, gradient: &Numbers, lambda: f64) -> Option<Numbers> {
    let mut damped = normal.clone();
    (0..COUNT).for_each(|i| *damped.at_mut(i, i) *= 1.0 + lambda);
    let step = Cholesky::new(&damped, 1e-14)?.solve(&gradient.map(|g| -g));
    let mut next: Numbers = std::array::from_fn(|i| at[i] + step[i]);
    next[6] = next[6].clamp((at[6] / 3.0).max(SOFTNESS_PX[0]), (at[6] * 3.0).min(SOFTNESS_PX[1]));
    Some(next)
}
