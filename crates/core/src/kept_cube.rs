//! Spectral cubes that need not be in memory.

use crate::plane::{Plane, SpectralCube};
use crate::quantity::Quantity;
use crate::wavelength::Bands;
use core::fmt::Debug;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

/// Bands of pixels that are read where they are kept, from any thread.
pub trait BandReader: Debug + Send + Sync {
    /// Fills `samples`, row by row, with whole rows of a band.
    ///
    /// # Errors
    /// Where they cannot be read, in a sentence for the user.
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String>;
}

impl<Q: Quantity<Sample = f32>> BandReader for SpectralCube<Q> {
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        let width = self.width();
        samples.copy_from_slice(&self.planes()[band].samples()[rows.start * width..rows.end * width]);
        Ok(())
    }
}

/// A cube outside of memory.
#[derive(Clone, Debug)]
pub struct CubeOnDisk {
    bands: Bands,
    width: usize,
    height: usize,
    reader: Arc<dyn BandReader>,
}

/// A spectral cube in memory, or outside of it: whoever asks for a band or for rows need not know which. The numbers are the same.
#[derive(Clone, Debug)]
pub enum KeptCube<Q: Quantity> {
    /// In memory.
    Memory(SpectralCube<Q>),
    /// On the disk.
    Disk(CubeOnDisk),
}

impl<Q: Quantity> From<SpectralCube<Q>> for KeptCube<Q> {
    fn from(cube: SpectralCube<Q>) -> Self {
        Self::Memory(cube)
    }
}

impl CubeOnDisk {
    /// A cube of `width` × `height` pixels that `reader` reads.
    #[must_use]
    pub fn new(bands: Bands, width: usize, height: usize, reader: Arc<dyn BandReader>) -> Self {
        Self { bands, width, height, reader }
    }

    /// Who reads it.
    #[must_use]
    pub fn reader(&self) -> &Arc<dyn BandReader> {
        &self.reader
    }
}

impl<Q: Quantity<Sample = f32>> KeptCube<Q> {
    /// The wavelength bands.
    #[must_use]
    pub fn bands(&self) -> Bands {
        match self {
            Self::Memory(cube) => cube.bands(),
            Self::Disk(cube) => cube.bands,
        }
    }

    /// Pixels a row.
    #[must_use]
    pub fn width(&self) -> usize {
        match self {
            Self::Memory(cube) => cube.width(),
            Self::Disk(cube) => cube.width,
        }
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        match self {
            Self::Memory(cube) => cube.height(),
            Self::Disk(cube) => cube.height,
        }
    }

    /// The cube, where it is in memory.
    #[must_use]
    pub fn in_memory(&self) -> Option<&SpectralCube<Q>> {
        match self {
            Self::Memory(cube) => Some(cube),
            Self::Disk(_) => None,
        }
    }

    /// Who reads it.
    #[must_use]
    pub fn reader(&self) -> &dyn BandReader {
        match self {
            Self::Memory(cube) => cube,
            Self::Disk(cube) => &*cube.reader,
        }
    }

    /// A band.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn plane(&self, band: usize) -> Result<Cow<'_, Plane<Q>>, String> {
        match self {
            Self::Memory(cube) => Ok(Cow::Borrowed(&cube.planes()[band])),
            Self::Disk(cube) => {
                let mut plane = Plane::new(cube.width, cube.height);
                cube.reader.read(band, 0..cube.height, plane.samples_mut())?;
                Ok(Cow::Owned(plane))
            }
        }
    }

    /// Rows of a band, into as many samples.
    ///
    /// # Errors
    /// Where they cannot be read.
    pub fn read_rows(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        self.reader().read(band, rows, samples)
    }

    /// Rows of all bands, as a cube of as many rows.
    ///
    /// # Errors
    /// Where they cannot be read.
    pub fn rows(&self, rows: Range<usize>) -> Result<SpectralCube<Q>, String> {
        let mut strip = SpectralCube::new(self.width(), rows.len(), self.bands());
        for (band, plane) in strip.planes_mut().iter_mut().enumerate() {
            self.read_rows(band, rows.clone(), plane.samples_mut())?;
        }
        Ok(strip)
    }

    /// The whole cube in memory.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn load(self) -> Result<SpectralCube<Q>, String> {
        match self {
            Self::Memory(cube) => Ok(cube),
            Self::Disk(_) => self.rows(0..self.height()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Radiance;

    /// Band, row and column as one number.
    #[derive(Debug)]
    struct Numbers;

    impl BandReader for Numbers {
        fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
            let numbers = rows.flat_map(|y| (0..3).map(move |x| (100 * band + 10 * y + x) as f32));
            samples.iter_mut().zip(numbers).for_each(|(sample, number)| *sample = number);
            Ok(())
        }
    }

    #[test]
    fn a_cube_reads_alike_from_both_places() {
        let bands = Bands::new(400.0, 50.0, 2).expect("two bands");
        let disk = KeptCube::<Radiance>::Disk(CubeOnDisk::new(bands, 3, 4, Arc::new(Numbers)));
        let memory = KeptCube::Memory(disk.clone().load().expect("read"));
        assert!(disk.in_memory().is_none() && memory.in_memory().is_some());
        for cube in [&disk, &memory] {
            assert_eq!((cube.bands(), cube.width(), cube.height()), (bands, 3, 4));
            assert_eq!(cube.plane(1).expect("read").at(2, 3), 132.0);
            let strip = cube.rows(1..3).expect("read");
            assert_eq!((strip.height(), strip.planes()[1].at(0, 1)), (2, 120.0));
        }
    }
}
