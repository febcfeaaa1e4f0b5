//! Used parts of a scene: materials and meshes of objects, and their dependencies.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use crate::asset::file_list::names_files;
use crate::fault::NameKind;
use crate::place::{Place, Placed};
use crate::record::{Material, Scene};

/// Names of a scene that no visible object depends on. Their files are not read and need not exist.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnusedNames {
    /// Meshes of no object.
    pub meshes: BTreeSet<String>,
    /// Textures that nothing visible uses.
    pub textures: BTreeSet<String>,
    /// Materials of no object, neither directly nor as a part of another material.
    pub materials: BTreeSet<String>,
    /// Unused materials that name files or textures, and so cannot be built.
    pub unread: BTreeSet<String>,
    /// Frames in which nothing is placed, neither directly nor in a frame that they carry.
    pub frames: BTreeSet<String>,
}

/// A use of a name: its kind, and its place.
pub(super) type NameUse = (NameKind, Placed<String>);

impl UnusedNames {
    /// Follows the `uses` of names from every record that is no material or frame.
    pub(super) fn new(scene: &Scene, uses: &[NameUse]) -> Self {
        let materials = scene.materials.iter().map(|m| (m.place.key(), (NameKind::Material, m.name.value.as_str())));
        let frames = scene.frames.iter().map(|f| (f.place.key(), (NameKind::Frame, f.name.value.as_str())));
        let owners: BTreeMap<Cow<'_, str>, NameOwner<'_>> = materials.chain(frames).collect();
        let mut by_owner: BTreeMap<Option<NameOwner<'_>>, Vec<&NameUse>> = BTreeMap::new();
        for named in uses {
            by_owner.entry(owner(&owners, &named.1.place)).or_default().push(named);
        }
        let mut used: BTreeSet<(NameKind, &str)> = BTreeSet::new();
        let mut open = by_owner.get(&None).cloned().unwrap_or_default();
        while let Some((named, name)) = open.pop() {
            if used.insert((*named, name.as_str())) {
                open.extend(by_owner.get(&Some((*named, name.as_str()))).into_iter().flatten());
            }
        }
        let rest = |named, names: &mut dyn Iterator<Item = &Placed<String>>| {
            names.filter(|name| !used.contains(&(named, name.as_str()))).map(|name| name.value.clone()).collect()
        };
        let materials: BTreeSet<String> = rest(NameKind::Material, &mut scene.materials.iter().map(|m| &m.name));
        let has_texture = |name: &str| {
            by_owner
                .get(&Some((NameKind::Material, name)))
                .is_some_and(|uses| uses.iter().any(|u| u.0 == NameKind::Texture))
        };
        let is_unread = |m: &&Material| materials.contains(&m.name.value) && (has_texture(&m.name) || names_files(*m));
        Self {
            unread: scene.materials.iter().filter(is_unread).map(|m| m.name.value.clone()).collect(),
            meshes: rest(NameKind::Mesh, &mut scene.meshes.iter().map(|m| &m.name)),
            textures: rest(NameKind::Texture, &mut scene.textures.iter().map(|t| &t.name)),
            frames: rest(NameKind::Frame, &mut scene.frames.iter().map(|f| &f.name)),
            materials,
        }
    }

    /// One sentence for each kind with unused names.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let note = |names: &BTreeSet<String>, one: &str, many: &str| match names.len() {
            0 => None,
            1 => Some(format!("not read: {one}: {}", listed(names))),
            count => Some(format!("not read: {count} {many}: {}", listed(names))),
        };
        let kinds = [
            note(&self.meshes, "mesh used by no object", "meshes used by no object"),
            note(&self.materials, "material used by no object", "materials used by no object"),
            note(&self.textures, "texture used by no material in use", "textures used by no material in use"),
            note(&self.frames, "frame to which nothing is attached", "frames to which nothing is attached"),
        ];
        kinds.into_iter().flatten().collect()
    }
}

/// The first names.
fn listed(names: &BTreeSet<String>) -> String {
    const MAX_LISTED_NAMES: usize = 6;
    let first: Vec<&str> = names.iter().take(MAX_LISTED_NAMES).map(String::as_str).collect();
    let more = if names.len() > MAX_LISTED_NAMES { ", …" } else { "" };
    format!("{}{more}", first.join(", "))
}

/// Owner of names that count only if it is used itself: a material or a frame, by its name.
type NameOwner<'a> = (NameKind, &'a str);

/// Returns the material or frame whose keys include `place`.
fn owner<'m>(materials: &BTreeMap<Cow<'_, str>, NameOwner<'m>>, place: &Place) -> Option<NameOwner<'m>> {
    let key = place.key();
    // Names may contain dots ("wood", "wood.001"): the longest match.
    key.rmatch_indices(['.', '[']).find_map(|(end, _)| materials.get(&key[..end]).copied())
}
