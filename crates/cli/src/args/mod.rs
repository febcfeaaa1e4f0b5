//! Arguments that several verbs share, and the words that they are typed in.

pub mod folder;
pub mod job;
