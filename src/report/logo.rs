//! The logo on the title page: a PNG picture, as it is for HTML and as bare colours on white for PDF.

use std::fs;
use std::io::Cursor;
use std::path::Path;

/// Most picture points of a logo: sixteen million fill sixty-four megabytes.
const MOST_POINTS: u64 = 16_000_000;

/// A picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Logo {
    /// The file as it is.
    pub png: Vec<u8>,
    /// Width and height, picture points.
    pub size: [u32; 2],
    /// Red, green and blue of every point, row by row, laid on white.
    pub rgb: Vec<u8>,
}

impl Logo {
    /// Reads a PNG file.
    ///
    /// # Errors
    /// One line: the file.
    pub(super) fn read(path: &Path) -> Result<Self, String> {
        let name = path.display();
        let bytes = fs::read(path).map_err(|e| format!("{name}: the logo cannot be read ({e})"))?;
        Self::decoded(bytes).map_err(|why| format!("{name}: the logo is not a PNG picture that can be read ({why})"))
    }

    fn decoded(png: Vec<u8>) -> Result<Self, String> {
        let mut decoder = png::Decoder::new(Cursor::new(&png));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
        let (width, height) = reader.info().size();
        if u64::from(width) * u64::from(height) > MOST_POINTS {
            return Err(format!("{width} x {height} points are too many; make it smaller"));
        }
        let length = reader.output_buffer_size().ok_or("it is too large")?;
        let mut points = vec![0; length];
        let frame = reader.next_frame(&mut points).map_err(|e| e.to_string())?;
        let rgb = on_white(&points[..frame.buffer_size()], frame.color_type);
        Ok(Self { size: [width, height], rgb, png })
    }
}

/// Red, green and blue of points of any kind, what is transparent laid on white.
fn on_white(points: &[u8], kind: png::ColorType) -> Vec<u8> {
    let laid = |value: u8, alpha: u8| {
        let (value, alpha) = (u32::from(value), u32::from(alpha));
        ((value * alpha + 255 * (255 - alpha) + 127) / 255) as u8
    };
    match kind {
        png::ColorType::Grayscale => points.iter().flat_map(|&v| [v; 3]).collect(),
        png::ColorType::GrayscaleAlpha => points.chunks_exact(2).flat_map(|p| [laid(p[0], p[1]); 3]).collect(),
        png::ColorType::Rgba => points.chunks_exact(4).flat_map(|p| [0, 1, 2].map(|k| laid(p[k], p[3]))).collect(),
        // Palettes are expanded by the decoder.
        png::ColorType::Rgb | png::ColorType::Indexed => points.to_vec(),
    }
}

/// A PNG file of `width` by `height` points of a kind.
#[cfg(test)]
pub(super) fn written(width: u32, height: u32, kind: png::ColorType, points: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(kind);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut w| w.write_image_data(points));
    assert!(written.is_ok(), "{written:?}");
    bytes
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]
    use super::{Logo, written};

    #[test]
    fn what_is_transparent_is_white() {
        let points = [255, 0, 0, 255, 0, 0, 255, 0, 0, 0, 0, 128, 10, 20, 30, 255];
        let logo = Logo::decoded(written(2, 2, png::ColorType::Rgba, &points)).unwrap();
        assert_eq!(logo.size, [2, 2]);
        assert_eq!(logo.rgb, [255, 0, 0, 255, 255, 255, 127, 127, 127, 10, 20, 30]);
        let grey = Logo::decoded(written(2, 1, png::ColorType::GrayscaleAlpha, &[7, 255, 7, 0])).unwrap();
        assert_eq!(grey.rgb, [7, 7, 7, 255, 255, 255]);
    }

    #[test]
    fn what_is_no_picture_is_refused_with_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("logo.png");
        std::fs::write(&path, "not a picture").unwrap();
        let said = Logo::read(&path).unwrap_err();
        assert!(said.contains("logo.png") && said.contains("PNG") && said.lines().count() == 1, "{said}");
        assert!(Logo::read(&folder.path().join("no.png")).unwrap_err().contains("cannot be read"));
        let cut = written(2, 2, png::ColorType::Rgb, &[9; 12]);
        std::fs::write(&path, &cut[..cut.len() / 2]).unwrap();
        assert!(Logo::read(&path).is_err());
    }
}
