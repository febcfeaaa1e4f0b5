//! One verb a file: arguments to a call of the library, its answer to the terminal.

pub mod chart;
pub mod compare;
pub mod inspect;
pub mod measure;
pub mod plan;
pub mod render;
pub mod schema;
pub mod sensor;
