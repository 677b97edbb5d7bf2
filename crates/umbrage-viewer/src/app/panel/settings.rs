//! The right side: all settings of shadows.

use egui::{CollapsingHeader, ComboBox, DragValue, Panel, RichText, ScrollArea, Slider, TextEdit, Ui};
use umbrage::ShadowConfig;
use umbrage::config::{Kind, LightKind, Preset, Value, Word};

use super::side;
use crate::app::App;
use crate::controls::{OTHERS, Row, SECTIONS, Verdict, changes, choose, rows, section, verdict};
use crate::share::Spelled;

/// Lays out the right side.
pub fn settings(app: &mut App, ui: &mut Ui) {
    side(Panel::right("settings"), 320.0, ui).show(ui, |ui| {
        ui.heading("Shadows");
        presets(app, ui);
        carry(app, ui);
        ui.add(TextEdit::singleline(&mut app.fields.search).hint_text("find a setting").desired_width(f32::INFINITY));
        ui.separator();
        ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            for note in &app.fields.gave_way {
                ui.colored_label(ui.visuals().warn_fg_color, note);
            }
            sections(app, ui);
        });
    });
}

fn presets(app: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        for word in Preset::WORDS {
            let Some(preset) = Preset::ALL.iter().find(|preset| preset.word() == word.word) else { continue };
            let config = preset.config();
            if ui.selectable_label(app.session.config == config, word.word).on_hover_text(word.help).clicked() {
                take(app, config, Vec::new());
            }
        }
    });
}

/// Replaces the config by one that the user made.
fn take(app: &mut App, config: ShadowConfig, gave_way: Vec<String>) {
    let (config, more) = config.for_lights(&app.session.light_kinds());
    app.fields.gave_way = gave_way.into_iter().chain(more).collect();
    app.fields.typed.clear();
    app.session.set_config(config);
}

/// Lays out the buttons that copy and paste a config.
fn carry(app: &mut App, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.menu_button("copy", |ui| {
            let spelled = Spelled::of(&app.session.config);
            let link = app.link().map(|link| ("as a link that shows this", link));
            let texts = [
                ("as Rust", spelled.rust()),
                ("as a file for --config (TOML)", spelled.toml()),
                ("as options", spelled.command_line()),
                ("as the command that shows this", app.command_line()),
            ];
            for (name, text) in texts.into_iter().chain(link) {
                if ui.button(name).on_hover_text(&text).clicked() {
                    ui.ctx().copy_text(text);
                    ui.close();
                }
            }
        });
        ui.menu_button("paste", |ui| {
            ui.label("Rust, TOML, JSON or a command line (Ctrl + V over the picture does it at once):");
            ui.add(TextEdit::multiline(&mut app.fields.pasted).code_editor().desired_rows(4));
            if ui.button("apply").clicked() {
                let text = std::mem::take(&mut app.fields.pasted);
                app.paste(&text);
                ui.close();
            }
        });
        let usual = ShadowConfig::default();
        let reset = ui.add_enabled(app.session.config != usual, egui::Button::new("reset"));
        if reset.on_hover_text("All settings to their defaults: the preset balanced").clicked() {
            take(app, usual, Vec::new());
        }
    });
}

fn sections(app: &mut App, ui: &mut Ui) {
    let rows = rows(&app.session.config);
    let search = app.fields.search.trim().to_lowercase();
    let matches = |row: &&Row| {
        search.is_empty() || row.setting.key.contains(&search) || row.setting.help.to_lowercase().contains(&search)
    };
    for (index, heading) in SECTIONS.iter().map(|(heading, _)| *heading).chain([OTHERS]).enumerate() {
        let below: Vec<&Row> = rows.iter().filter(|row| section(row.setting.key) == heading).filter(matches).collect();
        if below.is_empty() {
            continue;
        }
        let changed = below.iter().filter(|row| row.value != row.default).count();
        let title = if changed > 0 { format!("{heading} ({changed} changed)") } else { heading.to_owned() };
        let header = CollapsingHeader::new(title).id_salt(heading).default_open(index < 2);
        let header = if search.is_empty() { header } else { header.open(Some(true)) };
        header.show(ui, |ui| {
            for row in below {
                ui.push_id(row.setting.key, |ui| setting(app, row, ui));
            }
        });
    }
}

/// Text of a choice that was made.
type Choice = Option<String>;

