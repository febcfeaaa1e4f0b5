//! Extensions of glTF that compress vertices or images, and their fallbacks.
//!
//! Sources: EXT_meshopt_compression, KHR_draco_mesh_compression, KHR_texture_basisu, EXT_texture_webp, MSFT_texture_dds (Khronos extension registry). Compressed
//! vertices and KTX2 images are not decoded: the uncompressed data or image beside them is used where the file has it, and otherwise the file is refused.

use gltf::json::{Buffer, Root, Texture, Value, accessor::Accessor};

use crate::Problem;

/// Extension that is not decoded, and the command that writes a file without it.
pub(super) struct Compression {
    pub(super) name: &'static str,
    command: &'static str,
}

pub(super) const MESHOPT: Compression =
    Compression { name: "EXT_meshopt_compression", command: "gltf-transform copy in.glb out.glb" };
const KHR_MESHOPT: Compression =
    Compression { name: "KHR_meshopt_compression", command: "gltf-transform copy in.glb out.glb" };
const DRACO: Compression =
    Compression { name: "KHR_draco_mesh_compression", command: "gltf-transform copy in.glb out.glb" };
const BASISU: Compression =
    Compression { name: "KHR_texture_basisu", command: "gltf-transform ktxdecompress in.glb out.glb" };
const AVIF: Compression = Compression { name: "EXT_texture_avif", command: "gltf-transform png in.glb out.glb" };

const ALL: [&Compression; 5] = [&MESHOPT, &KHR_MESHOPT, &DRACO, &BASISU, &AVIF];

/// Extensions whose images are read.
const READ_IMAGES: [&str; 2] = ["EXT_texture_webp", "MSFT_texture_dds"];

impl Compression {
    /// Refusal of something that only the extension describes.
    pub(super) fn refusal(&self, what: &str) -> String {
        let Self { name, command } = self;
        format!("{what} is compressed with {name}, which is not supported; write the file without it: `{command}`")
    }
}

/// Compression of this name; `None` for other extensions.
pub(super) fn find(name: &str) -> Option<&'static Compression> {
    ALL.into_iter().find(|compression| compression.name == name)
}

/// Refuses a file that requires the decoding of vertices, or whose compressed primitives have no uncompressed data.
pub(super) fn check(root: &Root) -> Result<(), Problem> {
    let required = |compression: &Compression| root.extensions_required.iter().any(|name| name == compression.name);
    if let Some(compression) = [&MESHOPT, &KHR_MESHOPT, &DRACO].into_iter().find(|c| required(c)) {
        return Err(compression.refusal("the mesh").into());
    }
    for (number, mesh) in root.meshes.iter().enumerate() {
        let compressed = mesh.primitives.iter().filter(|primitive| {
            primitive.extensions.as_ref().is_some_and(|extensions| extensions.others.contains_key(DRACO.name))
        });
        let accessors = compressed.flat_map(|primitive| primitive.attributes.values().chain(&primitive.indices));
        let is_empty = |accessor: &Accessor| accessor.buffer_view.is_none() && accessor.sparse.is_none();
        if accessors.filter_map(|index| root.accessors.get(index.value())).any(is_empty) {
            return Err(DRACO.refusal(&format!("mesh {number}")).into());
        }
    }
    Ok(())
}

/// Returns true for a buffer that holds uncompressed copies of compressed views, which a file may omit.
pub(super) fn is_fallback(buffer: &Buffer) -> bool {
    let extensions = buffer.extensions.as_ref();
    [MESHOPT.name, KHR_MESHOPT.name].iter().any(|name| {
        let extension = extensions.and_then(|extensions| extensions.others.get(*name));
        extension.and_then(|value| value.get("fallback")).and_then(Value::as_bool) == Some(true)
    })
}

/// Number of the image of a texture: its uncompressed one, else that of an extension whose images are read.
pub(super) fn image_of(number: usize, texture: &Texture) -> Result<usize, Problem> {
    /// Source of a texture without an image, in the gltf crate.
    const NONE: usize = u32::MAX as usize;
    if texture.source.value() != NONE {
        return Ok(texture.source.value());
    }
    let extensions = texture.extensions.as_ref();
    let source = |name: &str| extensions.and_then(|e| e.others.get(name)?.get("source")?.as_u64());
    if let Some(image) = READ_IMAGES.into_iter().find_map(source) {
        return Ok(image as usize);
    }
    match ALL.into_iter().find(|compression| source(compression.name).is_some()) {
        Some(compression) => Err(compression.refusal(&format!("texture {number}")).into()),
        None => Err(format!("texture {number} has no image; export the file again").into()),
    }
}

/// Notes on extensions of which the fallback is used.
pub(super) fn notes(root: &Root) -> Vec<String> {
    let used = |name: &&str| root.extensions_used.iter().any(|used| used == name);
    let names = ALL.into_iter().map(|compression| compression.name).filter(used);
    let mut notes: Vec<String> =
        names.map(|name| format!("{name} is not used: the uncompressed data or image beside it is")).collect();
    let has_other = |name: &&str| {
        root.textures.iter().any(|texture| {
            let has = texture.extensions.as_ref().is_some_and(|e| e.others.contains_key(*name));
            has && texture.source.value() != u32::MAX as usize
        })
    };
    let preferred = READ_IMAGES.into_iter().filter(has_other);
    notes.extend(preferred.map(|name| format!("{name} is not used where the texture has another image")));
    notes
}
