//! The reference on the page is the schema.
