//! `[sensor]`: from the record to the sensor's model.

mod channels;
mod charge;
mod electronics;
mod light;
mod read_out;
mod stated;

pub(super) use electronics::{fill_factor, sensor};
