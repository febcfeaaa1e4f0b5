//! A clear sky as an equirectangular picture of luminance, cd/m².
//!
//! Luminance distribution: CIE standard general sky, type 12, "clear sky, low luminance turbidity" (ISO 15469:2004,
//! CIE S 011): L/Lz = f(χ) φ(Z) / (f(Zs) φ(0)), φ(Z) = 1 + a exp(b / cos Z), f(χ) = 1 + c (exp(d χ) − exp(d π/2)) + e cos² χ,
//! Z the angle from the zenith, χ from the sun. Scaled so that the sky alone gives the stated illuminance on a
//! horizontal plane. Colours run from daylight of 8 000 K at the horizon to 20 000 K at the zenith: a stand-in for the
//! measured gradient. The sun's disc is not in the picture; below the horizon stands ground of one reflectance.

use crate::hdr::hdr;
use etendue_core::maths::f64 as maths;
use glam::DVec3;

/// Columns and rows.
pub const SIZE: [usize; 2] = [256, 128];

/// a, b, c, d, e of sky type 12.
const TYPE_12: [f64; 5] = [-1.0, -0.32, 10.0, -3.0, 0.45];

/// Linear sRGB of luminance 1 for daylight of 8 000 K and 20 000 K (xy 0.295, 0.305 and 0.257, 0.258).
const HORIZON: DVec3 = DVec3::new(0.947, 0.992, 1.237);
const ZENITH: DVec3 = DVec3::new(0.747, 0.990, 1.844);

/// What the sky is made from.
#[derive(Clone, Copy, Debug)]
pub struct ClearSky {
    /// Elevation of the sun above the horizon, degrees.
    pub sun_elevation_deg: f64,
    /// Azimuth of the sun from +x towards +y, degrees.
    pub sun_azimuth_deg: f64,
    /// Illuminance of a horizontal plane by the sky without the sun, lx.
    pub diffuse_lx: f64,
    /// Luminance of the ground below the horizon, cd/m².
    pub ground_cd_m2: f64,
}

impl ClearSky {
    /// The unit vector to the sun.
    #[must_use]
    pub fn sun(&self) -> DVec3 {
        let (sa, ca) = maths::sin_cos(self.sun_azimuth_deg.to_radians());
        let (se, ce) = maths::sin_cos(self.sun_elevation_deg.to_radians());
        DVec3::new(ce * ca, ce * sa, se)
    }

    /// Luminance relative to an unknown zenith, at a direction above the horizon.
    fn relative(&self, direction: DVec3) -> f64 {
        let [a, b, c, d, e] = TYPE_12;
        let cos_chi = direction.dot(self.sun()).clamp(-1.0, 1.0);
        let quarter = maths::exp(d * core::f64::consts::FRAC_PI_2);
        let indicatrix = 1.0 + c * (maths::exp(d * maths::acos(cos_chi)) - quarter) + e * cos_chi * cos_chi;
        (1.0 + a * maths::exp(b / direction.z.max(1e-3))) * indicatrix
    }

    /// Illuminance of a horizontal plane by the relative luminance, by the picture's own pixels.
    fn relative_diffuse(&self) -> f64 {
        let pixels = (0..SIZE[1] / 2).flat_map(|row| (0..SIZE[0]).map(move |column| (column, row)));
        pixels
            .map(|(column, row)| self.relative(direction(column, row)) * direction(column, row).z * solid_angle(row))
            .sum()
    }

    /// Luminance and colour of every pixel: linear sRGB whose luminance is in cd/m².
    #[must_use]
    pub fn pixels(&self) -> Vec<[f64; 3]> {
        let scale = self.diffuse_lx / self.relative_diffuse();
        let pixel = |column: usize, row: usize| {
            let direction = direction(column, row);
            if direction.z < 0.0 {
                return DVec3::new(1.0, 1.0, 0.9) * self.ground_cd_m2;
            }
            let blue = 1.0 - (1.0 - direction.z) * (1.0 - direction.z);
            (HORIZON + (ZENITH - HORIZON) * blue) * self.relative(direction) * scale
        };
        let rows = (0..SIZE[1]).flat_map(|row| (0..SIZE[0]).map(move |column| (column, row)));
        rows.map(|(column, row)| pixel(column, row).to_array()).collect()
    }

    /// The picture's file.
    #[must_use]
    pub fn file(&self) -> Vec<u8> {
        hdr(SIZE[0], &self.pixels())
    }
}

/// The direction of a pixel's centre: row 0 at the zenith; the middle column looks along +x, columns to the right
/// turn towards −y, as the sky is seen from inside.
fn direction(column: usize, row: usize) -> DVec3 {
    let azimuth = (0.5 - (column as f64 + 0.5) / SIZE[0] as f64) * core::f64::consts::TAU;
    let zenith = (row as f64 + 0.5) / SIZE[1] as f64 * core::f64::consts::PI;
    let ((sa, ca), (sz, cz)) = (maths::sin_cos(azimuth), maths::sin_cos(zenith));
    DVec3::new(sz * ca, sz * sa, cz)
}

/// Solid angle of a pixel, sr.
fn solid_angle(row: usize) -> f64 {
    let edge = |row: usize| maths::cos(row as f64 / SIZE[1] as f64 * core::f64::consts::PI);
    core::f64::consts::TAU / SIZE[0] as f64 * (edge(row) - edge(row + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKY: ClearSky =
        ClearSky { sun_elevation_deg: 38.0, sun_azimuth_deg: 150.0, diffuse_lx: 13_000.0, ground_cd_m2: 2800.0 };

    #[test]
    fn the_sky_gives_its_illuminance() {
        let luminance = |p: [f64; 3]| 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
        let pixels = SKY.pixels();
        let part = |(i, p): (usize, &[f64; 3])| {
            let z = direction(i % SIZE[0], i / SIZE[0]).z.max(0.0);
            luminance(*p) * z * solid_angle(i / SIZE[0])
        };
        let lux: f64 = pixels.iter().enumerate().map(part).sum();
        // The two end colours have luminance 1 within 0.3 % by their three decimals.
        assert!((lux / 13_000.0 - 1.0).abs() < 5e-3, "{lux}");
    }

    #[test]
    fn the_brightest_pixel_is_at_the_sun() {
        let pixels = SKY.pixels();
        let best = (0..pixels.len()).max_by(|&a, &b| pixels[a][1].total_cmp(&pixels[b][1])).unwrap();
        let at = direction(best % SIZE[0], best / SIZE[0]);
        // Half a pixel's diagonal, and the gradient towards the horizon pulls by less than another two pixels.
        assert!(at.dot(SKY.sun()) > maths::cos(0.08), "{at}");
    }
}
