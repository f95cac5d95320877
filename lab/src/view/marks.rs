//! What lies over the ground: robots, ways, plans, messages, people and doors.

use egui::epaint::{RectShape, StrokeKind};
use egui::{Align2, Color32, FontId, Pos2, Rect, Shape, Stroke, Vec2, vec2};
use host_sim::medium::{Fate, Message};
use host_sim::run::Stepping;
use host_sim::sensor::ALL_AROUND;
use planner_core::RobotId;

use super::place::Place;
use super::{Frame, MOST_MESSAGES};
use crate::colors::{Colors, mix};
use crate::ground::{self, Subject};
use crate::playback::Playback;
use crate::watch::Obstruction;

/// The colour of a robot's marks: dim if another one is looked at.
pub(super) fn robot_color(frame: &Frame<'_>, colors: &Colors, robot: usize) -> Color32 {
    let color = colors.robot(robot);
    match frame.selected {
        Some(selected) if selected != robot => mix(colors.free, color, 0.4),
        _ => color,
    }
}

/// Ways, goals, plans and messages, over the ground.
pub(super) fn marks(frame: &Frame<'_>, place: &Place, colors: &Colors) -> Vec<Shape> {
    let watch = frame.watch;
    let robots = watch.scenario().starts.len();
    let mut shapes = Vec::new();
    let color = |robot: usize| robot_color(frame, colors, robot);
    if frame.layers.trail > 0 && frame.subject == Subject::World && !place.is_coarse() {
        let width = (place.scale * 0.12).clamp(1.0, 2.5);
        for (robot, way) in ground::ways(watch, frame.layers.trail).iter().enumerate() {
            let lane = place.lane(robot, robots);
            let stroke = Stroke::new(width, color(robot));
            let way = way.iter().map(|&cell| place.middle(cell) + lane);
            shapes.extend(lines(way, stroke));
        }
    }
    let positions = watch.positions();
    if frame.subject != Subject::World {
        for record in watch.last_records() {
            let robot = usize::from(record.robot);
            let Some(&at) = positions.get(robot) else {
                continue;
            };
            let stroke = Stroke::new((place.scale * 0.15).clamp(1.2, 3.0), color(robot));
            let plans = frame.layers.plans && !place.is_coarse();
            if let (true, Some(state)) = (plans, watch.state()) {
                let mut cell = at;
                let mut way = vec![cell];
                for step in state.way(robot) {
                    cell = cell.step(step);
                    ground::extend(&mut way, cell);
                }
                let way = way.into_iter().map(|cell| place.middle(cell));
                shapes.extend(lines(way, stroke));
            }
            if let (true, Some(goal)) = (frame.layers.goals, record.goal) {
                let (middle, arm) = (place.middle(goal), place.robot() * 0.8);
                for arm in [vec2(arm, arm), vec2(arm, -arm)] {
                    shapes.push(Shape::line_segment([middle - arm, middle + arm], stroke));
                }
                if !frame.layers.plans || watch.state().is_none() {
                    let ends = [place.middle(at), middle];
                    shapes.extend(Shape::dashed_line(&ends, stroke, 4.0, 4.0));
                }
            }
        }
    }
    if let (true, Some(state)) = (frame.layers.radio, watch.state()) {
        shapes.extend(messages(frame, state, place, colors));
    }
    shapes
}

/// A way as lines, one as far as it does not turn back: there, egui would widen it.
pub(crate) fn lines(way: impl IntoIterator<Item = Pos2>, stroke: Stroke) -> Vec<Shape> {
    let mut lines = Vec::new();
    let mut points: Vec<Pos2> = Vec::new();
    for point in way {
        if let [.., a, b] = points[..]
            && (b - a).dot(point - b) < 0.0
        {
            lines.push(Shape::line(std::mem::replace(&mut points, vec![b]), stroke));
        }
        points.push(point);
    }
    lines.push(Shape::line(points, stroke));
    lines
}

/// What was said in the last tick. A message that was heard ends in an arrow, one that
/// was lost in a cross on the way, and one under way carries a square: nobody needs to
/// tell colours apart.
fn messages(frame: &Frame<'_>, state: &dyn Stepping, place: &Place, colors: &Colors) -> Vec<Shape> {
    let said = state.messages();
    let robots = frame.watch.scenario().starts.len();
    let concerns = |message: &Message| match frame.selected {
        Some(robot) => [message.from, message.to].contains(&RobotId(robot as u8)),
        None => said.len() <= MOST_MESSAGES,
    };
    let mut drawn = vec![false; robots * robots * 4];
    let mut shapes = Vec::new();
    for message in said.iter().filter(|message| concerns(message)) {
        let [from, to] = [message.from, message.to].map(|id| usize::from(id.0));
        // Several frames make one line.
        let index = (from * robots + to) * 4 + message.fate as usize;
        if std::mem::replace(&mut drawn[index], true) {
            continue;
        }
        let [from, to] = [from, to].map(|robot| state.robot(robot));
        if !from.alive || !to.alive || message.fate == Fate::OutOfReach {
            continue;
        }
        let [begin, end] = [from, to].map(|robot| place.middle(robot.position));
        let along = (end - begin).normalized();
        if along == Vec2::ZERO {
            continue;
        }
        // On the right, as on a road: the answer comes on the other side.
        let aside = vec2(-along.y, along.x) * 3.0;
        let gap = along * (place.robot() + 1.0);
        let (begin, end) = (begin + gap + aside, end - gap + aside);
        // Marks of both directions stay apart.
        let (lost, under_way) = (begin.lerp(end, 0.35), begin.lerp(end, 0.55));
        let quiet = Stroke::new(1.0, mix(colors.free, colors.ink, 0.55));
        let loud = Stroke::new(1.5, colors.lost);
        match message.fate {
            Fate::OutOfReach => {}
            Fate::Heard => {
                shapes.push(Shape::line_segment([begin, end], quiet));
                for side in [aside, -aside] {
                    let feather = end - along * 6.0 + side;
                    shapes.push(Shape::line_segment([feather, end], quiet));
                }
            }
            Fate::UnderWay => {
                shapes.extend(Shape::dotted_line(&[begin, end], quiet.color, 5.0, 1.0));
                let square = Rect::from_center_size(under_way, Vec2::splat(5.0));
                shapes.push(Shape::rect_filled(square, 0.0, quiet.color));
            }
            Fate::Lost => {
                shapes.extend(Shape::dashed_line(&[begin, lost], loud, 4.0, 4.0));
                for arm in [vec2(4.0, 4.0), vec2(4.0, -4.0)] {
                    shapes.push(Shape::line_segment([lost - arm, lost + arm], loud));
                }
            }
        }
    }
    shapes
}

