//! Drops of rain on the image. The paper (its second rain filter) computes "a new texture from the initial camera rendering. For each drop, the
//! original image is inverted in order to simulate the real effect of a rain drop", with a count of drops, a smallest and a largest size and "fades
//! parameters (speed at which the drops flow and disappear)". It gives no formulas; this is **our interpretation**, on linear light:
//!
//! ```text
//! y = (1 − w) x + w b(c − s (p − c))      b: the image, blurred by a Gaussian of σ = s · blur
//! w = (1 − age/fade) min(1, (r − |p − c|)/blur)
//! ```
//!
//! for a pixel p in a drop of radius r about c: the disc shows its surroundings upside down and s times smaller, clamped at the image's edge. Drops
//! are independent and uniform over the image, radii uniform between their ends; later drops cover earlier ones. With a fade each drop lives for that
//! number of frames, flows downwards meanwhile, and reappears elsewhere; drops begin at different ages.
//!
//! A drop cannot show points outside the image, and sizes, blur and brightness are not derived from optics: use the traced drops of a windscreen to
//! predict a camera.

use etendue_core::random::{FrameAddress, philox4x32};
use etendue_core::{Plane, quantity::LinearRgb};

use super::{FilterError, demand};
use crate::detail;

/// Drops on the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drops {
    /// Number of drops, 1 to 100 000.
    pub count: u32,
    /// Smallest and largest radius, px, above 0.
    pub radius_px: [f64; 2],
    /// Reduction factor of the image in a drop, above 0.
    pub scale: f64,
    /// σ of its blur, and width of its soft edge, px, above 0; times `scale` at most 500.
    pub blur_px: f64,
    /// Downward flow of a drop from frame to frame, px, 0 or more.
    pub flow_px_per_frame: f64,
    /// Lifetime of a drop in frames, fading; `None` for static drops.
    pub fade_frames: Option<u32>,
}

/// A drop in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Disc {
    centre_px: [f64; 2],
    radius_px: f64,
    opacity: f64,
}

/// Separates these random numbers from others of the same seed.
const DOMAIN: u32 = 0x7261_696e;

impl Drops {
    pub(super) fn check(&self) -> Result<(), FilterError> {
        let count = f64::from(self.count);
        demand((1.0..=1e5).contains(&count), "count", count, "from 1 to 100 000")?;
        let [minimum, maximum] = self.radius_px;
        demand(minimum > 0.0 && minimum <= maximum, "min_radius_px", minimum, "above 0 and at most max_radius_px")?;
        demand(maximum.is_finite(), "max_radius_px", maximum, "that is finite")?;
        demand(self.scale > 0.0, "scale", self.scale, "above 0")?;
        let blur = self.blur_px;
        let of_picture = blur * self.scale;
        demand(blur > 0.0 && of_picture <= 500.0, "blur_px", blur, "above 0 and, times scale, at most 500")?;
        demand(self.flow_px_per_frame >= 0.0, "flow_px_per_frame", self.flow_px_per_frame, "of 0 or more")?;
        demand(self.fade_frames != Some(0), "fade_frames", 0.0, "of 1 or more")
    }

    pub(super) fn apply(&self, image: &mut Plane<LinearRgb>, address: FrameAddress) {
        let (width, height) = (image.width(), image.height());
        if width == 0 || height == 0 {
            return;
        }
        let blurred = detail::gaussian(image.samples(), width, self.blur_px * self.scale);
        for i in 0..self.count {
            let drop = self.drop(i, [width as f64, height as f64], address);
            self.blend(drop, image, &blurred);
        }
    }

    /// The drop of a number in a frame.
    fn drop(&self, number: u32, size_px: [f64; 2], address: FrameAddress) -> Disc {
        let key = [address.seed as u32, (address.seed >> 32) as u32];
        let words = |life: u32| {
            philox4x32([number, life, address.camera, DOMAIN], key).map(|w| (f64::from(w) + 0.5) / 4_294_967_296.0)
        };
        let (life, age, left) = match self.fade_frames {
            None => (0, 0.0, 1.0),
            Some(frames) => {
                // The first random numbers give no life but the age in frame 0.
                let first = (words(u32::MAX)[0] * f64::from(frames)) as u64;
                let since = first + u64::from(address.frame);
                let age = (since % u64::from(frames)) as f64;
                ((since / u64::from(frames)) as u32, age, 1.0 - age / f64::from(frames))
            }
        };
        let [x, y, size, _] = words(life);
        let [minimum, maximum] = self.radius_px;
        Disc {
            centre_px: [x * size_px[0], y * size_px[1] + self.flow_px_per_frame * age],
            radius_px: minimum + size * (maximum - minimum),
            opacity: left,
        }
    }

