//! The ground as a texture: what was drawn for another tick is kept where nothing changed.

use egui::{Color32, ColorImage, TextureHandle, TextureOptions, Ui};
use planner_core::Cell;

use super::marks::robot_color;
use super::place::Place;
use super::{Frame, View};
use crate::colors::{Colors, mix};
use crate::ground::{self, Layers, Subject};
use crate::playback::Playback;

/// What a texture shows.
#[derive(Clone, PartialEq)]
pub(super) struct Key {
    run: usize,
    shown: u32,
    has_state: bool,
    subject: Subject,
    layers: Layers,
    colors: Colors,
    /// Whose way is not dim, if the texture shows ways.
    ways: Option<Option<usize>>,
}

/// Side of the squares, in cells, in which a texture is renewed.
const PATCH: usize = 32;

impl View {
    pub(super) fn paint_ground(
        &mut self,
        ui: &Ui,
        frame: &Frame<'_>,
        place: &Place,
        colors: &Colors,
    ) {
        let &Frame {
            watch,
            subject,
            layers,
            ..
        } = frame;
        let key = Key {
            run: frame.run,
            shown: watch.shown(),
            has_state: watch.state().is_some(),
            subject,
            layers: *layers,
            colors: *colors,
            ways: place.is_coarse().then_some(frame.selected),
        };
        if self.key.as_ref() == Some(&key) {
            return;
        }
        let kept = self.key.as_ref().filter(|old| {
            let then = Key {
                shown: old.shown,
                has_state: old.has_state,
                ways: old.ways,
                ..key.clone()
            };
            **old == then
        });
        let is_renewed = kept.is_some_and(|old| {
            ground::update(&mut self.ground, old.shown, watch, subject, layers, colors)
        });
        if !is_renewed {
            self.ground = ground::image(watch, subject, layers, colors);
        }
        self.pixels.swap(0, 1);
        let [pixels, old] = &mut self.pixels;
        pixels.size = self.ground.size;
        pixels.pixels.clone_from(&self.ground.pixels);
        if place.is_coarse() {
            draw_ways(pixels, frame, colors);
        }
        match &mut self.texture {
            Some(texture) if old.size == pixels.size => renew(texture, old, pixels),
            Some(texture) => texture.set(pixels.clone(), TextureOptions::NEAREST),
            None => {
                let image = pixels.clone();
                let context = ui.ctx();
                self.texture = Some(context.load_texture("ground", image, TextureOptions::NEAREST));
            }
        }
        self.key = Some(key);
    }
}

/// Brings to the graphics card what differs.
fn renew(texture: &mut TextureHandle, old: &ColorImage, new: &ColorImage) {
    let [width, height] = new.size;
    for top in (0..height).step_by(PATCH) {
        for left in (0..width).step_by(PATCH) {
            let (right, bottom) = ((left + PATCH).min(width), (top + PATCH).min(height));
            let rows = || (top..bottom).map(|y| y * width + left..y * width + right);
            if rows().any(|row| old.pixels[row.clone()] != new.pixels[row]) {
                let pixels = rows().flat_map(|row| &new.pixels[row]).copied().collect();
                let patch = ColorImage::new([right - left, bottom - top], pixels);
                texture.set_partial([left, top], patch, TextureOptions::NEAREST);
            }
        }
    }
}

/// Ways and plans as pixels, those of the selected robot over all others.
fn draw_ways(image: &mut ColorImage, frame: &Frame<'_>, colors: &Colors) {
    let watch = frame.watch;
    let extent = watch.scenario().world.extent();
    // Fainter than the robots.
    let faint = |robot| mix(colors.free, robot_color(frame, colors, robot), 0.65);
    let faint: Vec<Color32> = (0..watch.scenario().starts.len()).map(faint).collect();
    let mut dot = |cell: Cell, robot: usize| {
        if extent.contains(cell) {
            let index = cell.y as usize * image.size[0] + cell.x as usize;
            image.pixels[index] = faint.get(robot).copied().unwrap_or(colors.ink);
        }
    };
    let is_selected = |robot: usize| frame.selected == Some(robot);
    if frame.subject == Subject::World {
        let records = match frame.layers.trail {
            0 => &[],
            trail => ground::trail_records(watch, trail),
        };
        for on_top in [false, true] {
            for record in records {
                let robot = usize::from(record.robot);
                if is_selected(robot) == on_top {
                    dot(record.at, robot);
                }
            }
        }
    } else if let (true, Some(state)) = (frame.layers.plans, watch.state()) {
        let positions = watch.positions();
        for on_top in [false, true] {
            for record in watch.last_records() {
                let robot = usize::from(record.robot);
                if let (Some(&at), true) = (positions.get(robot), is_selected(robot) == on_top) {
                    let mut cell = at;
                    for step in state.way(robot) {
                        cell = cell.step(step);
                        dot(cell, robot);
                    }
                }
            }
        }
    }
}
