//! The images of a viewer, as far as they are to be sent.

use super::tev;
use etendue::ImageTile;
use std::collections::BTreeSet;

/// Images by name, and which tiles of them are not sent yet.
#[derive(Default)]
pub struct Images {
    images: Vec<Image>,
    /// Image, first row and column, rows and columns.
    waiting: BTreeSet<(usize, [u32; 2], [u32; 2])>,
}

struct Image {
    name: String,
    size_px: [u32; 2],
    channels: &'static [&'static str],
    /// One channel after the other.
    values: Vec<f32>,
    is_created: bool,
}

impl Images {
    /// Takes a tile over.
    pub fn put(&mut self, tile: &ImageTile<'_>) {
        let place = self.images.iter().position(|image| image.name == tile.image).unwrap_or_else(|| {
            self.images.push(Image::of(tile));
            self.images.len() - 1
        });
        self.images[place].put(tile);
        let [x, y] = tile.first_px;
        let [width, height] = tile.tile_px;
        self.waiting.insert((place, [y, x], [height, width]));
    }

    /// The packets that send the next tile; `None` where all are sent.
    pub fn next(&mut self) -> Option<Vec<u8>> {
        let (place, [y, x], [height, width]) = self.waiting.pop_first()?;
        let image = &mut self.images[place];
        let mut packets = match std::mem::replace(&mut image.is_created, true) {
            true => Vec::new(),
            false => tev::create_image(&image.name, image.size_px, image.channels),
        };
        let values = image.values_of([x, y], [width, height]);
        packets.extend(tev::update_image(&image.name, image.channels, [x, y], [width, height], &values));
        Some(packets)
    }
}

impl Image {
    fn of(tile: &ImageTile<'_>) -> Self {
        let (size_px, channels) = (tile.size_px, tile.channels);
        let values = vec![0.0; size_px[0] as usize * size_px[1] as usize * channels.len()];
        Self { name: tile.image.to_owned(), size_px, channels, values, is_created: false }
    }

    /// Where the rows of a rectangle are among the values, channel after channel.
    fn rows(
        &self,
        [x, y]: [u32; 2],
        [width, height]: [u32; 2],
    ) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let [columns, rows] = self.size_px.map(|px| px as usize);
        let first = move |channel: usize, row: u32| (channel * rows + row as usize) * columns + x as usize;
        let of_channel = move |channel| (y..y + height).map(move |row| first(channel, row));
        (0..self.channels.len()).flat_map(of_channel).map(move |first| first..first + width as usize)
    }

    fn put(&mut self, tile: &ImageTile<'_>) {
        let rows = self.rows(tile.first_px, tile.tile_px);
        for (row, values) in rows.zip(tile.values.chunks(tile.tile_px[0] as usize)) {
            self.values[row].copy_from_slice(values);
        }
    }

    fn values_of(&self, first_px: [u32; 2], size_px: [u32; 2]) -> Vec<f32> {
        self.rows(first_px, size_px).flat_map(|row| self.values[row].iter().copied()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(first_px: [u32; 2], values: &[f32]) -> ImageTile<'_> {
        ImageTile { image: "a", size_px: [4, 3], first_px, tile_px: [2, 1], channels: &["R", "G"], values }
    }

    #[test]
    fn a_tile_that_is_refined_before_it_is_sent_is_sent_once() {
        let mut images = Images::default();
        images.put(&tile([2, 1], &[1.0, 2.0, 3.0, 4.0]));
        images.put(&tile([0, 2], &[5.0; 4]));
        images.put(&tile([2, 1], &[6.0, 7.0, 8.0, 9.0]));
        let update = |first, values: &[f32]| tev::update_image("a", &["R", "G"], first, [2, 1], values);
        let created = [tev::create_image("a", [4, 3], &["R", "G"]), update([2, 1], &[6.0, 7.0, 8.0, 9.0])].concat();
        assert_eq!(images.next(), Some(created));
        assert_eq!(images.next(), Some(update([0, 2], &[5.0; 4])));
        assert_eq!(images.next(), None);
    }
}
