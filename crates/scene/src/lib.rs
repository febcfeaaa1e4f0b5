//! The description of a job: records in file units with their places, parsing and checking.
