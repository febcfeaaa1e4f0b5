//! Parsers of argument texts that several requests share. A parser returns the value, or the expected form in a sentence that the front end puts after the
//! argument's name.

mod choice;
mod file_name;
mod frames;
mod number;
mod place;

pub use choice::{Word, choice, word};
pub use file_name::{html, png, svg, toml};
pub use frames::{MAX_FRAMES, frames, samples, seed};
pub use number::{in_range, integer, not_negative, positive};
pub use place::{grid, place, point, region, size, tile};
