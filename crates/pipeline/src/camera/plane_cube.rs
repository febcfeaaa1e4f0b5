//! A cube in a scratch file, band after band.

use etendue_core::quantity::Quantity;
use etendue_core::storage::{BandReader, CubeOnDisk};
use etendue_core::storage::{NUMBER_BYTES, Scratch, ScratchStore, read_numbers, write_numbers};
use etendue_core::{Bands, Plane, StoredCube};
use std::ops::Range;
use std::sync::Arc;

/// Planes of one size, written one after the other.
#[derive(Clone, Debug)]
pub(super) struct PlaneCube {
    bands: Bands,
    size: (usize, usize),
    scratch: Arc<dyn Scratch>,
}

impl PlaneCube {
    /// Allocates the bands of `width` × `height` pixels.
    pub(super) fn new(store: &dyn ScratchStore, bands: Bands, width: usize, height: usize) -> Result<Self, String> {
        let scratch = store.room((width * height * bands.count() * NUMBER_BYTES) as u64)?;
        Ok(Self { bands, size: (width, height), scratch })
    }

    /// Writes a band.
    pub(super) fn write<Q: Quantity<Sample = f32>>(&self, band: usize, plane: &Plane<Q>) -> Result<(), String> {
        debug_assert_eq!((plane.width(), plane.height()), self.size, "planes of one size");
        write_numbers(&*self.scratch, self.offset(band, 0), plane.samples())
    }

    /// The written cube.
    pub(super) fn into_cube<Q: Quantity>(self) -> StoredCube<Q> {
        let (bands, size) = (self.bands, self.size);
        StoredCube::Disk(CubeOnDisk::new(bands, size.0, size.1, Arc::new(self)))
    }

    /// Offset of a row of a band, bytes.
    fn offset(&self, band: usize, row: usize) -> u64 {
        let (width, height) = self.size;
        ((band * height + row) * width * NUMBER_BYTES) as u64
    }
}

impl BandReader for PlaneCube {
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        read_numbers(&*self.scratch, self.offset(band, rows.start), samples)
    }
}
