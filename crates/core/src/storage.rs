//! Storage outside memory: numbered blocks of bytes, scratch space, and spectral cubes kept there.
//!
//! Blocks are read one at a time, when needed. The maker of blocks knows their content; the store knows their location. Error texts are sentences for the user
//! that name the file.
//!
//! Scratch space lasts until the run ends: it is freed when its last owner drops it, however the run ends.

use core::fmt::Debug;
use std::{borrow::Cow, ops::Range, sync::Arc};

use crate::plane::{Plane, SpectralCube};
use crate::{quantity::Quantity, wavelength::Bands};

/// Key of blocks: a hash of everything that decides their bytes.
pub type BlockKey = [u8; 32];

/// Complete set of blocks.
pub trait Blocks: Debug + Send + Sync {
    /// Fills `bytes`, which is as long as the block. Callable from any thread.
    ///
    /// # Errors
    /// If the block cannot be read or is corrupt.
    fn read(&self, block: usize, bytes: &mut [u8]) -> Result<(), String>;
}

/// Receives blocks in any order, each once.
pub trait BlockWriter {
    /// Writes a block.
    ///
    /// # Errors
    /// If it cannot be written.
    fn write(&mut self, block: usize, bytes: &[u8]) -> Result<(), String>;
}

/// Writes all blocks to the given writer.
pub type Fill<'a> = &'a mut dyn FnMut(&mut dyn BlockWriter) -> Result<(), String>;

pub trait BlockStore: Debug + Send + Sync {
    /// Returns the blocks of a key; `None` if there is no complete set. `lengths` are the bytes of each.
    fn find(&self, key: &BlockKey, lengths: &[u32]) -> Option<Arc<dyn Blocks>>;

    /// Refuses, before they are made, blocks for which there is no room even after removal of all others.
    ///
    /// # Errors
    /// The excess and the remedy.
    fn check_room(&self, _key: &BlockKey, _lengths: &[u32]) -> Result<(), String> {
        Ok(())
    }

    /// Stores the blocks that `fill` writes. They become visible when all are complete.
    ///
    /// # Errors
    /// If they cannot be stored, or the error of `fill`; nothing of them remains then.
    fn make(&self, key: &BlockKey, lengths: &[u32], fill: Fill<'_>) -> Result<Arc<dyn Blocks>, String>;
}

/// Random-access bytes that any thread can write and read. Bytes never written read as 0.
pub trait Scratch: Debug + Send + Sync {
    /// Writes `bytes` from the byte `offset` on.
    ///
    /// # Errors
    /// If they cannot be written: a full disk is named.
    fn write(&self, offset: u64, bytes: &[u8]) -> Result<(), String>;

    /// Fills `bytes` from the byte `offset` on.
    ///
    /// # Errors
    /// If they cannot be read.
    fn read(&self, offset: u64, bytes: &mut [u8]) -> Result<(), String>;
}

/// Bytes of a number.
pub const NUMBER_BYTES: usize = size_of::<f32>();
/// Numbers converted to bytes at a time.
const NUMBERS_PER_PART: usize = 1 << 18;

/// Writes numbers of 32 bits, little-endian, from the byte `offset` on.
///
/// # Errors
/// As [`Scratch::write`].
pub fn write_numbers(scratch: &dyn Scratch, offset: u64, numbers: &[f32]) -> Result<(), String> {
    for (part, numbers) in numbers.chunks(NUMBERS_PER_PART).enumerate() {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        scratch.write(offset + (part * NUMBERS_PER_PART * NUMBER_BYTES) as u64, &bytes)?;
    }
    Ok(())
}

/// Reads numbers written by [`write_numbers`], with the same bits.
///
/// # Errors
/// As [`Scratch::read`].
pub fn read_numbers(scratch: &dyn Scratch, offset: u64, numbers: &mut [f32]) -> Result<(), String> {
    for (part, numbers) in numbers.chunks_mut(NUMBERS_PER_PART).enumerate() {
        let mut bytes = vec![0; numbers.len() * NUMBER_BYTES];
        scratch.read(offset + (part * NUMBERS_PER_PART * NUMBER_BYTES) as u64, &mut bytes)?;
        let (stored, _) = bytes.as_chunks::<NUMBER_BYTES>();
        numbers.iter_mut().zip(stored).for_each(|(number, stored)| *number = f32::from_le_bytes(*stored));
    }
    Ok(())
}

/// Provider of scratch space.
pub trait ScratchStore: Debug + Send + Sync {
    /// Returns room for `bytes`.
    ///
    /// # Errors
    /// If there is not enough.
    fn room(&self, bytes: u64) -> Result<Arc<dyn Scratch>, String>;
}

/// Reader of bands of pixels from where they are stored. Callable from any thread.
pub trait BandReader: Debug + Send + Sync {
    /// Fills `samples`, row by row, with whole rows of a band.
    ///
    /// # Errors
    /// If they cannot be read, in a sentence for the user.
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String>;
}

impl<Q: Quantity<Sample = f32>> BandReader for SpectralCube<Q> {
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        let width = self.width();
        samples.copy_from_slice(&self.planes()[band].samples()[rows.start * width..rows.end * width]);
        Ok(())
    }
}

