//! A scene and its camera's rays in a file of 32-bit numbers, little-endian: for programs that link no reader of scenes.

use etendue_core::Ray;
use glam::Vec3;
use std::io;
use std::path::Path;

/// Triangles, rays and a light in the render frame.
#[derive(Clone, Debug)]
pub struct ContestFile {
    /// Three corners of each triangle, m.
    pub corners: Vec<Vec3>,
    /// The principal ray of every pixel, row by row.
    pub primary: Vec<Ray>,
    /// Direction to the sun.
    pub sun: Vec3,
}

impl ContestFile {
    /// Writes the file: the direction to the sun; the number of corners and the corners; the number of rays, and the origin and direction of each.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let rays: Vec<Vec3> = self.primary.iter().flat_map(|ray| [ray.origin, ray.direction]).collect();
        let mut bytes = Vec::new();
        add(&mut bytes, &[self.sun]);
        for list in [&self.corners, &rays] {
            bytes.extend((list.len() as u32).to_le_bytes());
            add(&mut bytes, list);
        }
        std::fs::write(path, bytes)
    }

    /// Reads the file.
    ///
    /// # Errors
    /// The file cannot be read or ends too early.
    pub fn read(path: &Path) -> io::Result<Self> {
        let bytes = std::fs::read(path)?;
        let mut words = WordReader(bytes.as_chunks::<4>().0.iter());
        let sun = words.vector()?;
        let (corners, rays) = (words.list()?, words.list()?);
        let primary = rays.as_chunks::<2>().0.iter().map(|[origin, direction]| Ray::new(*origin, *direction, 0.0));
        Ok(Self { corners, primary: primary.collect(), sun })
    }
}

/// The words of a file that are not read yet.
struct WordReader<'a>(std::slice::Iter<'a, [u8; 4]>);

impl WordReader<'_> {
    fn word(&mut self) -> io::Result<[u8; 4]> {
        self.0.next().copied().ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }

    fn vector(&mut self) -> io::Result<Vec3> {
        let mut number = || self.word().map(f32::from_le_bytes);
        Ok(Vec3::new(number()?, number()?, number()?))
    }

    fn list(&mut self) -> io::Result<Vec<Vec3>> {
        let count = u32::from_le_bytes(self.word()?);
        (0..count).map(|_| self.vector()).collect()
    }
}

fn add(bytes: &mut Vec<u8>, list: &[Vec3]) {
    bytes.extend(list.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes));
}
