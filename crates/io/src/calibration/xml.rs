//! OpenCV's FileStorage as XML, as the tree of its YAML.
//!
//! | element | node |
//! | --- | --- |
//! | with elements of names | keys with values |
//! | with elements `_` | list |
//! | with words between blanks | list of them; a text in double quotes is one word |
//! | with one word, or none | value |
//!
//! The root is `opencv_storage`; `type_id` and other attributes add nothing to the elements.

use roxmltree::{Document, Node};

use super::{ErrorCode, TreeError, TreeResult};
use crate::tree::{MAX_DEPTH, MAX_VALUES, NodeValue, TreeNode};

/// Name of an element of a list.
const ITEM: &str = "_";

/// Reads a document.
pub(super) fn parse(text: &str) -> TreeResult<TreeNode> {
    let document =
        Document::parse(text).map_err(|cause| TreeError::at(cause.pos().row as usize, format!("not XML: {cause}")))?;
    let root = document.root_element();
    let mut storage = Storage { lines: lines(text), value_count: 0 };
    if root.tag_name().name() != "opencv_storage" {
        let name = root.tag_name().name();
        return Err(TreeError::coded(
            ErrorCode::UnsupportedFile,
            storage.line(&root),
            format!("the root element is <{name}>; expected <opencv_storage>"),
        ));
    }
    storage.node(&root, 0)
}

/// Offsets of the ends of lines.
fn lines(text: &str) -> Vec<usize> {
    text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at).collect()
}

/// State while a document is read.
struct Storage {
    lines: Vec<usize>,
    value_count: usize,
}

impl Storage {
    fn line(&self, node: &Node<'_, '_>) -> usize {
        self.lines.partition_point(|end| *end < node.range().start) + 1
    }

    fn node(&mut self, element: &Node<'_, '_>, depth: usize) -> TreeResult<TreeNode> {
        let line = self.line(element);
        if depth > MAX_DEPTH {
            return Err(TreeError::at(
                line,
                format!("nested more than {MAX_DEPTH} levels deep, which is not supported"),
            ));
        }
        let children: Vec<Node<'_, '_>> = element.children().filter(Node::is_element).collect();
        let value = match children.first() {
            None => self.words(element, line)?,
            Some(first) if first.tag_name().name() == ITEM => {
                NodeValue::List(children.iter().map(|child| self.node(child, depth + 1)).collect::<TreeResult<_>>()?)
            }
            Some(_) => NodeValue::Map(self.entries(&children, depth)?),
        };
        self.add_values(1, line)?;
        Ok(TreeNode::new(line, value))
    }

    fn entries(&mut self, children: &[Node<'_, '_>], depth: usize) -> TreeResult<Vec<(String, TreeNode)>> {
        let mut entries: Vec<(String, TreeNode)> = Vec::new();
        let mut keys = std::collections::BTreeSet::new();
        for child in children {
            let key = child.tag_name().name().to_owned();
            if !keys.insert(key.clone()) {
                return Err(TreeError::coded(
                    ErrorCode::Duplicate,
                    self.line(child),
                    format!("the element {key} appears twice"),
                ));
            }
            entries.push((key, self.node(child, depth + 1)?));
        }
        Ok(entries)
    }

    fn words(&mut self, element: &Node<'_, '_>, line: usize) -> TreeResult<NodeValue> {
        let text: String = element.children().filter(Node::is_text).filter_map(|child| child.text()).collect();
        let text = text.trim();
        if let Some(quoted) = text.strip_prefix('"').and_then(|text| text.strip_suffix('"')) {
            return Ok(NodeValue::Scalar(quoted.to_owned()));
        }
        let words: Vec<&str> = text.split_whitespace().collect();
        self.add_values(words.len(), line)?;
        Ok(match words[..] {
            [] => NodeValue::Scalar(String::new()),
            [word] => NodeValue::Scalar(word.to_owned()),
            _ => {
                let item = |word: &&str| TreeNode::new(line, NodeValue::Scalar((*word).to_owned()));
                NodeValue::List(words.iter().map(item).collect())
            }
        })
    }

    fn add_values(&mut self, count: usize, line: usize) -> TreeResult<()> {
        self.value_count += count;
        if self.value_count <= MAX_VALUES {
            return Ok(());
        }
        let what = format!("contains more than {MAX_VALUES} values, which is not supported");
        Err(TreeError::coded(ErrorCode::UnsupportedFile, line, what))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_become_keys_lists_and_values() {
        let text = "<?xml version=\"1.0\"?>\n<opencv_storage>\n<time>\"Mon 1 Jan\"</time>\n<size>640 480</size>\n\
                    <views><_><n>1</n></_>\n<_><n>2.5</n></_></views><none></none>\n<one>\n 3.</one></opencv_storage>\n";
        let root = parse(text).expect("XML");
        assert_eq!(root.keys(), ["time", "size", "views", "none", "one"]);
        assert_eq!(root.key("time").expect("there").text().expect("text"), "Mon 1 Jan");
        assert_eq!(root.key("size").expect("there").numbers().expect("numbers"), [640.0, 480.0]);
        let views = root.key("views").expect("there").items().expect("a list");
        assert_eq!(views[1].key("n").expect("there").number().expect("a number"), 2.5);
        assert_eq!((root.key("one").expect("there").line, views[1].line), (7, 6));
        assert_eq!(root.key("one").expect("there").count().expect("a count"), 3);
    }

    #[test]
    fn errors_name_the_line() {
        let error = |text: &str| parse(text).expect_err("wrong");
        assert!(error("<opencv_storage>\n<a>1</b>\n</opencv_storage>").what.contains("not XML"));
        assert_eq!(error("<opencv_storage>\n<a>1</b>\n</opencv_storage>").line, 2);
        assert!(error("<scene/>").what.contains("expected <opencv_storage>"));
        assert_eq!(error("<opencv_storage>\n<a>1</a>\n<a>2</a></opencv_storage>").line, 3);
        let deep = format!("<opencv_storage>{}</opencv_storage>", "<a>".repeat(40) + &"</a>".repeat(40));
        assert!(error(&deep).what.contains("32 levels"));
    }
}
