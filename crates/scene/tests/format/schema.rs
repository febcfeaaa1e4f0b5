//! The schema says what the parser accepts.
