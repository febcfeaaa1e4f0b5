//! Rectangles of pixels, and stacks of them by wavelength.

use crate::{quantity::Quantity, wavelength::Bands};

/// A rectangle of pixels of one quantity, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane<Q: Quantity> {
    width: usize,
    height: usize,
    samples: Vec<Q::Sample>,
}

impl<Q: Quantity> Plane<Q> {
    /// A plane of `width` × `height` pixels, all at the sample's default (zero).
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self::filled(width, height, Q::Sample::default())
    }

    /// A plane of `width` × `height` pixels, all at `value`.
    #[must_use]
    pub fn filled(width: usize, height: usize, value: Q::Sample) -> Self {
        Self { width, height, samples: vec![value; width * height] }
    }

    /// A plane over samples given row by row. `None` if their number is not `width × height`.
    #[must_use]
    pub fn from_samples(width: usize, height: usize, samples: Vec<Q::Sample>) -> Option<Self> {
        (samples.len() == width * height).then_some(Self { width, height, samples })
    }

    /// Pixels per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the sample at column `x`, row `y`. Panics outside the plane.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> Q::Sample {
        assert!(x < self.width, "column {x} of a plane {} wide", self.width);
        self.samples[y * self.width + x]
    }

    /// Sets the sample at column `x`, row `y`. Panics outside the plane.
    pub fn set(&mut self, x: usize, y: usize, value: Q::Sample) {
        assert!(x < self.width, "column {x} of a plane {} wide", self.width);
        self.samples[y * self.width + x] = value;
    }

    /// All samples, row by row from the top left.
    #[must_use]
    pub fn samples(&self) -> &[Q::Sample] {
        &self.samples
    }

    /// All samples, row by row from the top left.
    pub fn samples_mut(&mut self) -> &mut [Q::Sample] {
        &mut self.samples
    }

    /// The samples, row by row from the top left.
    #[must_use]
    pub fn into_samples(self) -> Vec<Q::Sample> {
        self.samples
    }

    /// Returns `width` × `height` pixels of the plane from column `x`, row `y` on. Panics outside the plane.
    #[must_use]
    pub fn part(&self, x: usize, y: usize, width: usize, height: usize) -> Self {
        let row = |row: usize| self.samples[row * self.width + x..][..width].iter().copied();
        assert!(x + width <= self.width, "columns up to {} of a plane {} wide", x + width, self.width);
        Self { width, height, samples: (y..y + height).flat_map(row).collect() }
    }

    /// Converts the plane to another quantity, sample by sample.
    #[must_use]
    pub fn map<R: Quantity>(&self, f: impl FnMut(Q::Sample) -> R::Sample) -> Plane<R> {
        Plane { width: self.width, height: self.height, samples: self.samples.iter().copied().map(f).collect() }
    }
}

/// One plane per wavelength band; each sample is the **mean over its band**, never a point sample.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralCube<Q: Quantity> {
    bands: Bands,
    planes: Vec<Plane<Q>>,
}

impl<Q: Quantity> SpectralCube<Q> {
    /// A cube of zeros.
    #[must_use]
    pub fn new(width: usize, height: usize, bands: Bands) -> Self {
        Self { bands, planes: (0..bands.count()).map(|_| Plane::new(width, height)).collect() }
    }

    /// Returns a cube of planes of equal size, one per band, shortest wavelength first. `None` if they do not match.
    #[must_use]
    pub fn from_planes(bands: Bands, planes: Vec<Plane<Q>>) -> Option<Self> {
        let first = planes.first()?;
        let same = planes.iter().all(|p| p.width == first.width && p.height == first.height);
        (same && planes.len() == bands.count()).then_some(Self { bands, planes })
    }

    /// The wavelength bands, one per plane.
    #[must_use]
    pub fn bands(&self) -> Bands {
        self.bands
    }

    /// Pixels per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.planes.first().map_or(0, Plane::width)
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.planes.first().map_or(0, Plane::height)
    }

    /// The planes, shortest wavelength first.
    #[must_use]
    pub fn planes(&self) -> &[Plane<Q>] {
        &self.planes
    }

    /// The planes, shortest wavelength first.
    pub fn planes_mut(&mut self) -> &mut [Plane<Q>] {
        &mut self.planes
    }
}
