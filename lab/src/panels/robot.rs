//! The robot that was clicked: its state, its last decisions, its cost.

use egui::{Grid, RichText, Ui};
use host_sim::robot::Deed;
use host_sim::sensor::ALL_AROUND;
use planner_core::Wait;

use crate::app::App;
use crate::decisions::{decisions, name};
use crate::playback::{Playback, Verdict};

/// Decisions that are shown.
const DECISIONS: usize = 12;

impl App {
    pub(super) fn robot(&mut self, ui: &mut Ui) {
        let Some(run) = self.runs.first() else { return };
        let watch = &run.watch;
        let robots = watch.scenario().starts.len();
        let mut chosen = self.selected;
        choose(ui, &mut chosen, "robot", robots);
        let Some(robot) = chosen.filter(|&robot| robot < robots) else {
            ui.label("Click a robot to see its map, its state and its decisions.");
            if let Some(differs) = watch.differs() {
                ui.label(format!(
                    "The planners of this program decide otherwise than this trace, first in tick {differs}."
                ));
            }
            let is_at_end = watch.shown() == watch.ticks() && !watch.is_replay();
            let is_over = is_at_end && watch.verdict() != Verdict::Running;
            if is_over && ui.button("Let all robots go on").clicked() {
                self.go_on(None);
            }
            self.selected = chosen;
            return;
        };
        let (mut kills, mut goes_on) = (false, false);
        let mut rows: Vec<(&str, String)> = Vec::new();
        let record = watch
            .last_records()
            .iter()
            .find(|it| usize::from(it.robot) == robot);
        if let Some(state) = watch.state() {
            let seen = state.robot(robot);
            let deed = match (seen.alive, seen.is_there, seen.step.map(|step| step.deed)) {
                (false, false, _) => "still to come".into(),
                (false, ..) => "dead".into(),
                (true, _, None) => "about to begin".into(),
                (true, _, Some(Deed::Waited)) => seen.waiting.map_or("waited".into(), reason),
                (true, _, Some(deed)) => words(deed),
            };
            rows.push(("state", deed));
            rows.push(("at", seen.position.to_string()));
            if watch.scenario().fov < ALL_AROUND {
                rows.push(("turned to the", name(seen.heading).into()));
            }
            if let Some((remaining, changes)) = seen.plan {
                let plan = seen
                    .goal
                    .map_or("none".into(), |_| format!("{remaining} steps at most"));
                rows.push(("way to the goal", plan));
                rows.push(("longer plans since news", changes.to_string()));
            }
            rows.push(("cells known", seen.known_cells.to_string()));
            rows.push(("frontier cells", seen.frontiers.to_string()));
            if seen.shut_cells > 0 {
                rows.push(("cells that were shut", seen.shut_cells.to_string()));
            }
            if seen.is_lost {
                rows.push(("lost", "what it sees contradicts its map".into()));
            }
            kills = seen.alive && !watch.is_replay();
            let stopped = seen.step.map(|step| matches!(step.deed, Deed::Stopped(_)));
            goes_on = kills && stopped == Some(true);
        }
        if let Some(record) = record {
            let goal = record.goal.map_or("none".into(), |goal| goal.to_string());
            rows.push(("goal", goal));
            rows.push(("work in this tick", record.work.to_string()));
            rows.push(("bytes in this tick", record.sent.bytes.to_string()));
        }
        let own = || {
            watch
                .records()
                .iter()
                .filter(|it| usize::from(it.robot) == robot)
        };
        let bytes: u64 = own().map(|it| u64::from(it.sent.bytes)).sum();
        let work = own().map(|it| it.work).max().unwrap_or(0);
        rows.push(("bytes sent so far", bytes.to_string()));
        rows.push(("largest work in a tick", work.to_string()));
        table(ui, rows);
        ui.label(RichText::new("Last decisions").strong());
        for decision in decisions(watch, robot, DECISIONS) {
            ui.label(format!("{}: {}", decision.tick, decision.text));
        }
        if kills && ui.button("Kill this robot").clicked() {
            self.kill(robot);
        }
        if goes_on && ui.button("Let this robot go on").clicked() {
            self.go_on(Some(robot));
        }
        ui.separator();
        self.selected = chosen;
    }
}