/// Lays out one setting: its name, its control, and its line of help.
fn setting(app: &mut App, row: &Row, ui: &mut Ui) {
    let kinds = app.session.light_kinds();
    let config = app.session.config.clone();
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        let key = RichText::new(row.setting.key);
        let key = if row.value == row.default { key } else { key.strong() };
        ui.label(key).on_hover_text(hover(row));
        match &row.value {
            Some(value) => chosen = control(app, row, value, (&config, &kinds), ui),
            None => chosen = unused(row, (&config, &kinds), ui),
        }
        if row.value.is_some() && row.value != row.default {
            let back = row.default.as_ref().map(ToString::to_string);
            let text = back
                .as_ref()
                .map_or_else(|| "the default has no such setting".to_owned(), |back| format!("back to {back}"));
            if ui.add_enabled(back.is_some(), egui::Button::new("back").small()).on_hover_text(text).clicked() {
                chosen = back;
            }
        }
    });
    ui.small(RichText::new(row.setting.help).weak());
    if let Some((_, Some(why))) = app.fields.typed.get(row.setting.key) {
        ui.colored_label(ui.visuals().error_fg_color, why);
    }
    ui.add_space(3.0);
    let Some(value) = chosen else { return };
    match choose(&config, &kinds, row.setting, &value) {
        Ok((config, gave_way)) => {
            app.fields.typed.remove(row.setting.key);
            app.fields.gave_way = gave_way;
            app.session.set_config(config);
        }
        Err(why) => {
            app.fields.typed.insert(row.setting.key, (value, Some(why)));
        }
    }
}

