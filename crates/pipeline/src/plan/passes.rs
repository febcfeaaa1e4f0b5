//! Passes, whose weighted mean is a camera's light.
//!
//! A pass is an independent render: its replicates have their own numbers (those of pass p are R·p … R·p + R − 1), so that passes are independent, each
//! stratified by itself. A pass over part of the pixels takes those whose position in a low-discrepancy sequence over the plane falls in the part (R2, with
//! the powers of 1/ρ, ρ³ = ρ + 1; M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018). The next such pass continues where it ended.

use etendue_core::random::Pixel;
use sha2::{Digest, Sha256};

/// Unit in which parts of the pixels are counted: 256ths.
pub const PARTS: u32 = 256;

/// Maximum number of passes of a film.
pub const MAX_PASSES: usize = 64;

/// A pass: a number of samples of all pixels, or of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// Samples of each of its pixels, over all replicates.
    pub samples: u32,
    /// Part of the pixels, in 256ths.
    pub part: u32,
}

impl Pass {
    /// A pass over all pixels.
    #[must_use]
    pub fn all_pixels(samples: u32) -> Self {
        Self { samples, part: PARTS }
    }

    /// Converts an entry of a list of passes: samples per pixel, a multiple of `replicates` or, on average, fewer than these. `None` if it is neither.
    #[must_use]
    pub fn from_number(number: f64, replicates: u32) -> Option<Self> {
        let max = f64::from(replicates);
        if number < max {
            let part = (number / max * f64::from(PARTS)).round() as u32;
            return Some(Self { samples: replicates, part: part.clamp(1, PARTS) });
        }
        let is_multiple = number.fract() == 0.0 && (number as u64).is_multiple_of(replicates.into());
        is_multiple.then(|| Self::all_pixels(number as u32))
    }

    /// Entry in a list of passes.
    #[must_use]
    pub fn number(self) -> f64 {
        f64::from(self.samples) * f64::from(self.part) / f64::from(PARTS)
    }

    /// Returns true if it takes all pixels.
    #[must_use]
    pub fn is_whole(self) -> bool {
        self.part == PARTS
    }
}

/// Passes of a film, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Passes(Vec<Pass>);

impl Passes {
    /// Passes in this order.
    #[must_use]
    pub fn new(list: Vec<Pass>) -> Self {
        Self(list)
    }

    /// Passes that refine an image of `spp` samples: two samples of each replicate, then as many as all so far, up to the remainder, which is at least half
    /// of that.
    #[must_use]
    pub fn doubling(spp: u32, replicates: u32) -> Self {
        let (mut list, mut done) = (Vec::new(), 0);
        while done < spp {
            let next = done.max(2 * replicates);
            let left = spp - done;
            let samples = if left < next + next / 2 { left } else { next };
            list.push(Pass::all_pixels(samples));
            done += samples;
        }
        Self(list)
    }

    /// The passes as a slice.
    #[must_use]
    pub fn list(&self) -> &[Pass] {
        &self.0
    }

    /// Appends a pass.
    pub fn push(&mut self, pass: Pass) {
        self.0.push(pass);
    }

    /// Minimum samples of a pixel.
    #[must_use]
    pub fn spp(&self) -> u32 {
        self.0.iter().filter(|pass| pass.is_whole()).map(|pass| pass.samples).sum()
    }

    /// Mean samples per pixel.
    #[must_use]
    pub fn mean_spp(&self) -> f64 {
        self.0.iter().map(|pass| pass.number()).sum()
    }

    /// Pass of a given index, with the passes before it.
    #[must_use]
    pub fn at(&self, number: usize) -> NumberedPass {
        let before = &self.0[..number];
        let parts = before.iter().filter(|pass| !pass.is_whole()).map(|pass| pass.part);
        NumberedPass {
            pass: self.0[number],
            number: number as u32,
            before_spp: before.iter().filter(|pass| pass.is_whole()).map(|pass| pass.samples).sum(),
            first_part: parts.fold(0, |sum, part| (sum + part) % PARTS),
        }
    }

    /// The list in TOML.
    #[must_use]
    pub fn text(&self) -> String {
        let numbers: Vec<String> = self.0.iter().map(|pass| pass.number().to_string()).collect();
        format!("[{}]", numbers.join(", "))
    }

    /// Parses the text of [`Passes::text`]; `None` if it is no valid list of passes.
    #[must_use]
    pub fn from_text(text: &str, replicates: u32) -> Option<Self> {
        let numbers = text.strip_prefix('[')?.strip_suffix(']')?;
        if numbers.is_empty() {
            return Some(Self::default());
        }
        let pass = |number: &str| Pass::from_number(number.parse().ok()?, replicates);
        numbers.split(", ").map(pass).collect::<Option<Vec<_>>>().map(Self)
    }
}

