//! Procedural patterns: gradient noise, dots, and the means of the patterns of positions.
//!
//! Source: K. Perlin, "Improving noise", SIGGRAPH 2002, with the permutation of his reference implementation, as in pbrt-v4.

/// Permutation of 0 to 255.
#[rustfmt::skip]
const PERMUTATION: [u8; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240, 21, 10, 23, 190, 6, 148,
    247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175,
    74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54,
    65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64,
    52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213,
    119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104,
    218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157,
    184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180,
];

/// Mean of the absolute value of the noise over space, by averaging 2·10⁵ random points (0.2181 ± 0.0004).
const MEAN_ABSOLUTE_NOISE: f64 = 0.218;

/// Mean of pbrt's marble over a period of its sine, linear sRGB; `variation` only shifts the phase.
pub(crate) const MARBLE_MEAN: [f64; 3] = [0.8046, 0.8030, 0.8398];

/// Mean of the sum of `octaves` absolute values of noise, each `ratio` times the one before.
pub(crate) fn mean_of_turbulence(octaves: f64, ratio: f64) -> f64 {
    (0..octaves.clamp(0.0, 64.0) as usize)
        .fold((0.0, 1.0), |(sum, weight), _| (sum + weight * MEAN_ABSOLUTE_NOISE, weight * ratio))
        .0
}

/// Noise in the plane z = 0.5.
fn noise(x: f64, y: f64) -> f64 {
    let (cell_x, cell_y) = (x.floor(), y.floor());
    let (dx, dy, dz) = (x - cell_x, y - cell_y, 0.5);
    let corner = |i: usize| {
        let [ox, oy, oz] = [i & 1, (i >> 1) & 1, i >> 2].map(|o| o as f64);
        let weight = |d: f64, o: f64| if o == 1.0 { smooth(d) } else { 1.0 - smooth(d) };
        let offset = [dx - ox, dy - oy, dz - oz];
        weight(dx, ox) * weight(dy, oy) * weight(dz, oz) * gradient([cell_x + ox, cell_y + oy, oz], offset)
    };
    (0..8).map(corner).sum()
}

fn smooth(t: f64) -> f64 {
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

/// Product of the gradient of a lattice point and the offset from it.
fn gradient(lattice: [f64; 3], [dx, dy, dz]: [f64; 3]) -> f64 {
    let next = |hash: usize, cell: f64| usize::from(PERMUTATION[(hash + cell.rem_euclid(256.0) as usize) % 256]);
    let hash = lattice.into_iter().fold(0, next) & 15;
    let u = if hash < 8 || hash == 12 || hash == 13 { dx } else { dy };
    let v = if hash < 4 || hash == 12 || hash == 13 { dy } else { dz };
    (if hash & 1 == 0 { u } else { -u }) + (if hash & 2 == 0 { v } else { -v })
}

/// Returns true inside one of the dots of radius 0.35, which the cells of positive noise have.
pub(crate) fn is_in_dot([s, t]: [f64; 2]) -> bool {
    const RADIUS: f64 = 0.35;
    let (cell_s, cell_t) = ((s + 0.5).floor(), (t + 0.5).floor());
    if noise(cell_s + 0.5, cell_t + 0.5) <= 0.0 {
        return false;
    }
    let shift = 0.5 - RADIUS;
    let ds = s - (cell_s + shift * noise(cell_s + 1.5, cell_t + 2.8));
    let dt = t - (cell_t + shift * noise(cell_s + 4.5, cell_t + 9.8));
    ds * ds + dt * dt < RADIUS * RADIUS
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of an evaluation of the paper's formulas in Python.
    #[test]
    fn noise_is_that_of_the_paper() {
        for (x, y, expected) in
            [(0.5, 0.5, -0.125), (1.5, 2.8, 0.569_592), (-3.25, 7.75, 0.260_339_260_101_318_36), (4.5, 9.8, -0.208_008)]
        {
            let actual = noise(x, y);
            assert!((actual - expected).abs() < 1e-12, "({x}, {y}): {actual}");
        }
    }

    #[test]
    fn turbulence_is_a_geometric_sum() {
        let actual = mean_of_turbulence(8.0, 0.5);
        assert!((actual - 0.218 * (1.0 - 1.0 / 256.0) / 0.5).abs() < 1e-12, "{actual}");
    }
}
