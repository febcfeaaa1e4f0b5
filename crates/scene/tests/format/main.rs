//! The format of descriptions: the examples of its pages, texts of errors, schema and reference.

mod base;
mod contradictions;
mod example;
mod faults;
mod files;
mod hostile;
mod modulations;
mod motion;
mod pages;
mod reference;
mod schema;
mod unused;
mod written;
