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

const LIGHT: Palette = palette(0);
const DARK: Palette = palette(1);

/// The colours on a light (0) or a dark (1) ground, each beside the other.
const fn palette(ground: usize) -> Palette {
    Palette {
        measured: rgb([0x00_66_A6, 0x56_B4_E9][ground]),
        model: rgb([0xD5_5E_00, 0xF0_9A_3E][ground]),
        missing: rgb([0xA8_4A_86, 0xE0_8F_C0][ground]),
        accent: rgb([0x0B_72_6E, 0x4F_C4_BB][ground]),
        accent_faint: rgb([0xDC_EF_ED, 0x1B_3B_3A][ground]),
        ink: rgb([0x17_1D_24, 0xE6_E9_ED][ground]),
        weak: rgb([0x56_61_6D, 0x9D_A8_B4][ground]),
        line: rgb([0xD6_DB_E1, 0x33_3A_42][ground]),
        grid: rgb([0xC2_C9_D1, 0x4A_53_5D][ground]),
        desk: rgb([0xE9_EC_EF, 0x0E_10_13][ground]),
        pane: rgb([0xFA_FB_FC, 0x1A_1E_23][ground]),
        canvas: rgb([0xFF_FF_FF, 0x14_17_1B][ground]),
        raised: rgb([0xEF_F2_F5, 0x26_2C_33][ground]),
        good: rgb([0x1B_7F_4B, 0x5C_C8_8F][ground]),
        warning: rgb([0x9A_62_00, 0xE8_B3_4B][ground]),
        error: rgb([0xB3_26_1E, 0xF2_8B_82][ground]),
        levels: levels(ground),
    }
}

/// Levels of force from lowest to highest.
const fn levels(ground: usize) -> [Color32; 4] {
    [
        rgb([0x44_17_61, 0x8C_6B_D6][ground]),
        rgb([0x2A_6A_96, 0x4A_9B_D4][ground]),
        rgb([0x1F_8F_6E, 0x4F_C4_8B][ground]),
        rgb([0xB8_8A_00, 0xF5_D7_42][ground]),
    ]
}

/// A colour of its red, green and blue bytes.
const fn rgb(hex: u32) -> Color32 {
    let [_, red, green, blue] = hex.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

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

    /// Rows that make of a colour what an eye without one kind of cones sees.
    type Eye = [[f64; 3]; 3];

    /// Eyes without red, green and blue cones after Machado, Oliveira and Fernandes (2009), severity 1.
    const EYES: [(&str, Eye); 3] = [
        ("red", [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]]),
        ("green", [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]]),
        ("blue", [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]]),
    ];

    fn seen(c: Color32, eye: &Eye) -> [f64; 3] {
        let lights = [linear(c.r()), linear(c.g()), linear(c.b())];
        eye.map(|row| (0..3).map(|k| row[k] * lights[k]).sum())
    }

    fn distance(a: Color32, b: Color32, eye: &Eye) -> f64 {
        let (a, b) = (seen(a, eye), seen(b, eye));
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn what_an_eye_sees_of_white_is_white() {
        for (cones, eye) in EYES {
            let off = seen(Color32::WHITE, &eye).map(|v| (v - 1.0).abs());
            assert!(off.iter().all(|d| *d < 2e-3), "{cones}: {off:?}");
        }
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
    fn data_colours_stay_apart_for_every_eye() {
        for (cones, eye) in EYES {
            for p in [&LIGHT, &DARK] {
                for (a, b) in [(p.measured, p.model), (p.measured, p.missing), (p.model, p.missing)] {
                    // A dark and a light colour are told apart whatever their hue; two of one lightness by their distance.
                    let apart = distance(a, b, &eye);
                    assert!(apart > 0.10, "without {cones}: {a:?} and {b:?}: {apart:.3}");
                }
                assert!(distance(p.good, p.error, &eye) > 0.06, "without {cones}: good and error");
            }
        }
    }

    #[test]
    fn levels_of_force_are_in_order_and_seen_on_the_canvas_without_colours_too() {
        for p in [&LIGHT, &DARK] {
            let colours: Vec<Color32> = (0..=6).map(|k| p.level(k as f32 / 6.0)).collect();
            assert!(colours.windows(2).all(|c| luminance(c[0]) < luminance(c[1])), "lightness rises with the level");
            assert!(colours.iter().all(|c| contrast(*c, p.canvas) >= 3.0), "every level is seen");
            for pair in colours.chunks(2).map(|c| c[0]).collect::<Vec<_>>().windows(2) {
                for (cones, eye) in EYES {
                    let apart = distance(pair[0], pair[1], &eye);
                    assert!(apart > 0.07, "without {cones}: {apart:.3}");
                }
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