/// Passes of the samples of a camera of a job.
#[derive(Clone, Debug)]
pub(crate) struct CameraPasses {
    /// Replicates of each pass.
    pub(crate) replicates: u32,
    /// True if the command line does not state the replicates.
    pub(crate) is_open: bool,
    /// Passes; `None`: all samples in one.
    pub(crate) passes: Option<Passes>,
}

/// Hash of a plan from `described`, the hash without the sample settings of cameras that have passes.
pub(crate) fn hash_with_passes(described: &[u8; 32], cameras: &[CameraPasses]) -> [u8; 32] {
    if cameras.iter().all(|camera| camera.passes.is_none()) {
        return *described;
    }
    let mut hash = Sha256::new();
    hash.update(described);
    for camera in cameras {
        let passes = camera.passes.as_ref().map_or(&[][..], |passes| passes.list());
        hash.update((passes.len() as u64).to_le_bytes());
        if !passes.is_empty() {
            hash.update(camera.replicates.to_le_bytes());
        }
        for Pass { samples, part } in passes {
            hash.update(samples.to_le_bytes());
            hash.update(part.to_le_bytes());
        }
    }
    hash.finalize().into()
}

/// A pass at its position among the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NumberedPass {
    pub pass: Pass,
    /// Number of passes before it.
    pub number: u32,
    /// Samples of every pixel before it.
    pub before_spp: u32,
    /// Start of its part of the pixels, in 256ths.
    pub first_part: u32,
}

impl NumberedPass {
    /// A single pass.
    #[must_use]
    pub fn only(samples: u32) -> Self {
        Self { pass: Pass::all_pixels(samples), number: 0, before_spp: 0, first_part: 0 }
    }

    /// Returns true if it takes the block of pixels that starts with `first`.
    #[must_use]
    pub fn takes(self, first: Pixel) -> bool {
        if self.pass.is_whole() {
            return true;
        }
        // The fractional parts of 1/ρ and 1/ρ², in units of 2⁻³².
        let place = first.x.wrapping_mul(3_242_174_889).wrapping_add(first.y.wrapping_mul(2_447_445_414));
        let part = place >> 24;
        (part + PARTS - self.first_part) % PARTS < self.pass.part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(passes: &Passes) -> Vec<f64> {
        passes.list().iter().map(|pass| pass.number()).collect()
    }

    #[test]
    fn a_schedule_doubles_and_ends_with_the_rest() {
        for (spp, replicates, expected) in [
            (64, 4, vec![8.0, 8.0, 16.0, 32.0]),
            (72, 4, vec![8.0, 8.0, 16.0, 40.0]),
            (100, 4, vec![8.0, 8.0, 16.0, 32.0, 36.0]),
            (4, 4, vec![4.0]),
            (3, 1, vec![2.0, 1.0]),
        ] {
            let passes = Passes::doubling(spp, replicates);
            assert_eq!(numbers(&passes), expected, "{spp}");
            assert_eq!(passes.spp(), spp);
        }
    }

    #[test]
    fn a_number_is_read_as_it_is_written() {
        let passes: Option<Vec<Pass>> = [8.0, 16.0, 1.5, 0.015_625].iter().map(|n| Pass::from_number(*n, 4)).collect();
        let passes = Passes::new(passes.expect("multiples, or fewer than the replicates"));
        assert_eq!(passes.list()[2], Pass { samples: 4, part: 96 });
        assert_eq!(passes.text(), "[8, 16, 1.5, 0.015625]");
        assert_eq!(Passes::from_text(&passes.text(), 4), Some(passes.clone()));
        assert_eq!((passes.spp(), passes.mean_spp()), (24, 25.515_625));
        assert!([6.0, 4.5].iter().all(|n| Pass::from_number(*n, 4).is_none()));
    }

    /// Each pixel is in exactly one of three parts that cover the whole, and every square of 16 × 16 has its proportion.
    #[test]
    fn parts_follow_one_another_and_are_even() {
        let part = |part| Pass { samples: 4, part };
        let passes = Passes::new(vec![Pass::all_pixels(4), part(100), part(56), part(100)]);
        let takes = |number: usize, x: u32, y: u32| passes.at(number).takes(Pixel { x, y });
        for (x0, y0) in [(0, 0), (160, 96)] {
            let square = || (0..256).map(|i| (x0 + i % 16, y0 + i / 16));
            assert!(square().all(|(x, y)| (1..4).filter(|number| takes(*number, x, y)).count() == 1));
            for (number, expected_count) in [(1, 100), (2, 56)] {
                let count = square().filter(|(x, y)| takes(number, *x, *y)).count();
                // The star discrepancy of 256 points of such a sequence is a few hundredths.
                assert!(count.abs_diff(expected_count) <= 8, "{count} of {expected_count}");
            }
        }
    }
}
