//! An image as a texture, filtered by its footprint.
//!
//! Bilinear between texels; between halved resolutions linear in the logarithm of the footprint (trilinear, Williams 1983). A footprint more than
//! twice as long as wide, such as of a distant road, is read in up to eight places along its long side (after Schilling, Knittel & Strasser 1996,
//! "Texram"), each over its short side, or twice that if the places would leave gaps. Longer footprints are read with gaps: nothing is blurred
//! further, and the samples of the pixel fill them.

use std::sync::Arc;

use etendue_core::{maths::f32::log2, storage::Blocks};
use glam::{Vec2, Vec3};

use super::mipmap::{Level, TexelLevel, pyramid, weighted_pyramid};
use super::projection::{Projection, TextureFootprint};
use super::texels::{Store, Texel, TexelEncoding, Texels, TextureError, TiledError};
use super::tiled::{TileMemory, TiledLevel, levels};
use super::{Channel, Lookup, Wrap};

/// Maximum number of readings along a long footprint.
const MAX_PROBES: f32 = 8.0;

/// Interpolation of texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Between the four nearest texels; the footprint is not used.
    Bilinear,
    /// Also between the two resolutions nearest to the footprint, along its long side.
    #[default]
    Trilinear,
}

/// Placement of a texture on a surface, and its filtering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Value beyond the edges, along u and v.
    pub wrap: [Wrap; 2],
    /// Interpolation of texels.
    pub filter: Filter,
    /// Image coordinates = surface coordinates × `scale` + `offset`.
    pub scale: Vec2,
    /// See `scale`.
    pub offset: Vec2,
    /// Source of the coordinates.
    pub projection: Projection,
}

impl Sampling {
    fn check(&self) -> Result<(), TextureError> {
        if !(self.scale.is_finite() && self.offset.is_finite()) {
            return Err(TextureError::Placement);
        }
        if self.projection.is_legal() { Ok(()) } else { Err(TextureError::Projection) }
    }

    /// Texels of an image per unit of coordinates, along u and v.
    fn density(&self, width: u32, height: u32) -> Vec2 {
        (Vec2::new(width as f32, height as f32) * self.scale).abs()
    }
}

impl Default for Sampling {
    fn default() -> Self {
        Self {
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Trilinear,
            scale: Vec2::ONE,
            offset: Vec2::ZERO,
            projection: Projection::Uv,
        }
    }
}

/// An image on a surface. Its `Debug` text leaves out the texels.
#[derive(Clone)]
pub struct ImageTexture {
    colours: Colours,
    /// The alpha channel's resolutions; empty if there is none.
    alpha: Vec<Level<f32>>,
    sampling: Sampling,
    ranges: [(f32, f32); 3],
    /// Texels per unit of coordinates, along u and v.
    density: Vec2,
}

/// All resolutions of the colours, the finest first.
#[derive(Clone)]
enum Colours {
    Held(Vec<Level<Vec3>>),
    /// With the mean of the image.
    Tiled(Vec<TiledLevel>, Vec3),
}

impl core::fmt::Debug for ImageTexture {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { sampling, ranges, .. } = self;
        let (size, mean) = (self.size(), self.mean());
        f.debug_struct("ImageTexture")
            .field("size", &size)
            .field("sampling", sampling)
            .field("ranges", ranges)
            .field("mean", &mean)
            .field("has_alpha", &self.has_alpha())
            .finish_non_exhaustive()
    }
}

impl ImageTexture {
    /// An image of `width` × `height` texels, rows from the top.
    ///
    /// # Errors
    /// If the texels do not fill the image, one is not finite, or the placement is not legal.
    pub fn new(width: u32, height: u32, texels: Texels, sampling: Sampling) -> Result<Self, TextureError> {
        check_size(width, height, texels.len())?;
        sampling.check()?;
        let count = texels.len();
        let store = Store::new(texels);
        let ranges = ranges(&store, count)?;
        let colours = Colours::Held(halvings(Level::new(width, height, store), &sampling));
        let density = sampling.density(width, height);
        Ok(Self { colours, alpha: vec![], sampling, ranges, density })
    }

