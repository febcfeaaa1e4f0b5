//! Plane geometry: outlines, sheets that pieces partition, lattices of cells with figures in them.
//!
//! All pieces lie in one plane, and neighbours share their vertices: no offsets in depth, no cracks, no textures where an
//! edge is to be hard. Coordinates are mm, x to the right and y down; an outline's area is positive where it turns
//! clockwise as seen.

mod figure;
mod lattice;
mod outline;
mod ring;
mod sheet;

pub use figure::{Figure, Zone};
pub use lattice::{Cell, Lattice};
pub use outline::{area, bounds, centroid, disc, rectangle, turned};
pub use ring::ring;
pub use sheet::{Fill, Piece, Sheet};
