//! Measured lamps: what files of every kind become, and what is refused.

mod faults;
mod ies;
mod inspected;
mod ldt;
mod oracles;
mod support;