fn hover(row: &Row) -> String {
    let default =
        row.default.as_ref().map_or_else(|| "not in the default".to_owned(), |value| format!("default {value}"));
    let unit = match row.unit() {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    format!(
        "{}\n{default}{unit}; a change {}\n--{} {}",
        row.setting.help,
        row.cost(),
        row.setting.key,
        row.setting.kind.placeholder()
    )
}

/// Lays out a setting that the other choices exclude: the reason, or a button that makes room.
fn unused(row: &Row, (config, kinds): (&ShadowConfig, &[LightKind]), ui: &mut Ui) -> Choice {
    let value = row.stand_in();
    match choose(config, kinds, row.setting, &value) {
        Ok((after, _)) => {
            let what = changes(config, &after).join(", ");
            ui.small_button("use")
                .on_hover_text(format!("not used now; this chooses {what}"))
                .clicked()
                .then_some(value)
        }
        Err(why) => {
            ui.add_enabled(false, egui::Button::new("not used").small()).on_disabled_hover_text(why);
            None
        }
    }
}

/// Lays out the control of a setting that has a value.
fn control(app: &mut App, row: &Row, value: &Value, state: (&ShadowConfig, &[LightKind]), ui: &mut Ui) -> Choice {
    match (row.setting.kind, value) {
        (Kind::Words(words), Value::Word(word)) => one_word(row, words, word, state, ui),
        (Kind::WordList(words), Value::Word(chosen)) => word_for_each(row, words, chosen, state, ui),
        (Kind::Share(most), Value::Number(number)) => {
            let mut number = *number;
            ui.add(Slider::new(&mut number, 0.0..=most).max_decimals(3)).changed().then(|| number.to_string())
        }
        (Kind::Degrees(most), Value::Number(number)) => {
            let mut number = *number;
            let slider = Slider::new(&mut number, 0.0..=most).suffix("°").max_decimals(3);
            ui.add(slider.logarithmic(true).smallest_positive(0.01)).changed().then(|| number.to_string())
        }
        (Kind::Metres, Value::Number(number)) => {
            let mut number = *number;
            let drag = DragValue::new(&mut number).range(1e-4..=f64::MAX).speed(0.01).suffix(" m").max_decimals(4);
            ui.add(drag).changed().then(|| number.to_string())
        }
        (Kind::Count(least, most), Value::Count(count)) => {
            let mut count = *count;
            ui.add(Slider::new(&mut count, least..=most)).changed().then(|| count.to_string())
        }
        (Kind::CountOf(counts), Value::Count(count)) => {
            let mut chosen = *count;
            ui.horizontal(|ui| {
                for &count in counts {
                    ui.selectable_value(&mut chosen, count, count.to_string());
                }
            });
            (chosen != *count).then(|| chosen.to_string())
        }
        (Kind::Switch, Value::Switch(on)) => {
            let mut on = *on;
            ui.checkbox(&mut on, "").changed().then(|| Value::Switch(on).to_string())
        }
        (Kind::Colour, Value::Numbers(numbers)) => colour(numbers, ui),
        (Kind::Texels, Value::Counts(sizes)) => texels(app, row, sizes, ui),
        (_, value) => typed(app, row, value, ui),
    }
}

/// Lays out words in a list. Words that a rule excludes are grey and show the reason.
fn one_word(
    row: &Row,
    words: &'static [Word],
    chosen: &str,
    (config, kinds): (&ShadowConfig, &[LightKind]),
    ui: &mut Ui,
) -> Choice {
    let mut choice = None;
    ComboBox::from_id_salt(row.setting.key).selected_text(chosen).show_ui(ui, |ui| {
        for word in words {
            choice = choice.take().or_else(|| one_choice(row, word, (config, kinds), ui));
        }
    });
    choice
}

fn one_choice(row: &Row, word: &Word, (config, kinds): (&ShadowConfig, &[LightKind]), ui: &mut Ui) -> Choice {
    let made = || Some(word.word.to_owned());
    match verdict(config, kinds, row.setting, word.word) {
        Verdict::Chosen => {
            ui.selectable_label(true, word.word).on_hover_text(word.help);
            None
        }
        Verdict::Free => ui.selectable_label(false, word.word).on_hover_text(word.help).clicked().then(made).flatten(),
        Verdict::Excluded(why) => {
            let why = why.join("\n");
            ui.horizontal(|ui| {
                ui.add_enabled(false, egui::Button::selectable(false, word.word))
                    .on_disabled_hover_text(format!("{}\n{why}", word.help));
                let all_the_same = ui.small_button("make room").on_hover_text(&why);
                all_the_same.clicked().then(made).flatten()
            })
            .inner
        }
        Verdict::Impossible(why) => {
            ui.add_enabled(false, egui::Button::selectable(false, word.word))
                .on_disabled_hover_text(format!("{}\n{why}", word.help));
            None
        }
    }
}

/// Lays out a word for each split.
fn word_for_each(
    row: &Row,
    words: &'static [Word],
    chosen: &str,
    (config, kinds): (&ShadowConfig, &[LightKind]),
    ui: &mut Ui,
) -> Choice {
    let listed: Vec<&str> = chosen.split(',').collect();
    let of = |split: usize| listed.get(split).or(listed.first()).copied().unwrap_or_default();
    let mut now: Vec<&str> = (0..config.splits()).map(of).collect();
    let before = now.clone();
    for (split, value) in now.iter_mut().enumerate() {
        ComboBox::from_id_salt((row.setting.key, split)).selected_text(*value).width(64.0).show_ui(ui, |ui| {
            for word in words {
                let all = vec![word.word; config.splits()].join(",");
                let made = verdict(config, kinds, row.setting, &all);
                let can = matches!(made, Verdict::Chosen | Verdict::Free);
                let label = ui.add_enabled(can, egui::Button::selectable(*value == word.word, word.word));
                let why = match made {
                    Verdict::Excluded(why) => why.join("\n"),
                    Verdict::Impossible(why) => why,
                    Verdict::Chosen | Verdict::Free => word.help.to_owned(),
                };
                if label.on_hover_text(word.help).on_disabled_hover_text(why).clicked() {
                    *value = word.word;
                }
            }
        });
    }
    (now != before).then(|| now.join(","))
}

fn colour(numbers: &[f64], ui: &mut Ui) -> Choice {
    let mut rgb = [0.0_f32; 3];
    for (channel, number) in rgb.iter_mut().zip(numbers) {
        *channel = *number as f32;
    }
    // Linear light in, linear light out.
    let changed = ui.color_edit_button_rgb(&mut rgb).changed();
    changed.then(|| rgb.map(|channel| channel.clamp(0.0, 1.0).to_string()).join(","))
}

/// Lays out sizes of maps: one for all from a list of powers of two, or typed.
fn texels(app: &mut App, row: &Row, sizes: &[u32], ui: &mut Ui) -> Choice {
    let same = sizes.windows(2).all(|pair| pair[0] == pair[1]);
    let mut choice = None;
    let text = if same { sizes.first().map_or(String::new(), |size| format!("{size}²")) } else { "own".to_owned() };
    ComboBox::from_id_salt(row.setting.key).selected_text(text).width(70.0).show_ui(ui, |ui| {
        for power in 7..=12 {
            let size = 1_u32 << power;
            if ui.selectable_label(same && sizes.first() == Some(&size), format!("{size}²")).clicked() {
                choice = Some(size.to_string());
            }
        }
    });
    let shown = if same { &sizes[..sizes.len().min(1)] } else { sizes };
    choice.or_else(|| typed(app, row, &Value::Counts(shown.to_vec()), ui))
}

/// Lays out a typed value, which takes effect when the field is left.
fn typed(app: &mut App, row: &Row, value: &Value, ui: &mut Ui) -> Choice {
    let entry = app.fields.typed.get(row.setting.key).cloned();
    let mut text = entry.map_or_else(|| value.to_string(), |(text, _)| text);
    let field = ui.add(TextEdit::singleline(&mut text).desired_width(130.0));
    ui.weak(row.unit());
    if field.changed() {
        let wrong = row.setting.kind.check(text.trim()).err();
        app.fields.typed.insert(row.setting.key, (text.clone(), wrong));
    }
    (field.lost_focus() && text.trim() != value.to_string()).then_some(text)
}
