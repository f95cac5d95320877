//! What is played, as the user looks at it: one run, or two beside each other.

use egui::{Align, Layout, RichText, Ui, Vec2, vec2};

use crate::app::App;
use crate::ground::Subject;
use crate::playback::Playback;
use crate::survey::SHAPE;
use crate::view::{Deed, Frame};

impl App {
    pub(super) fn views(&mut self, ui: &mut Ui, is_narrow: bool) {
        let deed = match self.survey().is_some() {
            true => self.survey_views(ui),
            false => self.map_views(ui, is_narrow),
        };
        if let Some(deed) = deed {
            self.apply(deed);
        }
    }

    /// One survey, or two.
    fn survey_views(&mut self, ui: &mut Ui) -> Option<Deed> {
        let is_pair = self.surveys.len() > 1;
        beside(ui, self.surveys.len(), SHAPE, |ui, index| {
            let survey = self.surveys.get(index)?;
            if is_pair {
                ui.label(RichText::new(standing(survey)).strong());
            }
            let layers = &self.survey_layers;
            survey.view(ui, &mut self.turn, layers, self.selected, self.tool)
        })
    }

    /// Known map and real world of one run, or the known maps of two.
    fn map_views(&mut self, ui: &mut Ui, is_narrow: bool) -> Option<Deed> {
        let known = self.selected.map_or(Subject::Team, Subject::Robot);
        let mut wanted = Vec::new();
        for index in 0..self.runs.len() {
            match self.runs.len() {
                1 if is_narrow && self.shows_world => wanted.push((index, Subject::World)),
                1 if is_narrow => wanted.push((index, known)),
                1 => wanted.extend([(index, known), (index, Subject::World)]),
                _ => wanted.push((
                    index,
                    if self.shows_world {
                        Subject::World
                    } else {
                        known
                    },
                )),
            }
        }
        if is_narrow || self.runs.len() > 1 {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.shows_world, false, "known map");
                ui.selectable_value(&mut self.shows_world, true, "real world");
            });
        }
        let run = self.runs.first();
        let shape = run.map_or(Vec2::splat(1.0), |run| {
            let extent = run.watch.scenario().world.extent();
            vec2(extent.width.into(), extent.height.into())
        });
        beside(ui, wanted.len(), shape, |ui, place| {
            let (index, subject) = wanted[place];
            self.view(ui, index, subject)
        })
    }

    fn view(&mut self, ui: &mut Ui, index: usize, subject: Subject) -> Option<Deed> {
        let is_pair = self.runs.len() > 1;
        let run = self.runs.get_mut(index)?;
        let watch = &run.watch;
        let mut title = match subject {
            Subject::World => "Real world and ways".to_owned(),
            Subject::Team => "What the robots have seen".to_owned(),
            Subject::Robot(robot) if watch.state().is_some() => format!("What robot {robot} knows"),
            Subject::Robot(_) if watch.differs().is_some() => "What the robots have seen".into(),
            Subject::Robot(robot) => format!("Working out what robot {robot} knew …"),
        };
        if is_pair {
            title = standing(watch);
        }
        ui.label(RichText::new(title).strong());
        let second = usize::from(subject == Subject::World);
        let [one, two] = &mut run.views;
        let view = if second == 1 { two } else { one };
        view.show(
            ui,
            &mut self.camera,
            &Frame {
                watch,
                run: run.id,
                subject,
                layers: &self.layers,
                selected: self.selected,
                tool: self.tool,
            },
        )
    }
}

/// What decides in a run, and how it stands.
fn standing(player: &dyn Playback) -> String {
    let (title, seen) = (player.title(), player.seen_percent());
    format!("{title}: {seen:.1} %, tick {}", player.shown())
}

/// So many views of this shape beside each other or one above the other, as they get
/// larger; what the pointer did in the last of them, or else before.
fn beside(
    ui: &mut Ui,
    count: usize,
    shape: Vec2,
    mut view: impl FnMut(&mut Ui, usize) -> Option<Deed>,
) -> Option<Deed> {
    let (of, room, gap) = (count as f32, ui.available_size(), ui.spacing().item_spacing);
    let side = |room: Vec2| (room.x / shape.x).min((room.y - 20.0) / shape.y);
    let stacked = side(vec2(room.x, room.y / of)) > side(vec2(room.x / of, room.y));
    let size = match stacked {
        true => vec2(room.x, (room.y - gap.y * (of - 1.0)) / of),
        false => vec2((room.x - gap.x * (of - 1.0)) / of, room.y),
    };
    let layout = match stacked {
        true => Layout::top_down(Align::Min),
        false => Layout::left_to_right(Align::Min),
    };
    let mut deed = None;
    ui.with_layout(layout, |ui| {
        for index in 0..count {
            let inner = Layout::top_down(Align::Min);
            ui.allocate_ui_with_layout(size, inner, |ui| {
                deed = view(ui, index).or(deed.take());
            });
        }
    });
    deed
}
