//! Measured lamps: results for files of every kind, and refusals.

mod faults;
mod ies;
mod inspected;
mod ldt;
mod oracles;
mod support;
