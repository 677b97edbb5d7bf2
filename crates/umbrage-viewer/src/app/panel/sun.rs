//! Controls of the sun.

use egui::{DragValue, Slider, Ui};

use crate::session::Session;
use crate::sun::{Almanac, SkyPoint, Sun};

/// Lays out the controls of the sun.
pub(super) fn sun(session: &mut Session, ui: &mut Ui) {
    let Some(shown) = session.shown_sun() else {
        ui.weak("The first light of this scene is a lamp.");
        return;
    };
    let point = SkyPoint::of_travel(shown.direction());
    ui.horizontal_wrapped(|ui| {
        let own = session.sun == Sun::OfScene;
        if ui
            .selectable_label(own, "the scene's")
            .on_hover_text("The sun that the scene or the command line has")
            .clicked()
        {
            session.sun = Sun::OfScene;
        }
        let by_hand = matches!(session.sun, Sun::ByHand(_));
        if ui.selectable_label(by_hand, "by hand").on_hover_text("Or drag the picture with Ctrl held").clicked()
            && !by_hand
        {
            session.sun = Sun::ByHand(point);
        }
        let by_date = matches!(session.sun, Sun::ByDate(_));
        if ui.selectable_label(by_date, "by date and place").clicked() && !by_date {
            session.sun = Sun::ByDate(Almanac::default());
        }
    });
    match &mut session.sun {
        Sun::OfScene => {
            ui.weak(format!("{:.1}° high, from {:.0}° ({})", point.elevation, point.bearing, compass(point.bearing)));
        }
        Sun::ByHand(point) => {
            ui.add(Slider::new(&mut point.elevation, 0.5..=90.0).suffix("°").text("height"));
            ui.add(Slider::new(&mut point.bearing, 0.0..=360.0).suffix("°").text("bearing"))
                .on_hover_text("From north (−Z) over east (+X)");
        }
        Sun::ByDate(almanac) => by_date(almanac, point, ui),
    }
    if let Err(why) = session.sun.light() {
        ui.colored_label(ui.visuals().warn_fg_color, why);
    }
}

fn by_date(almanac: &mut Almanac, point: SkyPoint, ui: &mut Ui) {
    ui.horizontal(|ui| {
        let (year, month, day) = &mut almanac.date;
        ui.add(DragValue::new(year).range(-1999..=5999).prefix("year "));
        ui.add(DragValue::new(month).range(1..=12).prefix("month "));
        ui.add(DragValue::new(day).range(1..=31).prefix("day "));
    });
    ui.add(Slider::new(&mut almanac.hour, 0.0..=23.99).text("hour, UTC").fixed_decimals(2));
    ui.add(Slider::new(&mut almanac.latitude, -90.0..=90.0).suffix("°").text("north"));
    ui.add(Slider::new(&mut almanac.longitude, -180.0..=180.0).suffix("°").text("east"));
    ui.weak(format!("{:.1}° high, from {:.0}° ({})", point.elevation, point.bearing, compass(point.bearing)));
}

/// Returns the nearest of eight compass points.
fn compass(bearing: f64) -> &'static str {
    const WINDS: [&str; 8] = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a bearing of 0 to 360")]
    let wind = (bearing.rem_euclid(360.0) / 45.0).round() as usize;
    WINDS[wind % 8]
}

#[cfg(test)]
mod tests {
    #[test]
    fn bearings_are_winds() {
        for (bearing, wind) in [(0.0, "north"), (100.0, "east"), (202.0, "south"), (359.0, "north"), (-90.0, "west")] {
            assert_eq!(super::compass(bearing), wind);
        }
    }
}
