//! Addresses of random numbers.

/// A pixel of a camera's raster.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Pixel {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
}

/// The part of a random address that a picture's pixels share.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FrameAddress {
    /// The job's seed.
    pub seed: u64,
    /// The camera's place in the job, from 0.
    pub camera: u32,
    /// The frame, from 0. A still world's light is that of frame 0.
    pub frame: u32,
    /// The capture within the frame, from 0; a picture made of all captures has that of the first.
    pub capture: u32,
}

/// The part of a random address that one pixel's samples share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PixelAddress {
    /// The picture.
    pub frame: FrameAddress,
    /// The pixel.
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

/// What a number of a path is used for. Append-only: the discriminants are part of the promised bits.
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
    /// Which light to ask at a vertex; the sub-counter is the vertex's number on the path.
    LightChoice = 4,
    /// The point of that light.
    LightPoint = 5,
    /// Which part of a material to sample at a vertex.
    BsdfChoice = 6,
    /// The direction a material scatters to.
    BsdfDirection = 7,
    /// Russian roulette at a vertex.
    Roulette = 8,
    /// Whether a partly transparent surface lets a ray pass.
    Opacity = 9,
    /// Which part of a mix of materials a path meets at a vertex.
    Mix = 10,
    /// Which paths of a group that shares its tails are followed on.
    Followed = 11,
    /// How far light flies in a medium; the sub-counter counts the path's flights.
    FreeFlight = 12,
    /// What happens to it there.
    Collision = 13,
    /// A step along a ray to a light through an uneven medium.
    Transmittance = 14,
    /// Which wavelength's phase function gives the direction, and the direction; the sub-counter is the vertex's.
    PhaseDirection = 15,
    /// Where along a ray light of a lamp is looked for, and which lamp.
    InScattering = 16,
    /// Which way light takes at the interfaces of a drop; sixteen sub-counters a vertex.
    DropInterface = 17,
    /// How far the point spread displaces a sample; at sub-counter 1, by which wavelength and patch of it.
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
