//! Colours, sizes of type and strokes of every plot, light and dark, on the screen and on paper.
//!
//! Data colours follow Okabe and Ito's set, which stays apart under all common kinds of colour blindness: measured data is
//! blue, the model vermilion or amber, a missing effect reddish purple; everywhere the same. The accent (teal) is for what
//! can be clicked, never for data.

use super::drawing::Stroke;
use ecolor::Color32;

/// Sizes of type in points.
pub mod size {
    /// Units, hints, tick labels.
    pub const SMALL: f32 = 11.5;
    /// Text.
    pub const BODY: f32 = 13.5;
    /// Titles of panes.
    pub const HEADING: f32 = 15.0;
    /// Title of the start screen.
    pub const TITLE: f32 = 30.0;
    /// The one figure of a pane.
    pub const FIGURE: f32 = 22.0;
}

/// All colours of one theme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Palette {
    /// Measured data.
    pub measured: Color32,
    /// The model's prediction and what was identified.
    pub model: Color32,
    /// A missing effect and what is left over.
    pub missing: Color32,
    /// What can be clicked and what is selected.
    pub accent: Color32,
    /// Background of what is selected.
    pub accent_faint: Color32,
    /// Text and lines of the structure.
    pub ink: Color32,
    /// Second-rank text.
    pub weak: Color32,
    /// Lines between things.
    pub line: Color32,
    /// Grid of a plot.
    pub grid: Color32,
    /// Behind everything.
    pub desk: Color32,
    /// Of panes and bars.
    pub pane: Color32,
    /// Of plots and of the schematic.
    pub canvas: Color32,
    /// Of buttons and stripes.
    pub raised: Color32,
    /// Something is in order.
    pub good: Color32,
    /// Something needs attention.
    pub warning: Color32,
    /// Something failed.
    pub error: Color32,
    /// Levels of force from lowest to highest.
    pub levels: [Color32; 4],
}

const LIGHT: Palette = Palette {
    measured: Color32::from_rgb(0x00, 0x66, 0xA6),
    model: Color32::from_rgb(0xD5, 0x5E, 0x00),
    missing: Color32::from_rgb(0xA8, 0x4A, 0x86),
    accent: Color32::from_rgb(0x0B, 0x72, 0x6E),
    accent_faint: Color32::from_rgb(0xDC, 0xEF, 0xED),
    ink: Color32::from_rgb(0x17, 0x1D, 0x24),
    weak: Color32::from_rgb(0x56, 0x61, 0x6D),
    line: Color32::from_rgb(0xD6, 0xDB, 0xE1),
    grid: Color32::from_rgb(0xC2, 0xC9, 0xD1),
    desk: Color32::from_rgb(0xE9, 0xEC, 0xEF),
    pane: Color32::from_rgb(0xFA, 0xFB, 0xFC),
    canvas: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    raised: Color32::from_rgb(0xEF, 0xF2, 0xF5),
    good: Color32::from_rgb(0x1B, 0x7F, 0x4B),
    warning: Color32::from_rgb(0x9A, 0x62, 0x00),
    error: Color32::from_rgb(0xB3, 0x26, 0x1E),
    levels: [
        Color32::from_rgb(0x44, 0x17, 0x61),
        Color32::from_rgb(0x2A, 0x6A, 0x96),
        Color32::from_rgb(0x1F, 0x8F, 0x6E),
        Color32::from_rgb(0xB8, 0x8A, 0x00),
    ],
};

const DARK: Palette = Palette {
    measured: Color32::from_rgb(0x56, 0xB4, 0xE9),
    model: Color32::from_rgb(0xF0, 0x9A, 0x3E),
    missing: Color32::from_rgb(0xE0, 0x8F, 0xC0),
    accent: Color32::from_rgb(0x4F, 0xC4, 0xBB),
    accent_faint: Color32::from_rgb(0x1B, 0x3B, 0x3A),
    ink: Color32::from_rgb(0xE6, 0xE9, 0xED),
    weak: Color32::from_rgb(0x9D, 0xA8, 0xB4),
    line: Color32::from_rgb(0x33, 0x3A, 0x42),
    grid: Color32::from_rgb(0x4A, 0x53, 0x5D),
    desk: Color32::from_rgb(0x0E, 0x10, 0x13),
    pane: Color32::from_rgb(0x1A, 0x1E, 0x23),
    canvas: Color32::from_rgb(0x14, 0x17, 0x1B),
    raised: Color32::from_rgb(0x26, 0x2C, 0x33),
    good: Color32::from_rgb(0x5C, 0xC8, 0x8F),
    warning: Color32::from_rgb(0xE8, 0xB3, 0x4B),
    error: Color32::from_rgb(0xF2, 0x8B, 0x82),
    levels: [
        Color32::from_rgb(0x8C, 0x6B, 0xD6),
        Color32::from_rgb(0x4A, 0x9B, 0xD4),
        Color32::from_rgb(0x4F, 0xC4, 0x8B),
        Color32::from_rgb(0xF5, 0xD7, 0x42),
    ],
};

