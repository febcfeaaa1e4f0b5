//! The generator of the scenes that ship with Étendue.
//!
//! [`files`] makes every generated file of the folder `scenes/`: meshes, textures, photometry, point spreads of a lens and the descriptions of
//! the street. Everything is computed from constants and addressed random numbers, so the bytes are the same on every
//! machine; a test compares them with the files in the repository. The small scenes made of shapes alone
//! (`cornell`, `furnace`, `sphere-on-plane`) and the cameras are written by hand and are not touched.

pub mod description;
pub mod luminaire;
pub mod mesh;
pub mod obj;
pub mod paint;
pub mod point_spread;
pub mod random;
pub mod street;

/// A file of the scenes.
#[derive(Clone, Debug)]
pub struct File {
    /// Its path within `scenes/`, parts separated by `/`.
    pub path: String,
    /// Its contents.
    pub bytes: Vec<u8>,
}

impl File {
    /// A file of text.
    #[must_use]
    pub fn text(path: String, text: String) -> Self {
        Self { path, bytes: text.into_bytes() }
    }
}

/// Every generated file.
#[must_use]
pub fn files() -> Vec<File> {
    let mut files = street::files();
    files.push(File { path: "weather/road-height.png".to_owned(), bytes: paint::ground::hollows().grey_png(4) });
    files.extend(point_spread::files());
    files
}
