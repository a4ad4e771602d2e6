//! Estimates the fundamental frequency of a record.
