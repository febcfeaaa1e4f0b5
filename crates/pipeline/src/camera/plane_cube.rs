//! A cube in a scratch file, band after band.

use etendue_core::kept_cube::{BandReader, CubeOnDisk};
use etendue_core::quantity::Quantity;
use etendue_core::scratch::{Scratch, ScratchStore};
use etendue_core::{Bands, KeptCube, Plane};
use std::ops::Range;
use std::sync::Arc;

/// Bytes of a number.
const NUMBER: usize = size_of::<f32>();
/// Numbers that are turned into bytes at a time.
const PART: usize = 1 << 18;

/// Planes of one size, written one after the other.
#[derive(Clone, Debug)]
pub(super) struct PlaneCube {
    bands: Bands,
    size: (usize, usize),
    scratch: Arc<dyn Scratch>,
}

impl PlaneCube {
    /// Room for the bands of `width` × `height` pixels.
    pub(super) fn new(store: &dyn ScratchStore, bands: Bands, size: (usize, usize)) -> Result<Self, String> {
        let scratch = store.room((size.0 * size.1 * bands.count() * NUMBER) as u64)?;
        Ok(Self { bands, size, scratch })
    }

    /// Writes a band.
    pub(super) fn write<Q: Quantity<Sample = f32>>(&self, band: usize, plane: &Plane<Q>) -> Result<(), String> {
        debug_assert_eq!((plane.width(), plane.height()), self.size, "planes of one size");
        let first = self.offset(band, 0);
        for (part, numbers) in plane.samples().chunks(PART).enumerate() {
            let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
            self.scratch.write(first + (part * PART * NUMBER) as u64, &bytes)?;
        }
        Ok(())
    }

    /// What was written.
    pub(super) fn kept<Q: Quantity>(self) -> KeptCube<Q> {
        let (bands, size) = (self.bands, self.size);
        KeptCube::Disk(CubeOnDisk::new(bands, size, Arc::new(self)))
    }

    /// Where a row of a band begins, bytes.
    fn offset(&self, band: usize, row: usize) -> u64 {
        let (width, height) = self.size;
        ((band * height + row) * width * NUMBER) as u64
    }
}

impl BandReader for PlaneCube {
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        let first = self.offset(band, rows.start);
        for (part, samples) in samples.chunks_mut(PART).enumerate() {
            let mut bytes = vec![0; samples.len() * NUMBER];
            self.scratch.read(first + (part * PART * NUMBER) as u64, &mut bytes)?;
            let (numbers, _) = bytes.as_chunks::<NUMBER>();
            samples.iter_mut().zip(numbers).for_each(|(sample, number)| *sample = f32::from_le_bytes(*number));
        }
        Ok(())
    }
}
