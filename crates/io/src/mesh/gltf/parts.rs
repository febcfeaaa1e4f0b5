//! Parts of a glTF file: the file without moving nodes, and each moving node by itself, as the same file with another tree.

use etendue_scene::limits;
use serde_json::{Map, Value, json};

use super::{buffers::unescaped, document};
use crate::Problem;

/// glTF file that is split into parts.
#[derive(Clone, Debug)]
pub struct GltfParts {
    json: Value,
    /// Binary chunk of a GLB file; the parts name it as a separate file.
    pub blob: Option<Vec<u8>>,
    movers: Vec<usize>,
    /// True for moving nodes.
    is_mover: Vec<bool>,
    /// True for nodes that have a parent.
    is_child: Vec<bool>,
    /// Bytes of the JSON.
    bytes: u64,
    /// Moving node in which each node is static; `None`: static in the file.
    pub mover_of: Vec<Option<usize>>,
}

impl GltfParts {
    pub(super) fn new(
        bytes: &[u8],
        blob: Option<Vec<u8>>,
        movers: Vec<usize>,
        mover_of: Vec<Option<usize>>,
    ) -> Result<Self, Problem> {
        let json = document::json_of(bytes)?;
        let (mut is_mover, mut is_child) = (vec![false; mover_of.len()], vec![false; mover_of.len()]);
        movers.iter().for_each(|node| is_mover[*node] = true);
        let nodes = json.get("nodes").and_then(Value::as_array);
        let children = nodes.into_iter().flatten().filter_map(|node| node.get("children")?.as_array());
        for child in children.flatten().filter_map(Value::as_u64) {
            if let Some(is_child) = is_child.get_mut(child as usize) {
                *is_child = true;
            }
        }
        Ok(Self { json, blob, movers, is_mover, is_child, bytes: bytes.len() as u64, mover_of })
    }

    /// Refuses a number of parts that would multiply the file beyond the limit.
    ///
    /// # Errors
    /// If it would.
    pub fn check_size(&self, parts: usize) -> Result<(), Problem> {
        limits::MESH.check_unpacked(self.bytes.saturating_mul(parts as u64))
    }

    /// Part of a moving node, scaled by three numbers along its own axes and not moved; for `None` all static nodes. `way` gives the path, from the part's
    /// location, to a resource that the file names; `blob` is the name of its binary chunk there.
    #[must_use]
    pub fn part(&self, mover: Option<(usize, [f64; 3])>, blob: &str, path_of: &dyn Fn(&str) -> String) -> Vec<u8> {
        let mut json = self.json.clone();
        let Some(root) = json.as_object_mut() else { return Vec::new() };
        root.remove("animations");
        let scene = root.get("scene").and_then(Value::as_u64).unwrap_or(0) as usize;
        let roots: Vec<Value> = match root.get("scenes").and_then(|scenes| scenes.get(scene)?.get("nodes")?.as_array())
        {
            Some(nodes) => nodes.clone(),
            None => (0..self.mover_of.len()).filter(|node| !self.is_child[*node]).map(|node| json!(node)).collect(),
        };
        let is_mover = |node: &Value| {
            node.as_u64().and_then(|node| self.is_mover.get(node as usize)).is_some_and(|is_mover| *is_mover)
        };
        let shown: Vec<Value> = match mover {
            None => roots.into_iter().filter(|node| !is_mover(node)).collect(),
            Some((mover, _)) => vec![json!(self.movers[mover])],
        };
        for node in list(root, "nodes") {
            if let Some(Value::Array(children)) = node.get_mut("children") {
                children.retain(|child| !is_mover(child));
                if children.is_empty() {
                    node.remove("children");
                }
            }
        }
        if let Some((mover, scale)) = mover
            && let Some(node) = list(root, "nodes").nth(self.movers[mover])
        {
            node.remove("translation");
            node.remove("rotation");
            node.insert("scale".to_owned(), json!(scale));
        }
        root.insert("scene".to_owned(), json!(0));
        root.insert("scenes".to_owned(), json!([if shown.is_empty() { json!({}) } else { json!({ "nodes": shown }) }]));
        for (key, first) in [("buffers", Some(blob)), ("images", None)] {
            for (i, entry) in list(root, key).enumerate() {
                match (entry.get("uri").and_then(Value::as_str), first) {
                    (Some(uri), _) if uri.starts_with("data:") => {}
                    (Some(uri), _) => {
                        let led = escaped(&path_of(&unescaped(uri)));
                        entry.insert("uri".to_owned(), json!(led));
                    }
                    (None, Some(blob)) if i == 0 && self.blob.is_some() => {
                        entry.insert("uri".to_owned(), json!(escaped(blob)));
                    }
                    _ => {}
                }
            }
        }
        serde_json::to_vec(&json).unwrap_or_default()
    }
}

/// The objects of a list.
fn list<'a>(root: &'a mut Map<String, Value>, key: &str) -> impl Iterator<Item = &'a mut Map<String, Value>> {
    root.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten().filter_map(Value::as_object_mut)
}

/// Path as a relative reference.
fn escaped(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    path.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_escaped_and_found_again() {
        assert_eq!(escaped("../a b/ü%.bin"), "../a%20b/%C3%BC%25.bin");
        assert_eq!(unescaped(&escaped("../a b/ü%.bin")), "../a b/ü%.bin");
    }
}