    /// Draws a drop that shows the blurred image.
    fn blend(&self, drop: Disc, image: &mut Plane<LinearRgb>, blurred: &[[f32; 3]]) {
        let (width, height) = (image.width(), image.height());
        let Disc { centre_px: [cx, cy], radius_px: r, opacity } = drop;
        let range = |c: f64, length: usize| {
            let end = |at: f64| at.clamp(0.0, length as f64) as usize;
            end((c - r).floor())..end((c + r).ceil())
        };
        for y in range(cy, height) {
            for x in range(cx, width) {
                let (dx, dy) = (x as f64 + 0.5 - cx, y as f64 + 0.5 - cy);
                let inside = r - (dx * dx + dy * dy).sqrt();
                if inside <= 0.0 {
                    continue;
                }
                let weight = (opacity * (inside / self.blur_px).min(1.0)) as f32;
                let at = |c: f64, d: f64, length: usize| (c - self.scale * d).clamp(0.0, length as f64 - 1.0) as usize;
                let blurred_colour = blurred[at(cy, dy, height) * width + at(cx, dx, width)];
                let here = image.at(x, y);
                image.set(x, y, core::array::from_fn(|c| here[c] + weight * (blurred_colour[c] - here[c])));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DROPS: Drops = Drops {
        count: 1,
        radius_px: [20.0, 20.0],
        scale: 2.0,
        blur_px: 0.3,
        flow_px_per_frame: 2.0,
        fade_frames: Some(10),
    };
    const SIZE: [f64; 2] = [200.0, 160.0];

    fn frame(frame: u32) -> FrameAddress {
        FrameAddress { seed: 3, camera: 0, frame, capture: 0 }
    }

    /// An upward ramp appears as a downward one, twice as steep.
    #[test]
    fn a_drop_shows_the_image_upside_down_and_smaller() {
        let still = Drops { fade_frames: None, ..DROPS };
        // The first seed whose drop lies well inside the image.
        let of = |seed| FrameAddress { seed, ..frame(5) };
        let centre = |seed| still.drop(0, SIZE, of(seed)).centre_px;
        let is_inside = |seed: &u64| {
            let [x, y] = centre(*seed);
            (70.0..130.0).contains(&x) && (60.0..100.0).contains(&y)
        };
        let seed = (0..1000).find(is_inside).expect("a drop in the middle");
        let [cx, cy] = centre(seed);
        let mut ramp = Plane::filled(200, 160, [0.0; 3]);
        (0..160).for_each(|y| (0..200).for_each(|x| ramp.set(x, y, [y as f32, x as f32, 1.0])));
        let mut image = ramp.clone();
        still.apply(&mut image, of(seed));
        let (x, y) = (cx as usize, cy as usize);
        // Nearest pixels: steps of 2 within one pixel.
        for (dx, dy) in [(0_i32, 0_i32), (5, 0), (0, 8), (-10, 4)] {
            let at = |c: usize, d: i32| (c as i64 + i64::from(d)) as usize;
            let [v, u, one] = image.at(at(x, dx), at(y, dy));
            assert!((f64::from(v) - (y as f64 - 2.0 * f64::from(dy))).abs() <= 2.0, "{dx} {dy}: {v}");
            assert!((f64::from(u) - (x as f64 - 2.0 * f64::from(dx))).abs() <= 2.0, "{dx} {dy}: {u}");
            assert!((one - 1.0).abs() < 1e-5, "even light stays");
        }
        let changed = image.samples().iter().zip(ramp.samples()).filter(|(a, b)| a != b).count() as f64;
        // The disc of 20 px, 1 257 pixels.
        assert!(changed > 1150.0 && changed < 1300.0, "{changed}");
    }

    #[test]
    fn drops_flow_fade_and_are_born_anew_at_their_own_times() {
        let of = |k| DROPS.drop(4, SIZE, frame(k));
        for k in 0..30 {
            let (a, b) = (of(k), of(k + 1));
            if b.opacity < a.opacity {
                assert!((b.centre_px[1] - a.centre_px[1] - 2.0).abs() < 1e-9 && a.centre_px[0] == b.centre_px[0]);
                assert!((a.opacity - b.opacity - 0.1).abs() < 1e-9);
            } else {
                assert!((b.opacity - 1.0).abs() < 1e-12 && a.centre_px[0] != b.centre_px[0]);
            }
        }
        let ages: std::collections::BTreeSet<u64> =
            (0..40).map(|i| (DROPS.drop(i, SIZE, frame(0)).opacity * 100.0) as u64).collect();
        assert!(ages.len() > 6, "{ages:?}");
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        assert!(DROPS.check().is_ok());
        for wrong in [
            Drops { count: 0, ..DROPS },
            Drops { radius_px: [3.0, 2.0], ..DROPS },
            Drops { radius_px: [0.0, 2.0], ..DROPS },
            Drops { scale: 0.0, ..DROPS },
            Drops { blur_px: 0.0, ..DROPS },
            Drops { blur_px: 251.0, ..DROPS },
            Drops { flow_px_per_frame: -1.0, ..DROPS },
            Drops { fade_frames: Some(0), ..DROPS },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
        DROPS.apply(&mut Plane::new(0, 0), frame(0));
    }
}
