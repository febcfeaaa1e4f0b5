//! What textures take in memory and on the disk.

use etendue_tracer::materials::MaterialTable;

/// Bytes of texels, and where they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TextureUse {
    /// Of textures that are in memory, bytes.
    held_bytes: u64,
    /// Textures that are in tiles on the disk.
    tiled: usize,
    /// Of these, bytes on the disk.
    tiled_bytes: u64,
    /// Of these, most bytes in memory.
    limit_bytes: u64,
}

impl TextureUse {
    pub(super) fn of(materials: &MaterialTable) -> Self {
        let mut all = Self::default();
        for texture in materials.textures() {
            all.held_bytes += texture.texel_bytes() as u64;
            if let Some((bytes, memory)) = texture.tiles() {
                all.tiled += 1;
                all.tiled_bytes += bytes;
                // All textures share one memory.
                all.limit_bytes = memory.limit_bytes();
            }
        }
        all
    }

    /// Most memory, bytes.
    pub(super) fn memory_bytes(&self) -> u64 {
        self.held_bytes + self.limit_bytes.min(self.tiled_bytes)
    }

    /// What is on the disk, in words; `None` where nothing is.
    pub(super) fn tiles(&self) -> Option<String> {
        let [tiled, limit] = [self.tiled_bytes, self.limit_bytes].map(|bytes| bytes.div_ceil(1_000_000));
        let count = self.tiled;
        (count > 0).then(|| format!("{count} in tiles on the disk, {tiled} MB; at most {limit} MB of them in memory"))
    }
}
