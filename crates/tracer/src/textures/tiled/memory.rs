//! The tiles that are in memory.
//!
//! Tiles are spread over shards by a hash. Each shard has a lock and its part of the limit. Within a shard, the clock algorithm (Corbató 1968)
//! chooses the tile to evict: one that was not used since the hand last passed. In front of it is a short list per thread, of the tiles that it read
//! last, without a lock. A thread keeps at most 1.5 MB there, in addition to the limit.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::{cell::RefCell, collections::HashMap};

use etendue_core::storage::Blocks;

const MAX_SHARDS: u64 = 64;

/// Minimum bytes of a shard: two tiles of floats.
const MIN_SHARD_BYTES: u64 = 2 * 64 * 64 * 12;

/// Tiles that a thread keeps in its own list.
const MAX_RECENT_TILES: usize = 32;

/// Numbers the images of this process.
static NUMBER: AtomicU32 = AtomicU32::new(0);

thread_local! {
    static RECENT_TILES: RefCell<[Option<(u64, Tile)>; MAX_RECENT_TILES]> = const { RefCell::new([const { None }; MAX_RECENT_TILES]) };
}

/// Bytes of a tile.
type Tile = Arc<[u8]>;

/// A limited number of tiles of any number of images.
#[derive(Debug)]
pub struct TileMemory {
    shards: Vec<Mutex<Shard>>,
    limit_bytes: u64,
    failure: OnceLock<String>,
}

impl TileMemory {
    /// Memory for `limit_bytes` of tiles, at least for a few.
    #[must_use]
    pub fn new(limit_bytes: u64) -> Self {
        let count = (limit_bytes / (4 * MIN_SHARD_BYTES)).clamp(1, MAX_SHARDS);
        let shard = || Mutex::new(Shard { limit: (limit_bytes / count).max(MIN_SHARD_BYTES), ..Shard::default() });
        let shards = (0..count).map(|_| shard()).collect();
        Self { shards, limit_bytes, failure: OnceLock::new() }
    }

    /// Maximum bytes of tiles.
    #[must_use]
    pub fn limit_bytes(&self) -> u64 {
        self.limit_bytes
    }

    /// Bytes of the tiles that are in memory now.
    #[must_use]
    pub fn held_bytes(&self) -> u64 {
        self.shards.iter().map(|shard| shard.lock().unwrap_or_else(PoisonError::into_inner).bytes).sum()
    }

    /// The first failure to read a tile, if there was one: values that were looked up since are invalid.
    #[must_use]
    pub fn failure(&self) -> Option<&str> {
        self.failure.get().map(String::as_str)
    }

    fn tile(&self, key: u64, read: impl FnOnce() -> Result<Tile, String>) -> Tile {
        let shard = &self.shards[(spread(key) % self.shards.len() as u64) as usize];
        let lock = || shard.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(tile) = lock().find(key) {
            return tile;
        }
        // Not under the lock: another thread may read the same at the same time, which gives the same.
        match read() {
            Ok(tile) => lock().add(key, tile),
            Err(error) => {
                // Only the first is reported.
                let _ = self.failure.set(error);
                Arc::new([])
            }
        }
    }
}

/// Tiles under one lock.
#[derive(Debug, Default)]
struct Shard {
    places: HashMap<u64, usize>,
    slots: Vec<TileSlot>,
    hand: usize,
    bytes: u64,
    limit: u64,
}

#[derive(Debug)]
struct TileSlot {
    key: u64,
    tile: Tile,
    /// True if it was used since the hand last passed.
    is_used: bool,
}

impl Shard {
    fn find(&mut self, key: u64) -> Option<Tile> {
        let slot = &mut self.slots[*self.places.get(&key)?];
        slot.is_used = true;
        Some(Arc::clone(&slot.tile))
    }

    /// Adds a tile, unless it is already present; returns the stored one.
    fn add(&mut self, key: u64, tile: Tile) -> Tile {
        if let Some(known) = self.find(key) {
            return known;
        }
        let bytes = tile.len() as u64;
        while self.bytes + bytes > self.limit && !self.slots.is_empty() {
            self.advance_hand();
        }
        self.bytes += bytes;
        self.places.insert(key, self.slots.len());
        self.slots.push(TileSlot { key, tile: Arc::clone(&tile), is_used: false });
        tile
    }

