//! What benchmarks of rays are made of, on the core and the tracer alone: clocks, tables, meshes and rays. The comparison with Embree links
//! nothing else of the project.

pub mod clock;
pub mod contest_file;
pub mod flat;
pub mod machine;
pub mod questions;
pub mod runs;
pub mod table;
pub mod terrain;
pub mod threads;