impl Palette {
    /// The palette of the light theme; that of what is printed.
    pub fn light() -> &'static Self {
        &LIGHT
    }

    /// The palette of the dark theme.
    pub fn dark() -> &'static Self {
        &DARK
    }

    /// Colour of a signed share from -1 to 1: blue below zero, canvas at zero, vermilion above.
    pub fn diverging(&self, share: f32) -> Color32 {
        let end = if share < 0.0 { self.measured } else { self.model };
        self.canvas.lerp_to_gamma(end, 0.85 * share.abs().min(1.0).powf(0.8))
    }

    /// Colour of a level of force from 0 (lowest) to 1 (highest): from blue through green to the model's vermilion or
    /// amber, ever lighter or darker on the way, so that the order is seen without colours too.
    pub fn level(&self, share: f32) -> Color32 {
        let ramp = &self.levels;
        let at = share.clamp(0.0, 1.0) * (ramp.len() - 1) as f32;
        let k = (at as usize).min(ramp.len() - 2);
        ramp[k].lerp_to_gamma(ramp[k + 1], at - k as f32)
    }

    /// Colour of an error from 0 (just above the noise) to 1 (largest), from a tint to the colour of what is missing.
    pub fn error_shade(&self, share: f32) -> Color32 {
        self.canvas.lerp_to_gamma(self.missing, 0.14 + 0.86 * share.clamp(0.0, 1.0))
    }

    /// Ink or canvas, whichever is easier to read on `ground`.
    pub fn text_on(&self, ground: Color32) -> Color32 {
        let luminance = |c: Color32| 0.299 * f32::from(c.r()) + 0.587 * f32::from(c.g()) + 0.114 * f32::from(c.b());
        let far = |c: Color32| (luminance(c) - luminance(ground)).abs();
        if far(self.ink) >= far(self.canvas) { self.ink } else { self.canvas }
    }
}

/// Thin line.
pub fn hair(colour: Color32) -> Stroke {
    Stroke::new(1.0, colour)
}

/// Line of symbols.
pub fn pen(colour: Color32) -> Stroke {
    Stroke::new(1.6, colour)
}

/// Line of the structure and of curves that matter.
pub fn bold(colour: Color32) -> Stroke {
    Stroke::new(2.4, colour)
}

#[cfg(test)]
mod tests {
    use super::{Color32, DARK, LIGHT, Palette};

    fn linear(c: u8) -> f64 {
        let c = f64::from(c) / 255.0;
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    }

    fn luminance(c: Color32) -> f64 {
        0.2126 * linear(c.r()) + 0.7152 * linear(c.g()) + 0.0722 * linear(c.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// Deuteranopia after Machado, Oliveira and Fernandes (2009), severity 1.
    fn deuteranopia(c: Color32) -> [f64; 3] {
        let [r, g, b] = [linear(c.r()), linear(c.g()), linear(c.b())];
        [0.367 * r + 0.861 * g - 0.228 * b, 0.280 * r + 0.673 * g + 0.047 * b, -0.012 * r + 0.043 * g + 0.969 * b]
    }

    #[test]
    fn text_reaches_the_contrast_that_the_accessibility_guidelines_ask_for() {
        for p in [&LIGHT, &DARK] {
            for text in [p.ink, p.weak, p.accent, p.warning, p.error, p.good] {
                assert!(contrast(text, p.pane) >= 4.5, "{text:?} on {:?}: {:.2}", p.pane, contrast(text, p.pane));
            }
            for data in [p.measured, p.model, p.missing] {
                assert!(contrast(data, p.canvas) >= 3.0, "{data:?}: {:.2}", contrast(data, p.canvas));
            }
        }
    }

    #[test]
    fn data_colours_stay_apart_for_an_eye_without_green() {
        for p in [&LIGHT, &DARK] {
            let seen = [p.measured, p.model, p.missing].map(deuteranopia);
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                let distance: f64 = (0..3).map(|k| (seen[i][k] - seen[j][k]).powi(2)).sum::<f64>().sqrt();
                assert!(distance > 0.12, "colours {i} and {j}: {distance:.3}");
            }
        }
    }

    #[test]
    fn levels_of_force_are_in_order_and_seen_on_the_canvas_without_colours_too() {
        for p in [&LIGHT, &DARK] {
            let colours: Vec<Color32> = (0..=6).map(|k| p.level(k as f32 / 6.0)).collect();
            assert!(colours.windows(2).all(|c| luminance(c[0]) < luminance(c[1])), "lightness rises with the level");
            assert!(colours.iter().all(|c| contrast(*c, p.canvas) >= 3.0), "every level is seen");
            let seen = colours.iter().step_by(2).map(|c| deuteranopia(*c)).collect::<Vec<_>>();
            for pair in seen.windows(2) {
                let distance: f64 = (0..3).map(|k| (pair[0][k] - pair[1][k]).powi(2)).sum::<f64>().sqrt();
                assert!(distance > 0.08, "{distance:.3}");
            }
        }
    }

    #[test]
    fn numbers_on_a_heat_map_can_be_read() {
        for p in [&LIGHT, &DARK] {
            let shades = (0..=10).map(|step| p.error_shade(step as f32 / 10.0));
            for ground in (-10..=10).map(|step| p.diverging(step as f32 / 10.0)).chain(shades) {
                assert!(contrast(Palette::text_on(p, ground), ground) >= 3.0, "{ground:?}");
            }
        }
    }
}