    /// Moves the hand on by one: over a tile that was used, or removing it.
    fn advance_hand(&mut self) {
        self.hand %= self.slots.len();
        let slot = &mut self.slots[self.hand];
        if std::mem::take(&mut slot.is_used) {
            self.hand += 1;
            return;
        }
        let removed = self.slots.swap_remove(self.hand);
        self.places.remove(&removed.key);
        self.bytes -= removed.tile.len() as u64;
        if let Some(moved) = self.slots.get(self.hand) {
            self.places.insert(moved.key, self.hand);
        }
    }
}

/// The blocks of one image, through the memory.
#[derive(Debug)]
pub(super) struct Tiles {
    number: u32,
    blocks: Arc<dyn Blocks>,
    memory: Arc<TileMemory>,
}

impl Tiles {
    pub(super) fn new(blocks: Arc<dyn Blocks>, memory: Arc<TileMemory>) -> Self {
        Self { number: NUMBER.fetch_add(1, Ordering::Relaxed), blocks, memory }
    }

    pub(super) fn memory(&self) -> &Arc<TileMemory> {
        &self.memory
    }

    /// Applies `value` to a block of `bytes` bytes, or to an empty one if it could not be read.
    pub(super) fn with<T>(&self, block: usize, bytes: usize, value: impl FnOnce(&[u8]) -> T) -> T {
        let key = u64::from(self.number) << 32 | block as u64;
        RECENT_TILES.with_borrow_mut(|recent| {
            let place = &mut recent[spread(key) as usize % MAX_RECENT_TILES];
            let tile = match place {
                Some((known, tile)) if *known == key => tile,
                _ => &mut place.insert((key, self.memory.tile(key, || self.read(block, bytes)))).1,
            };
            value(tile)
        })
    }

    fn read(&self, block: usize, bytes: usize) -> Result<Tile, String> {
        let mut tile: Tile = std::iter::repeat_n(0, bytes).collect();
        let buffer = Arc::get_mut(&mut tile).ok_or("a tile that is just made is shared")?;
        self.blocks.read(block, buffer)?;
        Ok(tile)
    }
}

/// A hash in which every bit depends on all of the key (the finaliser of MurmurHash3, Appleby 2011, its first half).
fn spread(key: u64) -> u64 {
    let mixed = (key ^ (key >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    mixed ^ (mixed >> 33)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(memory: &TileMemory, key: u64) -> Tile {
        memory.tile(key, || Ok(vec![key as u8; 1000].into()))
    }

    #[test]
    fn memory_keeps_its_limit_and_what_is_used() {
        let limit = 2 * MIN_SHARD_BYTES;
        let memory = TileMemory::new(limit);
        for key in 0..10_000 {
            assert_eq!(*tile(&memory, key), [key as u8; 1000]);
            // Used repeatedly: it stays.
            let used = memory.tile(0, || panic!("it was there"));
            assert_eq!(*used, [0; 1000]);
            assert!(memory.held_bytes() <= limit);
        }
        assert!(memory.held_bytes() > limit - 1000, "{}", memory.held_bytes());
        let places = |shard: &Shard| shard.slots.iter().enumerate().all(|(i, slot)| shard.places[&slot.key] == i);
        for shard in &memory.shards {
            let shard = shard.lock().expect("no panic");
            assert!(places(&shard) && shard.places.len() == shard.slots.len());
        }
    }

    #[test]
    fn large_limits_have_many_shards_and_small_ones_room_for_a_tile() {
        assert_eq!(TileMemory::new(1 << 30).shards.len(), 64);
        let minimum = TileMemory::new(1);
        assert_eq!(minimum.shards.len(), 1);
        minimum.tile(1, || Ok(vec![1; 64 * 64 * 12].into()));
        assert_eq!(minimum.held_bytes(), 64 * 64 * 12);
    }

    #[test]
    fn the_first_failure_is_reported() {
        let memory = TileMemory::new(1 << 20);
        assert_eq!(memory.failure(), None);
        assert_eq!(*memory.tile(1, || Err("first".to_owned())), [0; 0]);
        memory.tile(2, || Err("second".to_owned()));
        assert_eq!(memory.failure(), Some("first"));
    }
}
