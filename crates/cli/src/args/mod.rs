//! Arguments that several verbs share, and the words that they are typed in.

pub mod choice;
pub mod depth_of_field;
pub mod file_name;
pub mod folder;
pub mod job;
pub mod run;
pub mod words;
