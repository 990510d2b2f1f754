//! What all panels look like: sizes, distances and colours, light and dark.

use bevy_egui::egui::{Color32, Context, CornerRadius, FontId, Stroke, Style, TextStyle, Theme, Visuals, vec2};

/// Height of a row, points.
pub const ROW: f32 = 24.0;
/// Between a panel's edge and what is in it, points.
pub const MARGIN: i8 = 10;
/// Width of the panel with the fields, points.
pub const PANEL_WIDTH: f32 = 400.0;
/// Where the controls begin, from the left edge of the panel's inside, points.
pub const LABEL_WIDTH: f32 = 160.0;

/// Colours that the visuals have no place for.
#[derive(Clone, Copy)]
pub struct Palette {
    pub good: Color32,
    pub bad: Color32,
    pub warning: Color32,
    /// Lines of plots: what is measured, in this order.
    pub lines: [Color32; 3],
    /// What is to be.
    pub target: Color32,
}

/// The colours of the theme in force. Lines are Okabe & Ito's (2008), which those tell apart who see few colours; darker in light.
pub fn palette(visuals: &Visuals) -> Palette {
    if visuals.dark_mode {
        Palette {
            good: Color32::from_rgb(122, 200, 130),
            bad: Color32::from_rgb(255, 128, 112),
            warning: Color32::from_rgb(240, 190, 90),
            lines: [Color32::from_rgb(86, 180, 233), Color32::from_rgb(230, 159, 0), Color32::from_rgb(60, 190, 145)],
            target: Color32::from_gray(200),
        }
    } else {
        Palette {
            good: Color32::from_rgb(28, 112, 52),
            bad: Color32::from_rgb(176, 32, 24),
            warning: Color32::from_rgb(140, 86, 0),
            lines: [Color32::from_rgb(0, 98, 160), Color32::from_rgb(184, 92, 0), Color32::from_rgb(0, 120, 86)],
            target: Color32::from_gray(60),
        }
    }
}

/// Gives a context the style of both themes.
pub fn apply(context: &Context) {
    context.style_mut_of(Theme::Dark, |style| {
        style.visuals = Visuals::dark();
        style.visuals.panel_fill = Color32::from_rgb(30, 33, 35);
        style.visuals.window_fill = Color32::from_rgb(37, 40, 43);
        style.visuals.override_text_color = Some(Color32::from_rgb(226, 229, 226));
        style.visuals.selection.bg_fill = Color32::from_rgb(52, 106, 68);
        style.visuals.selection.stroke = Stroke::new(1.0, Color32::WHITE);
        style.visuals.hyperlink_color = Color32::from_rgb(122, 200, 130);
        common(style);
    });
    context.style_mut_of(Theme::Light, |style| {
        style.visuals = Visuals::light();
        style.visuals.panel_fill = Color32::from_rgb(246, 247, 244);
        style.visuals.window_fill = Color32::from_rgb(252, 252, 250);
        style.visuals.override_text_color = Some(Color32::from_rgb(28, 32, 29));
        style.visuals.selection.bg_fill = Color32::from_rgb(178, 222, 188);
        style.visuals.selection.stroke = Stroke::new(1.0, Color32::from_rgb(16, 60, 28));
        style.visuals.hyperlink_color = Color32::from_rgb(28, 112, 52);
        common(style);
    });
}

fn common(style: &mut Style) {
    style.text_styles = [
        (TextStyle::Small, FontId::proportional(11.0)),
        (TextStyle::Body, FontId::proportional(13.5)),
        (TextStyle::Button, FontId::proportional(13.5)),
        (TextStyle::Heading, FontId::proportional(16.0)),
        (TextStyle::Monospace, FontId::monospace(12.5)),
    ]
    .into();
    style.spacing.item_spacing = vec2(8.0, 4.0);
    style.spacing.button_padding = vec2(9.0, 3.0);
    style.spacing.interact_size = vec2(24.0, ROW - 2.0);
    style.spacing.indent = 14.0;
    style.spacing.combo_width = 60.0;
    style.spacing.tooltip_width = 360.0;
    style.spacing.scroll.floating = false;
    style.spacing.scroll.bar_width = 8.0;
    style.visuals.weak_text_alpha = 0.72;
    style.visuals.slider_trailing_fill = true;
    style.visuals.indent_has_left_vline = false;
    for widget in [
        &mut style.visuals.widgets.inactive,
        &mut style.visuals.widgets.hovered,
        &mut style.visuals.widgets.active,
        &mut style.visuals.widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(4);
        widget.expansion = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance (WCAG 2.2).
    fn luminance(colour: Color32) -> f32 {
        let linear = bevy_egui::egui::Rgba::from(colour);
        0.2126 * linear.r() + 0.7152 * linear.g() + 0.0722 * linear.b()
    }

    fn contrast(a: Color32, b: Color32) -> f32 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// WCAG 2.2 asks 4.5 of text and 3 of lines.
    #[test]
    fn colours_read_in_light_and_dark() {
        let context = Context::default();
        apply(&context);
        for theme in [Theme::Dark, Theme::Light] {
            let visuals = context.style_of(theme).visuals.clone();
            let Palette { good, bad, warning, lines, target } = palette(&visuals);
            let text = [visuals.text_color(), visuals.weak_text_color(), good, bad, warning];
            for background in [visuals.panel_fill, visuals.window_fill] {
                for colour in text {
                    assert!(contrast(colour, background) > 4.5, "{theme:?}: {colour:?} on {background:?}");
                }
                for colour in lines.into_iter().chain([target]) {
                    assert!(contrast(colour, background) > 3.0, "{theme:?}: {colour:?} on {background:?}");
                }
            }
            assert!(contrast(visuals.selection.stroke.color, visuals.selection.bg_fill) > 4.5, "{theme:?}");
        }
    }
}
