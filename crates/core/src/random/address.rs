//! Addresses of random numbers.
//!
//! Philox4x32-10, a counter-based generator (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3").

/// A pixel of a camera's raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Pixel {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
}

/// Part of a random address that all pixels of an image share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FrameAddress {
    /// The job's seed.
    pub seed: u64,
    /// Index of the camera in the job, from 0.
    pub camera: u32,
    /// Frame, from 0. Frame 0 for the render of a static world.
    pub frame: u32,
    /// Capture within the frame, from 0. An image merged from all captures has that of the first.
    pub capture: u32,
}

/// Part of a random address that all samples of a pixel share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PixelAddress {
    /// Image.
    pub frame: FrameAddress,
    pub pixel: Pixel,
    /// The independently scrambled replicate.
    pub replicate: u32,
}

impl PixelAddress {
    /// A 64-bit key of the whole address.
    #[inline]
    #[must_use]
    pub fn key(&self) -> u64 {
        let FrameAddress { seed, camera, frame, capture } = self.frame;
        let words = [
            u64::from(camera) | u64::from(frame) << 32,
            u64::from(capture) | u64::from(self.replicate) << 32,
            u64::from(self.pixel.x) | u64::from(self.pixel.y) << 32,
        ];
        words.into_iter().fold(mix(seed ^ 0x9e37_79b9_7f4a_7c15), |key, word| mix(key ^ mix(word)))
    }
}

/// Purpose of a random number of a path. Append-only: the discriminants are part of the guaranteed bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Draw {
    /// The hero wavelength. Sub-counter 0.
    Wavelength = 0,
    /// The point of the pixel's photosensitive area.
    PixelArea = 1,
    /// The point of the pupil.
    Pupil = 2,
    /// The time within the exposure.
    Time = 3,
    /// Choice of a light at a vertex; the sub-counter is the vertex's number on the path.
    LightChoice = 4,
    /// The point of that light.
    LightPoint = 5,
    /// Choice of a lobe or component of a material at a vertex.
    BsdfChoice = 6,
    /// Scattering direction of a material.
    BsdfDirection = 7,
    /// Russian roulette at a vertex.
    Roulette = 8,
    /// Stochastic opacity: whether a partly transparent surface lets a ray pass.
    Opacity = 9,
    /// Choice of a component of a mixed material at a vertex.
    Mix = 10,
    /// Choice of the paths that are continued, in a group of paths that share tails.
    Followed = 11,
    /// Free-flight distance in a medium; the sub-counter counts the path's flights.
    FreeFlight = 12,
    /// Event at a collision in a medium.
    Collision = 13,
    /// Step along a ray to a light through a heterogeneous medium.
    Transmittance = 14,
    /// Choice of the wavelength whose phase function gives the direction, and the direction; the sub-counter is the vertex's.
    PhaseDirection = 15,
    /// Position along a ray at which in-scattered light is sampled, and choice of the lamp.
    InScattering = 16,
    /// Reflection or refraction at the interfaces of a drop; sixteen sub-counters per vertex.
    DropInterface = 17,
    /// Displacement of a sample by the point spread; at sub-counter 1, choice of its wavelength and patch.
    PointSpread = 18,
}

/// A bijection of 64-bit words that scatters its bits (the finaliser of splitmix64, Steele et al. 2014).
#[inline]
pub(super) fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Ten rounds of Philox on a 128-bit counter under a 64-bit key: four independent words.
#[must_use]
pub fn philox4x32(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    let mut c = counter;
    let mut k = key;
    for _ in 0..10 {
        let p0 = u64::from(c[0]) * 0xd251_1f53;
        let p1 = u64::from(c[2]) * 0xcd9e_8d57;
        c = [(p1 >> 32) as u32 ^ c[1] ^ k[0], p1 as u32, (p0 >> 32) as u32 ^ c[3] ^ k[1], p0 as u32];
        k = [k[0].wrapping_add(0x9e37_79b9), k[1].wrapping_add(0xbb67_ae85)];
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known answers of the authors' Random123 distribution (kat_vectors, philox4x32 10).
    #[test]
    fn known_answers() {
        assert_eq!(philox4x32([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox4x32([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        assert_eq!(
            philox4x32([0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344], [0xa409_3822, 0x299f_31d0]),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }
}
