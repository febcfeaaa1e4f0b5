//! Projections: properties, closed forms, other programs.

mod cameras;
mod models;
mod opencv;
mod properties;
