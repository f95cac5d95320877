//! Parts of the menus of all worlds.

use std::ops::RangeInclusive;

use clap::ValueEnum;
use egui::emath::Numeric;
use egui::{ComboBox, DragValue, RichText, Slider, SliderClamping, TextEdit, Ui};
use host_sim::scenario::{Conditions, Faults, MediumKind};

use crate::platform::{Inbox, choose_file};

/// The head of a part of the menus.
pub(super) fn title(ui: &mut Ui, text: &str) {
    ui.add_space(6.0);
    ui.label(RichText::new(text).strong());
}

/// A number behind its name.
pub(super) fn number(ui: &mut Ui, name: &str, value: DragValue<'_>) {
    let label = ui.label(name);
    ui.add(value).labelled_by(label.id);
}

/// A number that the user keeps within a range; one that comes otherwise stays.
pub(super) fn slider<T: Numeric>(ui: &mut Ui, name: &str, value: &mut T, range: RangeInclusive<T>) {
    let slider = Slider::new(value, range).clamping(SliderClamping::Edits);
    ui.add(slider.text(name));
}

/// A share from 0 to 1, of which small ones matter.
pub(super) fn share(ui: &mut Ui, name: &str, value: &mut f64) {
    let slider = Slider::new(value, 0.0..=1.0).logarithmic(true);
    let slider = slider.smallest_positive(0.001).max_decimals(3);
    ui.add(slider.text(name));
}

/// One of several.
pub(super) fn choice<T: ValueEnum + PartialEq + Copy + ToString>(
    ui: &mut Ui,
    name: &str,
    value: &mut T,
    all: &[T],
) {
    ComboBox::from_label(name)
        .selected_text(value.to_string())
        .show_ui(ui, |ui| {
            for &other in all {
                ui.selectable_value(value, other, other.to_string());
            }
        });
}

/// What is run beside the first, if anything is.
pub(super) fn rival<T: PartialEq + Copy + ToString>(ui: &mut Ui, rival: &mut Option<T>, all: &[T]) {
    let name = rival.map_or("nothing".to_owned(), |rival| rival.to_string());
    ComboBox::from_label("compare with")
        .selected_text(name)
        .show_ui(ui, |ui| {
            ui.selectable_value(rival, None, "nothing");
            for &other in all {
                ui.selectable_value(rival, Some(other), other.to_string());
            }
        });
}

/// A way in for maps and traces.
pub(super) fn files(ui: &mut Ui, inbox: &Inbox, path: &mut String) {
    ui.horizontal(|ui| {
        if cfg!(target_arch = "wasm32") {
            if ui.button("Open a file …").clicked() {
                choose_file("", inbox, ui.ctx());
            }
        } else {
            let edit = TextEdit::singleline(path).hint_text("path of a map or trace");
            let entered = ui.add(edit.desired_width(150.0)).lost_focus()
                && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if ui.button("Open").clicked() || entered {
                choose_file(path, inbox, ui.ctx());
            }
        }
    });
    ui.label(RichText::new("or drop a map or a trace here").weak());
}

/// What carries messages, and how many are lost.
pub(super) fn medium(ui: &mut Ui, conditions: &mut Conditions) {
    let was_radio = conditions.medium == MediumKind::Radio;
    let all = MediumKind::value_variants();
    choice(ui, "medium", &mut conditions.medium, all);
    if was_radio && conditions.medium == MediumKind::Ideal {
        *conditions = conditions.clone().without_frames();
    }
    let loss = Slider::new(&mut conditions.loss, 0.0..=1.0);
    ui.add(loss.max_decimals(2).text("loss"));
}

/// What befalls robots on their way: counted, and taken back.
pub(super) fn events(ui: &mut Ui, faults: &mut Faults) {
    if !faults.deaths.is_empty() || !faults.arrivals.is_empty() {
        let (deaths, arrivals) = (faults.deaths.len(), faults.arrivals.len());
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("{deaths} killed, {arrivals} added on the way"));
            if ui.button("Revive").clicked() {
                faults.deaths.clear();
                faults.arrivals.clear();
            }
        });
    }
    let others = Faults {
        deaths: Vec::new(),
        arrivals: Vec::new(),
        ..faults.clone()
    };
    if others != Faults::default() {
        ui.horizontal_wrapped(|ui| {
            ui.label(in_words(&others));
            if ui.button("Without them").clicked() {
                *faults = Faults {
                    deaths: std::mem::take(&mut faults.deaths),
                    arrivals: std::mem::take(&mut faults.arrivals),
                    ..Faults::default()
                };
            }
        });
    }
}

/// The faults that no button sets, as many as there are of each kind.
fn in_words(faults: &Faults) -> String {
    let counts = [
        (faults.restarts.len(), "restarted"),
        (faults.resumes.len(), "told to go on"),
        (faults.closures.len(), "cells closed"),
        (faults.shut.len(), "cells shut"),
        (faults.blind.len(), "cells that no look shows"),
        (faults.sensor_failures.len(), "sensors fail"),
        (faults.lost_poses.len(), "poses lost"),
    ];
    let some = counts.iter().filter(|(count, _)| *count > 0);
    let words: Vec<String> = some.map(|(count, of)| format!("{count} {of}")).collect();
    words.join(", ")
}