    /// An image of `width` × `height` texels whose tiles a [`PyramidWriter`](super::PyramidWriter) has written; they are read into `memory`
    /// at look-up.
    ///
    /// # Errors
    /// As [`ImageTexture::new`], or if the tiles cannot be read.
    pub fn tiled(
        width: u32,
        height: u32,
        encoding: TexelEncoding,
        blocks: Arc<dyn Blocks>,
        memory: &Arc<TileMemory>,
        sampling: Sampling,
    ) -> Result<Self, TiledError> {
        sampling.check()?;
        let (mut levels, statistics) = levels(width, height, encoding, blocks, memory).map_err(TiledError::Tiles)?;
        if sampling.filter == Filter::Bilinear {
            levels.truncate(1);
        }
        let (colours, ranges) = (Colours::Tiled(levels, statistics.mean), statistics.ranges);
        Ok(Self { colours, alpha: vec![], sampling, ranges, density: sampling.density(width, height) })
    }

    /// Adds an alpha channel, 0 (transparent) to 255. Colours are filtered by it, so that invisible texels do not affect the colour of
    /// visible ones.
    ///
    /// # Errors
    /// As [`ImageTexture::new`].
    pub fn with_alpha(
        width: u32,
        height: u32,
        texels: Texels,
        alpha: Vec<u8>,
        sampling: Sampling,
    ) -> Result<Self, TextureError> {
        check_size(width, height, alpha.len())?;
        check_size(width, height, texels.len())?;
        sampling.check()?;
        let count = texels.len();
        let store = Store::new(texels);
        let ranges = ranges(&store, count)?;
        let alpha = halvings(Level::new(width, height, Store::from_bytes(alpha)), &sampling);
        let colours = Colours::Held(weighted_pyramid(Level::new(width, height, store), &alpha));
        Ok(Self { colours, alpha, sampling, ranges, density: sampling.density(width, height) })
    }

    /// True if the image has an alpha channel.
    #[must_use]
    pub fn has_alpha(&self) -> bool {
        !self.alpha.is_empty()
    }

    /// True if the image is placed by texture coordinates, which a surface must then have.
    #[must_use]
    pub fn needs_uv(&self) -> bool {
        self.sampling.projection == Projection::Uv
    }

    /// The filtered value, linear sRGB.
    #[must_use]
    pub fn sample(&self, lookup: &Lookup) -> [f32; 3] {
        let value = |place: &TextureFootprint| match &self.colours {
            Colours::Held(levels) => self.filtered(levels, place),
            Colours::Tiled(levels, _) => self.filtered_in_tiles(levels, place),
        };
        self.sampling.projection.read(lookup, self.sampling.wrap, value).to_array()
    }

    /// The filtered value of one channel, linear.
    #[must_use]
    pub fn channel(&self, lookup: &Lookup, channel: Channel) -> f32 {
        if channel == Channel::Alpha && self.has_alpha() {
            return self
                .sampling
                .projection
                .read(lookup, self.sampling.wrap, |place| self.filtered(&self.alpha, place));
        }
        channel.value(self.sample(lookup))
    }

    /// Separate from the code for images in memory.
    #[inline(never)]
    fn filtered_in_tiles(&self, levels: &[TiledLevel], place: &TextureFootprint) -> Vec3 {
        self.filtered(levels, place)
    }

    fn filtered<T: Texel>(&self, levels: &[impl TexelLevel<T>], place: &TextureFootprint) -> T {
        let placed = place.uv * self.sampling.scale + self.sampling.offset;
        // Coordinates that overflow have no place in the image: its corner is used.
        let uv = if placed.is_finite() { placed } else { Vec2::ZERO };
        let across = place.width * (self.density.x * self.density.y).sqrt();
        let along = (place.long * self.density).length();
        let probes = probes(across, along);
        if probes <= 1 {
            return self.trilinear(levels, uv, across);
        }
        let count = probes as f32;
        let (step, width) = (place.long * self.sampling.scale / count, (along / count).clamp(across, 2.0 * across));
        let at = |k: u32| uv + step * (k as f32 + 0.5 - 0.5 * count);
        let sum = (0..probes).fold(T::NOTHING, |sum, k| sum + self.trilinear(levels, at(k), width));
        sum * (1.0 / count)
    }

    /// The value at image coordinates, over a round footprint of a width in texels.
    fn trilinear<T: Texel>(&self, levels: &[impl TexelLevel<T>], uv: Vec2, texels: f32) -> T {
        let wrap = self.sampling.wrap;
        let (s, t) = (wrap[0].fold(uv.x), 1.0 - wrap[1].fold(uv.y));
        let last = levels.len() - 1;
        if last == 0 || texels <= 1.0 {
            return levels[0].bilinear(s, t, wrap);
        }
        let lod = log2(texels).min(last as f32);
        let i = (lod as usize).min(last - 1);
        let (fine, coarse) = (levels[i].bilinear(s, t, wrap), levels[i + 1].bilinear(s, t, wrap));
        fine.towards(coarse, lod - i as f32)
    }

