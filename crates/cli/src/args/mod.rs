//! Arguments shared by several verbs, and the words in which they are typed.

pub mod folder;
pub mod job;