/// Spectral cube outside memory.
#[derive(Clone, Debug)]
pub struct CubeOnDisk {
    bands: Bands,
    width: usize,
    height: usize,
    reader: Arc<dyn BandReader>,
}

/// Spectral cube in memory or outside it, with the same access and the same numbers.
#[derive(Clone, Debug)]
pub enum StoredCube<Q: Quantity> {
    /// In memory.
    Memory(SpectralCube<Q>),
    /// On the disk.
    Disk(CubeOnDisk),
}

impl<Q: Quantity> From<SpectralCube<Q>> for StoredCube<Q> {
    fn from(cube: SpectralCube<Q>) -> Self {
        Self::Memory(cube)
    }
}

impl CubeOnDisk {
    /// Returns a cube of `width` × `height` pixels read by `reader`.
    #[must_use]
    pub fn new(bands: Bands, width: usize, height: usize, reader: Arc<dyn BandReader>) -> Self {
        Self { bands, width, height, reader }
    }

    /// Reader of the cube.
    #[must_use]
    pub fn reader(&self) -> &Arc<dyn BandReader> {
        &self.reader
    }
}

impl<Q: Quantity<Sample = f32>> StoredCube<Q> {
    /// The wavelength bands.
    #[must_use]
    pub fn bands(&self) -> Bands {
        match self {
            Self::Memory(cube) => cube.bands(),
            Self::Disk(cube) => cube.bands,
        }
    }

    /// Pixels per row.
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

    /// The cube, if it is in memory.
    #[must_use]
    pub fn in_memory(&self) -> Option<&SpectralCube<Q>> {
        match self {
            Self::Memory(cube) => Some(cube),
            Self::Disk(_) => None,
        }
    }

    /// Reader of the cube.
    #[must_use]
    pub fn reader(&self) -> &dyn BandReader {
        match self {
            Self::Memory(cube) => cube,
            Self::Disk(cube) => &*cube.reader,
        }
    }

    /// Returns a band.
    ///
    /// # Errors
    /// If it cannot be read.
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

    /// Reads rows of a band into as many samples.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn read_rows(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        self.reader().read(band, rows, samples)
    }

    /// Returns rows of all bands, as a cube of that many rows.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn rows(&self, rows: Range<usize>) -> Result<SpectralCube<Q>, String> {
        let mut strip = SpectralCube::new(self.width(), rows.len(), self.bands());
        for (band, plane) in strip.planes_mut().iter_mut().enumerate() {
            self.read_rows(band, rows.clone(), plane.samples_mut())?;
        }
        Ok(strip)
    }

    /// Loads the whole cube into memory.
    ///
    /// # Errors
    /// If it cannot be read.
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

    /// Test reader: band, row and column as one number.
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
    fn a_cube_reads_the_same_from_both_places() {
        let bands = Bands::new(400.0, 50.0, 2).expect("two bands");
        let disk = StoredCube::<Radiance>::Disk(CubeOnDisk::new(bands, 3, 4, Arc::new(Numbers)));
        let memory = StoredCube::Memory(disk.clone().load().expect("read"));
        assert!(disk.in_memory().is_none() && memory.in_memory().is_some());
        for cube in [&disk, &memory] {
            assert_eq!((cube.bands(), cube.width(), cube.height()), (bands, 3, 4));
            assert_eq!(cube.plane(1).expect("read").at(2, 3), 132.0);
            let strip = cube.rows(1..3).expect("read");
            assert_eq!((strip.height(), strip.planes()[1].at(0, 1)), (2, 120.0));
        }
    }
}