impl App {
    /// The drone that was clicked.
    pub(super) fn drone(&mut self, ui: &mut Ui) {
        let Some(survey) = self.surveys.first() else {
            return;
        };
        let drones = usize::from(survey.setup.robots);
        choose(ui, &mut self.selected, "drone", drones);
        let chosen = self.selected.filter(|&drone| drone < drones);
        let (kills, goes_on) = match chosen.map(|drone| survey.drone(drone)) {
            Some(seen) => {
                let kills = seen.is_alive && !survey.is_replay();
                let goes_on = kills && seen.has_stopped;
                table(ui, seen.rows);
                (kills, goes_on)
            }
            None => {
                ui.label("Click a drone to see its state and what it costs.");
                let is_at_end = survey.shown() == survey.ticks() && !survey.is_replay();
                (false, is_at_end && survey.verdict() != Verdict::Running)
            }
        };
        if kills && ui.button("Kill this drone").clicked() {
            self.selected.into_iter().for_each(|drone| self.kill(drone));
        }
        let label = match chosen {
            Some(_) => "Let this drone go on",
            None => "Let all drones go on",
        };
        if goes_on && ui.button(label).clicked() {
            self.go_on(chosen);
        }
        ui.separator();
    }
}

impl App {
    /// Whether drones flew where they should not have, and what befell them, of each survey.
    pub(super) fn violations(&self, ui: &mut Ui) {
        for survey in &self.surveys {
            let told = match survey.violations() {
                (wrong, 0) => format!("No flight was {wrong}."),
                (wrong, flights) => format!("{flights} flights were {wrong}."),
            };
            for told in std::iter::once(told).chain(survey.mishaps()) {
                ui.label(match self.surveys.len() {
                    1 => told,
                    _ => format!("{}: {told}", survey.title()),
                });
            }
        }
    }
}

/// Which robot is looked at more closely, if one is.
fn choose(ui: &mut Ui, chosen: &mut Option<usize>, kind: &str, robots: usize) {
    let name = |robot: Option<usize>| match robot {
        Some(robot) => format!("{kind} {robot}"),
        None => format!("all {kind}s"),
    };
    ui.horizontal(|ui| {
        let menu = egui::ComboBox::from_label("selected").selected_text(name(*chosen));
        menu.show_ui(ui, |ui| {
            for robot in std::iter::once(None).chain((0..robots).map(Some)) {
                ui.selectable_value(chosen, robot, name(robot));
            }
        });
    });
}

/// Names and values, row by row.
fn table(ui: &mut Ui, rows: Vec<(&str, String)>) {
    Grid::new("state")
        .num_columns(2)
        .striped(true)
        .show(ui, |ui| {
            for (what, value) in rows {
                ui.label(what);
                ui.label(value);
                ui.end_row();
            }
        });
}

fn reason(wait: Wait) -> String {
    match wait {
        Wait::Sight => "waits: it has seen nothing yet".into(),
        Wait::Pose => "waits: its pose lies off the map".into(),
        Wait::Search => "waits: it searches the map".into(),
        Wait::Closed => "waits: what is left is behind cells that refused it".into(),
        Wait::Doubt => "waits: it sees a wall of its map free".into(),
        Wait::Patrol => "waits on patrol: nothing is left".into(),
        Wait::Obstructed => "waits: it sees something in its way".into(),
        Wait::Look(way) => format!("looks {}", name(way)),
    }
}

fn words(deed: Deed) -> String {
    match deed {
        Deed::Moved(way) => format!("moved {}", name(way)),
        Deed::Blocked(way) => format!("was blocked on its way {}", name(way)),
        Deed::Held(way) => format!("waits for a robot in the {}", name(way)),
        Deed::Exchanged(way) => format!("exchanged roles with the robot in the {}", name(way)),
        Deed::Yielded => "gave its role away".into(),
        Deed::Waited => "waited".into(),
        Deed::Driving => "is on its way".into(),
        Deed::Looked(way) => format!("looks {}", name(way)),
        Deed::Stopped(stop) => format!("stopped: {stop}"),
    }
}