    /// Mean of the whole image, linear.
    #[must_use]
    pub fn mean(&self) -> Vec3 {
        let base = match &self.colours {
            Colours::Held(levels) => &levels[0],
            Colours::Tiled(_, mean) => return *mean,
        };
        let texels = (0..base.height as usize).flat_map(|y| (0..base.width as usize).map(move |x| (x, y)));
        let sum: glam::DVec3 = texels.map(|(x, y)| base.texel(x, y).as_dvec3()).sum();
        (sum / (f64::from(base.width) * f64::from(base.height))).as_vec3()
    }

    /// Minimum and maximum of any colour channel.
    #[must_use]
    pub fn range(&self) -> (f32, f32) {
        self.ranges
            .into_iter()
            .fold((f32::INFINITY, f32::NEG_INFINITY), |all, one| (all.0.min(one.0), all.1.max(one.1)))
    }

    /// Bounds of one channel's values; for luminance the bounds follow from those of the colours.
    #[must_use]
    pub fn channel_range(&self, channel: Channel) -> (f32, f32) {
        if channel == Channel::Alpha && self.has_alpha() {
            return (0.0, 1.0);
        }
        (channel.value(self.ranges.map(|r| r.0)), channel.value(self.ranges.map(|r| r.1)))
    }

    /// Columns and rows of the image.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        match &self.colours {
            Colours::Held(levels) => (levels[0].width, levels[0].height),
            Colours::Tiled(levels, _) => levels[0].size(),
        }
    }

    /// Memory of the texels of all resolutions, bytes; zero for an image whose tiles are read at look-up.
    #[must_use]
    pub fn texel_bytes(&self) -> usize {
        let colours = match &self.colours {
            Colours::Held(levels) => levels.iter().map(Level::bytes).sum::<usize>(),
            Colours::Tiled(..) => 0,
        };
        colours + self.alpha.iter().map(Level::bytes).sum::<usize>()
    }

    /// For an image whose tiles are read at look-up: their bytes, and the memory into which they are read.
    #[must_use]
    pub fn tiles(&self) -> Option<(u64, &Arc<TileMemory>)> {
        match &self.colours {
            Colours::Held(_) => None,
            Colours::Tiled(levels, _) => Some((levels.iter().map(TiledLevel::bytes).sum(), levels[0].memory())),
        }
    }
}

/// Readings along a footprint of `across` by `along` texels.
fn probes(across: f32, along: f32) -> u32 {
    let ratio = along / across.max(1.0);
    if ratio > 2.0 { (0.5 * ratio).ceil().min(MAX_PROBES) as u32 } else { 1 }
}

fn check_size(width: u32, height: u32, actual: usize) -> Result<(), TextureError> {
    let fits = actual > 0 && actual as u64 == u64::from(width) * u64::from(height);
    if fits { Ok(()) } else { Err(TextureError::Size { width, height, actual }) }
}

/// The resolutions that a filter needs.
fn halvings<T: Texel>(base: Level<T>, sampling: &Sampling) -> Vec<Level<T>> {
    if sampling.filter == Filter::Trilinear { pyramid(base) } else { vec![base] }
}

