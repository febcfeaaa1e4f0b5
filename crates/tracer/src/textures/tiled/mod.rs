//! Pictures whose texels are kept outside of memory, tile by tile, and read where they are looked up.
//!
//! The values are bit for bit those of the same picture in memory: the same texels at all resolutions, interpolated by the same operations. How
//! many tiles are in memory, and who read them, changes only how long a look-up takes.

mod layout;
mod memory;
mod resolution;
mod writer;

pub use memory::TileMemory;
pub(super) use resolution::{TiledLevel, levels};
pub use writer::PyramidWriter;
