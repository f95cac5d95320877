//! What is mapped of a town, in nodes of an octree [Renzaglia2019 fig. 6].

use super::{Drawn, METHODS, colour};
use crate::draw::chart::{Axis, Chart, Panel, Point, Series, Style};
use crate::experiments::table::Csv;
use crate::run::heights::run;
use crate::run::voxels;
use crate::scenario::ScenarioError;
use crate::scenario::heights::{Planner, Scenario};
use crate::scenario::voxels::Scenario as VoxelScenario;
use crate::scene::Scene;
use crate::terrain::Terrain;

/// Nodes of the octree of what is mapped, every tenth step.
pub(super) fn town() -> Result<Drawn, ScenarioError> {
    const TOWN: u16 = 80;
    const VOXELS: u16 = 40;
    let mut csv = Csv::new("planner,tick,nodes");
    let mut curve = |name: String, color, end: u32, nodes: &dyn Fn(u32) -> usize| {
        let ticks = (0..end).step_by(10).chain([end]);
        let points = ticks.map(|tick| {
            let nodes = nodes(tick);
            csv.add([&name, &tick, &nodes]);
            Point::certain(f64::from(tick), nodes as f64)
        });
        Series {
            points: points.collect(),
            name,
            color,
            style: Style::Curve,
        }
    };
    let terrain = Terrain::urban(1, TOWN);
    let mut heights = Vec::new();
    for planner in [Planner::CoordinatedSurvey, Planner::Fcao] {
        let trace = run(&terrain, &Scenario::new(planner, 2, 1))?;
        let end = trace.ticks_to(1.0).unwrap_or(trace.seen.len() as u32);
        let nodes = |tick| trace.octree(tick).nodes();
        heights.push(curve(planner.to_string(), colour(planner), end, &nodes));
    }
    let trace = voxels::run(&Scene::town(1, VOXELS), &VoxelScenario::new(2, 1))?;
    let end = trace.ticks_to(1.0).unwrap_or(trace.seen.len() as u32);
    let nodes = |tick| trace.octree(tick).nodes();
    let inside = curve("voxel-survey".into(), METHODS.len(), end, &nodes);
    let panel = |title: String, series| Panel {
        title,
        x: Axis::Numbers("time (ticks)".into()),
        y: "octree nodes".into(),
        series,
    };
    Ok(Drawn {
        id: "fcao6",
        title: "OctoMap nodes mapped in town by 2 robots".into(),
        caption: format!(
            "[Renzaglia2019, figure 6]: nodes of the octree of what the fleet has mapped, inner \
             ones included, until everything is seen; one run each. Left a town of {TOWN}×{TOWN} \
             heights: streets, buildings, vehicles; step 2. Right a town of {VOXELS}×{VOXELS}×18 \
             voxels with rooms, doors and bridges, mapped by voxel-survey, which flies one voxel \
             a step; free voxels are mapped too."
        ),
        chart: Chart {
            title: "Octree of a town, 2 robots".into(),
            panels: vec![
                panel("heights".into(), heights),
                panel("voxels: voxel-survey".into(), vec![inside]),
            ],
        },
        csv: csv.text(),
        commands: String::new(),
        table: String::new(),
        summary: String::new(),
    })
}