fn ranges(store: &Store<Vec3>, count: usize) -> Result<[(f32, f32); 3], TextureError> {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for texel in 0..count {
        let value = store.get(texel);
        if !value.is_finite() {
            return Err(TextureError::NonFinite { texel });
        }
        (low, high) = (low.min(value), high.max(value));
    }
    Ok(core::array::from_fn(|i| (low[i], high[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lookup(u: f32, v: f32, width: f32) -> Lookup {
        Lookup { width, ..Lookup::point(Vec2::new(u, v)) }
    }

    /// 0 1 2 / 3 4 5 (top row first), in tenths.
    fn numbered(sampling: Sampling) -> ImageTexture {
        let texels = (0..6).map(|i| [i as f32 / 10.0; 3]).collect();
        ImageTexture::new(3, 2, Texels::Float(texels), sampling).expect("a picture")
    }

    fn read(t: &ImageTexture, u: f32, v: f32) -> f32 {
        t.sample(&lookup(u, v, 0.0))[0]
    }

    fn near(a: f32, b: f32) -> bool {
        (a - b).abs() < 1e-6
    }

    #[test]
    fn the_origin_is_the_bottom_left_corner() {
        let clamp = Sampling { wrap: [Wrap::Clamp; 2], ..Sampling::default() };
        let t = numbered(clamp);
        assert!(near(read(&t, 0.0, 0.0), 0.3), "bottom left");
        assert!(near(read(&t, 1.0, 0.0), 0.5), "bottom right");
        assert!(near(read(&t, 0.0, 1.0), 0.0), "top left");
        assert!(near(read(&t, 1.0, 1.0), 0.2), "top right");
        assert!(near(read(&t, 0.5, 0.25), 0.4), "the centre of a texel is the texel");
        assert!(near(read(&t, 1.0 / 3.0, 0.25), 0.35), "half-way between two is their mean");
    }

    #[test]
    fn wraps_work_on_each_axis() {
        let t = numbered(Sampling { wrap: [Wrap::Repeat, Wrap::Mirror], ..Sampling::default() });
        assert!(near(read(&t, 1.0 + 1.0 / 6.0, 0.25), 0.3));
        assert!(near(read(&t, -1.0 / 6.0, 0.25), 0.5));
        assert!(near(read(&t, 0.5, -0.25), 0.4), "mirrored at the lower edge");
        assert!(near(read(&t, 0.5, 1.75), 0.4), "mirrored at the upper edge");
        assert!(near(read(&t, 0.0, 0.25), 0.4), "the seam of a repeated picture joins 3 and 5");
    }

    #[test]
    fn placement_scales_then_shifts() {
        let placed = Sampling { scale: Vec2::new(2.0, 1.0), offset: Vec2::new(0.0, 0.5), ..Sampling::default() };
        assert!(near(read(&numbered(placed), 0.25, 0.25), 0.1));
    }

    #[test]
    fn halving_keeps_the_mean_for_odd_sizes() {
        let texels: Vec<_> = (0..7 * 5).map(|i| [(i * 37 % 11) as f32, (i % 3) as f32, 1.0]).collect();
        let t = ImageTexture::new(7, 5, Texels::Float(texels), Sampling::default()).expect("a picture");
        let coarsest = Vec3::from(t.sample(&lookup(0.3, 0.6, 1e9)));
        // Sums of 35 f32 numbers.
        assert!((coarsest - t.mean()).length() < 1e-5, "{coarsest} {}", t.mean());
    }

    #[test]
    fn resolutions_are_chosen_by_the_footprint() {
        // Vertical stripes of one texel: gone at a footprint of two texels.
        let texels = (0..64 * 64).map(|i| [(i % 2) as f32; 3]).collect();
        let t = ImageTexture::new(64, 64, Texels::Float(texels), Sampling::default()).expect("a picture");
        let at = |width: f32| t.sample(&lookup(0.5 / 64.0, 0.5, width))[0];
        assert!(near(at(1.0 / 64.0), 0.0));
        assert!(near(at(2.0 / 64.0), 0.5));
        let between = at(core::f32::consts::SQRT_2 / 64.0);
        assert!((between - 0.25).abs() < 1e-5, "{between}");
    }

    #[test]
    fn encoded_bytes_are_averaged_in_linear_light() {
        let black_and_white = Texels::Srgb8(vec![[0; 3], [255; 3]]);
        let t = ImageTexture::new(2, 1, black_and_white, Sampling::default()).expect("a picture");
        assert!(near(t.sample(&lookup(0.5, 0.5, 100.0))[0], 0.5));
        assert!(near(read(&t, 0.25, 0.5), 0.0));
        let linear =
            ImageTexture::new(1, 1, Texels::Linear8(vec![[51, 0, 255]]), Sampling::default()).expect("one texel");
        assert_eq!(linear.sample(&lookup(0.1, 0.9, 0.0)), [0.2, 0.0, 1.0]);
    }

    #[test]
    fn far_coordinates_stay_in_the_image() {
        let t = numbered(Sampling { wrap: [Wrap::Mirror, Wrap::Repeat], ..Sampling::default() });
        for x in [1e9, -1e9, 3.4e38, -1e-30] {
            let value = read(&t, x, -x);
            assert!((0.0..=0.5).contains(&value), "{x}: {value}");
        }
    }

    #[test]
    fn faulty_images_are_refused() {
        let size = ImageTexture::new(2, 2, Texels::Linear8(vec![[0; 3]; 3]), Sampling::default());
        assert_eq!(size.err(), Some(TextureError::Size { width: 2, height: 2, actual: 3 }));
        let nan = Texels::Float(vec![[0.0; 3], [f32::NAN; 3]]);
        assert_eq!(ImageTexture::new(2, 1, nan, Sampling::default()).err(), Some(TextureError::NonFinite { texel: 1 }));
    }
}
