//! Less motion: whether the desktop asks programs to leave out animations, and what that means here.

use egui::Context;
use std::path::Path;

/// Files in which desktops keep that setting, below the user's folder, with the line that says it.
const SETTINGS: [(&str, &str, [&str; 2]); 3] = [
    (".config/gtk-4.0/settings.ini", "gtk-enable-animations", ["0", "false"]),
    (".config/gtk-3.0/settings.ini", "gtk-enable-animations", ["0", "false"]),
    (".config/kdeglobals", "AnimationDurationFactor", ["0", "0.0"]),
];

/// How long widgets take to change their looks, s.
const TIME: f32 = 0.08;

/// Whether the desktop of the user asks for less motion, so far as it says so in a file.
pub(crate) fn is_unwanted() -> bool {
    std::env::home_dir().is_some_and(|home| is_unwanted_below(&home))
}

fn is_unwanted_below(home: &Path) -> bool {
    SETTINGS.iter().any(|(file, key, values)| {
        let text = std::fs::read_to_string(home.join(file)).unwrap_or_default();
        let said =
            |line: &str| line.split_once('=').filter(|(k, _)| k.trim() == *key).map(|(_, v)| v.trim().to_owned());
        text.lines().filter_map(said).next_back().is_some_and(|value| values.contains(&value.as_str()))
    })
}

/// Widgets and scrolling change at once, or within a blink.
pub(crate) fn set_less(ctx: &Context, less: bool) {
    ctx.all_styles_mut(|style| {
        style.animation_time = if less { 0.0 } else { TIME };
        style.scroll_animation =
            if less { egui::style::ScrollAnimation::none() } else { egui::style::ScrollAnimation::default() };
    });
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests")]
    use super::is_unwanted_below;

    #[test]
    fn what_a_desktop_asks_for_is_read_from_its_files() {
        let home = tempfile::tempdir().unwrap();
        assert!(!is_unwanted_below(home.path()), "no file, no setting");
        let write = |file: &str, text: &str| {
            let path = home.path().join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        write(".config/gtk-4.0/settings.ini", "[Settings]\ngtk-enable-animations=true\n");
        write(".config/kdeglobals", "[KDE]\nAnimationDurationFactor=0.5\n");
        assert!(!is_unwanted_below(home.path()));
        write(".config/kdeglobals", "[KDE]\nAnimationDurationFactor=0\n");
        assert!(is_unwanted_below(home.path()));
        write(".config/kdeglobals", "");
        write(".config/gtk-4.0/settings.ini", "[Settings]\n gtk-enable-animations = false\n");
        assert!(is_unwanted_below(home.path()));
    }

    #[test]
    fn with_less_motion_nothing_takes_time() {
        let ctx = egui::Context::default();
        super::set_less(&ctx, true);
        assert_eq!(ctx.global_style().animation_time, 0.0);
        super::set_less(&ctx, false);
        assert!(ctx.global_style().animation_time > 0.0);
    }
}
