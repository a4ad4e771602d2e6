//! Streams of a PDF, compressed.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write as _;

/// Bytes as a deflated stream; writing into memory does not fail.
pub(super) fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default()
}
