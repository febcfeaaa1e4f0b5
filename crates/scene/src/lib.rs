//! The description of a job: inert records in file units with their places; parsing and checking.
//!
//! A description is TOML, `format = 1` at the head of every file. A *job* names its scene and its cameras, inline or by file, and the render
//! settings; a *scene* holds everything visible; a *camera* holds lens, sensor and processing. The format is described in `docs/scene-format.md` and
//! key by key in `docs/format`, which a test keeps in step with the records here.
//!
//! [`Description::load`] reads a job through a reader from the caller, applies overrides (`--set key=value`) and collects **all** errors with their
//! places: unknown keys, wrong types and ranges, dangling names, contradictions. A record keeps the units of the file and the place of each value
//! ([`Placed`]); `None` means that the key was not given. Defaults that depend on the plan are left to the compiler of the plan.
//!
//! [`asset`] holds the inert contents of the files that a description names, filled by the reader of these files.
//!
//! This crate opens no file, builds no acceleration structure and traces nothing. It has no silent fallbacks.

pub mod asset;
mod document;
mod fault;
pub mod limits;
mod line_index;
mod load;
mod numbered_files;
mod overrides;
mod place;
pub mod preset;
mod reader;
pub mod record;
mod schema;
mod suggest;
pub mod written;

pub use fault::{
    DescriptionError, DescriptionErrors, ErrorCode, Example, ExampleContext, Explanation, Problem, key_with_place,
};
pub use load::named_files;
pub use load::{
    CameraSetup, Description, ReadText, Trigger, UnusedNames, edit, load_camera, load_datasheet, load_laboratory,
    load_variations, load_weather, stated_render_keys,
};
pub use overrides::Overrides;
pub use place::{Place, Placed};
pub use schema::{FileKind, schema};
