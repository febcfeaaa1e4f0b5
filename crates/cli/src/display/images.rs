//! The images of a viewer and their unsent tiles.

use super::tev;
use etendue::ImageTile;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Unsent tiles of the two newest images. Older images are complete, or the viewer is too slow to show them: their tiles are dropped, so that a film
/// of many frames takes the memory of at most two.
#[derive(Default)]
pub struct ImageQueue {
    waiting: VecDeque<WaitingImage>,
    /// Names of images that were created in the viewer.
    created: BTreeSet<String>,
}

/// Maximum number of images with unsent tiles.
const MAX_WAITING: usize = 2;

struct WaitingImage {
    name: String,
    size_px: [u32; 2],
    channels: &'static [&'static str],
    /// Values, one channel after the other, by the position of the tile.
    tiles: BTreeMap<TilePlace, Vec<f32>>,
}

/// Position and size of a tile; tiles are sent in this order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct TilePlace {
    first_row: u32,
    first_column: u32,
    rows: u32,
    columns: u32,
}

impl ImageQueue {
    /// Stores a tile.
    pub fn store(&mut self, tile: &ImageTile<'_>) {
        let place = self.waiting.iter().position(|image| image.name == tile.image).unwrap_or_else(|| {
            self.waiting.push_back(WaitingImage::new(tile));
            self.waiting.drain(..self.waiting.len().saturating_sub(MAX_WAITING));
            self.waiting.len() - 1
        });
        self.waiting[place].tiles.insert(TilePlace::new(tile), tile.values.to_vec());
    }

    /// Returns the packets of the next tile; `None` if all are sent.
    pub fn next(&mut self) -> Option<Vec<u8>> {
        let image = self.waiting.front_mut()?;
        let Some((place, values)) = image.tiles.pop_first() else {
            self.waiting.pop_front();
            return self.next();
        };
        let mut packets = match self.created.insert(image.name.clone()) {
            true => tev::create_image(&image.name, image.size_px, image.channels),
            false => Vec::new(),
        };
        let (first_px, size_px) = ([place.first_column, place.first_row], [place.columns, place.rows]);
        packets.extend(tev::update_image(&image.name, image.channels, first_px, size_px, &values));
        Some(packets)
    }
}

impl WaitingImage {
    fn new(tile: &ImageTile<'_>) -> Self {
        Self { name: tile.image.to_owned(), size_px: tile.size_px, channels: tile.channels, tiles: BTreeMap::new() }
    }
}

impl TilePlace {
    fn new(tile: &ImageTile<'_>) -> Self {
        let ([first_column, first_row], [columns, rows]) = (tile.first_px, tile.tile_px);
        Self { first_row, first_column, rows, columns }
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
        let mut images = ImageQueue::default();
        images.store(&tile([2, 1], &[1.0, 2.0, 3.0, 4.0]));
        images.store(&tile([0, 2], &[5.0; 4]));
        images.store(&tile([2, 1], &[6.0, 7.0, 8.0, 9.0]));
        let update = |first, values: &[f32]| tev::update_image("a", &["R", "G"], first, [2, 1], values);
        let created = [tev::create_image("a", [4, 3], &["R", "G"]), update([2, 1], &[6.0, 7.0, 8.0, 9.0])].concat();
        assert_eq!(images.next(), Some(created));
        assert_eq!(images.next(), Some(update([0, 2], &[5.0; 4])));
        assert_eq!(images.next(), None);
    }

    /// A film of 20 frames of 4 × 3 px in two channels, with a viewer that reads nothing: at most the values of two frames wait.
    #[test]
    fn a_film_takes_the_memory_of_two_frames() {
        let mut images = ImageQueue::default();
        let names: Vec<String> = (0..20).map(|frame| format!("front, frame {frame}")).collect();
        for name in &names {
            for first_px in [[0, 0], [2, 0], [0, 2]] {
                images.store(&ImageTile { image: name, ..tile(first_px, &[1.0, 2.0, 3.0, 4.0]) });
            }
        }
        let waiting: usize = images.waiting.iter().flat_map(|image| image.tiles.values()).map(Vec::len).sum();
        assert_eq!(waiting, 2 * 3 * 4);
        let sent = std::iter::from_fn(|| images.next()).count();
        assert_eq!((sent, images.waiting.len()), (6, 0), "nothing is stored when all is sent");
    }

    /// Passes of several films alternate; an image is created in the viewer once.
    #[test]
    fn an_image_with_further_tiles_is_created_once() {
        let mut images = ImageQueue::default();
        let update = |image, values: &[f32]| tev::update_image(image, &["R", "G"], [2, 1], [2, 1], values);
        for (image, is_new) in [("a", true), ("b", true), ("a", false)] {
            images.store(&ImageTile { image, ..tile([2, 1], &[1.0; 4]) });
            let created = if is_new { tev::create_image(image, [4, 3], &["R", "G"]) } else { Vec::new() };
            assert_eq!(images.next(), Some([created, update(image, &[1.0; 4])].concat()));
            assert_eq!(images.next(), None);
        }
    }
}