/// What each robot's sensor looks at, if it does not look all around.
pub(super) fn sectors(frame: &Frame<'_>, place: &Place, colors: &Colors) -> Vec<Shape> {
    let scenario = frame.watch.scenario();
    let Some(state) = frame.watch.state().filter(|_| scenario.fov < ALL_AROUND) else {
        return Vec::new();
    };
    let half = f32::from(scenario.fov).to_radians() / 2.0;
    let radius = f32::from(scenario.range) * place.scale;
    let sector = |robot: usize| {
        let seen = state.robot(robot);
        let (x, y) = seen.heading.delta();
        let ahead = vec2(x.into(), y.into()).angle();
        let middle = place.middle(seen.position);
        let arc = (-8..=8).map(|part| ahead + half * part as f32 / 8.0);
        let arc = arc.map(|angle| middle + Vec2::angled(angle) * radius);
        let edge = std::iter::once(middle).chain(arc).collect();
        let stroke = Stroke::new(1.0, robot_color(frame, colors, robot));
        (seen.alive && seen.is_there).then(|| Shape::closed_line(edge, stroke))
    };
    (0..scenario.starts.len()).filter_map(sector).collect()
}

/// People as diamonds, doors as squares: filled where they are shut.
pub(super) fn obstructions(frame: &Frame<'_>, place: &Place, colors: &Colors) -> Vec<Shape> {
    let shape = |obstruction: &Obstruction| {
        let (cell, is_filled) = match *obstruction {
            Obstruction::Person(cell) | Obstruction::Shut(cell) => (cell, true),
            Obstruction::Open(cell) => (cell, false),
        };
        let (middle, half) = (place.middle(cell), (place.scale * 0.5).max(2.5));
        let fill = if is_filled {
            colors.lost
        } else {
            Color32::TRANSPARENT
        };
        let edge = Stroke::new(1.5, colors.lost);
        match obstruction {
            Obstruction::Person(_) => {
                let arms = [
                    vec2(half, 0.0),
                    vec2(0.0, half),
                    vec2(-half, 0.0),
                    vec2(0.0, -half),
                ];
                let corners = arms.map(|arm| middle + arm).to_vec();
                Shape::convex_polygon(corners, fill, edge)
            }
            Obstruction::Shut(_) | Obstruction::Open(_) => {
                let square = Rect::from_center_size(middle, Vec2::splat(2.0 * half - 1.5));
                Shape::Rect(RectShape::new(square, 0.0, fill, edge, StrokeKind::Inside))
            }
        }
    };
    frame.watch.obstructions().iter().map(shape).collect()
}

pub(super) fn paint_robots(
    painter: &egui::Painter,
    frame: &Frame<'_>,
    place: &Place,
    colors: &Colors,
) {
    let radius = place.robot();
    let clearance = frame.watch.scenario().clearance;
    let state = frame.watch.state();
    let records = frame.watch.last_records();
    for (robot, cell) in frame.watch.positions().into_iter().enumerate() {
        let lives = match state {
            Some(state) => state.robot(robot).alive,
            None => {
                frame.watch.shown() == 0 || records.iter().any(|it| usize::from(it.robot) == robot)
            }
        };
        if state.is_some_and(|state| !state.robot(robot).is_there) {
            continue;
        }
        let middle = place.middle(cell);
        let color = colors.robot(robot);
        if clearance > 0 {
            let reach = place.scale * (f32::from(clearance) + 0.5);
            painter.circle(
                middle,
                reach,
                color.gamma_multiply(0.2),
                Stroke::new(1.0, color),
            );
        }
        if lives {
            // Two discs are two quads each; a disc with an edge is dozens of triangles.
            painter.circle_filled(middle, radius + 0.5, colors.ink);
            painter.circle_filled(middle, radius - 0.5, color);
        } else {
            painter.circle(middle, radius, colors.unknown, Stroke::new(2.0, color));
            let arm = vec2(radius, radius) * 0.6;
            let stroke = Stroke::new(2.0, colors.lost);
            painter.line_segment([middle - arm, middle + arm], stroke);
            painter.line_segment([middle - arm.rot90(), middle + arm.rot90()], stroke);
        }
        if frame.selected == Some(robot) {
            painter.circle_stroke(middle, radius + 4.0, Stroke::new(2.0, colors.ink));
        }
        if radius >= 6.0 && lives {
            let font = FontId::proportional(radius * 1.3);
            let text = if luminance(color) > 0.5 {
                Color32::BLACK
            } else {
                Color32::WHITE
            };
            painter.text(middle, Align2::CENTER_CENTER, robot, font, text);
        }
    }
}

fn luminance(color: Color32) -> f32 {
    let [red, green, blue, _] = color.to_array().map(f32::from);
    (0.299 * red + 0.587 * green + 0.114 * blue) / 255.0
}
