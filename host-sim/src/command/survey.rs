//! `host-sim survey`.

mod body;
mod print;
mod ways;

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use clap::Args;
use host_sim::draw::{self, Coverage, animate, oblique_voxels, top_view, usual_cut};
use host_sim::export;
use host_sim::run::heights::open;
use host_sim::run::voxels::Simulation;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::{
    Conditions, ConditionsArgs, MediumKind, ScenarioError, parse_share, voxels,
};
use host_sim::scene::{Fov, Frame, Free, Scene, SceneError, SceneOptions, Sensor};
use host_sim::summary::heights::Summary;
use host_sim::summary::voxels::Summary as VoxelSummary;
use host_sim::terrain::{Terrain, TerrainOptions, TerrainSource};
use indicatif::ProgressBar;
use planner_core::Extent;
use planner_core::survey::Limits;
use planner_core::volume::{Field, Voxel};
use planner_core::voxel_survey::MAX_RANGE;

use super::Done;
use super::output::OutputArgs;
use body::BodyArgs;
use print::{ended, print, print_voxels};
use ways::WayArgs;

/// Columns along a side of a terrain of heights, unless said otherwise.
const SIDE: u16 = 100;
/// The same of a town of voxels, and the largest.
const TOWN: u16 = 64;

#[derive(Args)]
pub(crate) struct Survey {
    /// gaussian:SEED, urban:SEED, a grey image (heights in quarters of a cell), a GeoTIFF or an
    /// ESRI ASCII grid (.tif, .asc, metres) or an OctoMap .bt or .ot file, of 1 to 512 columns
    /// on a side. town:SEED is a town of voxels with rooms and bridges: there another planner flies, a voxel a step, and
    /// --step, --min-altitude, --ceiling and --skip are refused.
    #[arg(long, value_name = "WHERE", default_value = "gaussian:0")]
    terrain: TerrainSource,
    /// An OctoMap .bt or .ot tree, a PCD or PLY point cloud, or a PLY or STL mesh, of up to
    /// 512×512×255 voxels, surveyed voxel by voxel as in a town, instead of a terrain. What it
    /// leaves unknown stays unknown: robots neither see nor fly there.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["terrain", "size"])]
    scene: Option<PathBuf>,
    /// Side of a voxel of the --scene in metres: of a tree a whole number of its own, which is
    /// the default.
    #[arg(long, value_name = "M", requires = "scene", allow_negative_numbers = true, value_parser = metres)]
    voxel_size: Option<f64>,
    /// What of a point cloud is free: the rest of its bounding box, or what lies on the rays
    /// from the VIEWPOINT of a PCD file to its points, which leave the rest unknown. Of a mesh
    /// it is always the rest. Default: rest.
    #[arg(long, value_enum, requires = "scene", hide_default_value = true)]
    free: Option<Free>,
    /// Free metres beside and above the bounding box of a cloud or a mesh, to fly about it.
    /// Default: 0.
    #[arg(long, value_name = "M", requires = "scene", allow_negative_numbers = true, value_parser = metres)]
    margin: Option<f64>,
    /// Where all robots start among voxels: metres in the coordinates of the --scene, whole
    /// voxels in a town, metres with --metres-per-cell. Default: in the largest room, low over known ground, as far to the north-west as one can.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    start: Option<Start>,
    /// Height at which pictures among voxels are cut, so that rooms are seen, as the Z of --start.
    /// Default: where most is free under a ceiling; the view from aside is cut only if the robots
    /// start under one.
    #[arg(long, value_name = "Z", allow_negative_numbers = true)]
    cut: Option<f64>,
    /// Side of a column of a drawn --terrain, a town or a picture in metres: what is counted in
    /// cells is counted in metres, too. Other files say it themselves.
    #[arg(long, value_name = "M", conflicts_with = "scene", allow_negative_numbers = true, value_parser = metres)]
    metres_per_cell: Option<f64>,
    /// Metres between two neighbouring shades of a picture, of 8 or 16 bits, or numbers of a
    /// GeoTIFF. Default: a quarter of a cell; of a GeoTIFF 1.
    #[arg(long, value_name = "M", conflicts_with = "scene", allow_negative_numbers = true, value_parser = metres)]
    metres_per_level: Option<f64>,
    #[command(flatten)]
    ways: WayArgs,
    /// Columns along a side of a terrain drawn by a seed: 8 to 512, default 100; of a town
    /// of voxels 8 to 64, default 64.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(8..=512))]
    size: Option<u16>,
    /// How the robots decide. Default: coordinated-survey; among voxels voxel-survey, which
    /// closest-frontier and greedy are there to be compared with.
    #[arg(long, value_enum, hide_default_value = true)]
    planner: Option<Planner>,
    /// Number of robots.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u8).range(1..=64))]
    robots: u8,
    /// Sensor range in cells, above the least altitude and at most 12; among voxels a
    /// whole number from 2.
    #[arg(long, value_name = "R", default_value_t = 8.0)]
    range: f32,
    /// What robots see among voxels: everything around them; what is before a depth camera
    /// (--fov), which turns to one of eight sides, a quarter turn a step; what is no higher
    /// than they are; or their own level. All feel what is within two voxels, and one more than
    /// the --clearance. Over heights all-round and downward are the same: no top above a drone is
    /// in its sight.
    #[arg(long, value_enum, value_name = "KIND", hide_default_value = true)]
    sensor: Option<Sensor>,
    /// Width and height of the image of --sensor camera in degrees: 45 to 170 and 1 to 170.
    /// Default: 90x60.
    #[arg(long, value_name = "WxH")]
    fov: Option<Fov>,
    #[command(flatten)]
    body: BodyArgs,
    /// Longest flight in a step, 0.1 to 100 cells. Default: 2.
    #[arg(long, value_name = "A")]
    step: Option<f32>,
    /// Least altitude over ground, in cells. Default: 2, or the --clearance if that is more.
    #[arg(long, value_name = "H")]
    min_altitude: Option<f32>,
    /// Greatest height, at most 500 cells. Default: 40.
    #[arg(long, value_name = "Z")]
    ceiling: Option<f32>,
    /// Share of its steps that a robot sleeps through, 0 to 1. Default: 0.
    #[arg(long, value_name = "P", value_parser = parse_share)]
    skip: Option<f64>,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    conditions: ConditionsArgs,
}

impl Survey {
    pub(crate) fn run(self) -> Done {
        if let Some(path) = &self.scene {
            self.check_for_voxels()?;
            let options = SceneOptions {
                voxel_size: self.voxel_size,
                free: self.free,
                margin: self.margin,
            };
            let scene = Scene::read(path, &options).map_err(|error| no_scene(path, &error))?;
            return self.run_in(&scene);
        }
        // Where --terrain is given, its conflict with --scene keeps that from being asked for.
        let of_scenes = [
            ("voxel-size", self.voxel_size.is_some()),
            ("free", self.free.is_some()),
            ("margin", self.margin.is_some()),
        ];
        if let Some((option, _)) = of_scenes.iter().find(|(_, given)| *given) {
            return Err(format!("--{option} applies to a --scene FILE alone; leave it out").into());
        }
        if matches!(self.terrain, TerrainSource::Town(_)) {
            self.check_for_voxels()?;
            let scene = self.terrain.scene(self.size.unwrap_or(TOWN));
            let scene = scene.ok_or("a town is a scene")?;
            let scene = self.in_metres(scene)?;
            return self.run_in(&scene);
        }
        let among_voxels = [
            ("start", self.start.is_some()),
            ("cut", self.cut.is_some()),
            ("sensor camera", self.sensor == Some(Sensor::Camera)),
            ("sensor lidar", self.sensor == Some(Sensor::Lidar)),
            ("fov", self.fov.is_some()),
        ];
        let given = among_voxels.iter().find(|(_, given)| *given);
        if let Some((option, _)) = given {
            return Err(format!(
                "--{option} applies among voxels alone; leave it out, or choose --scene \
                 FILE or town:SEED"
            )
            .into());
        }
        if self.size.is_some() && matches!(self.terrain, TerrainSource::File(_)) {
            return Err(
                "--size does not apply: a file has as many columns as it has; \
                        leave --size out"
                    .into(),
            );
        }
        let size = self.size.unwrap_or(SIDE);
        let terrain = self.terrain.load_with(size, &self.metres())?;
        self.ways.check(terrain.scale().is_some())?;
        if let TerrainSource::File(path) = &self.terrain
            && path.extension().is_some_and(|it| it == "bt" || it == "ot")
        {
            eprintln!(
                "of a tree each column counts with its highest voxel; to survey it voxel by voxel, \
                 indoors too, give --scene {}",
                path.display()
            );
        }
        let terrain = Arc::new(terrain);
        let scenario = self.scenario(self.body.over_heights(&terrain)?)?;
        let mut run = open(terrain.clone(), &scenario)?;
        let mut folder = self.output.folder(terrain.name())?;
        let bar = self.output.bar(terrain.extent().cells(), "columns");
        while run.step() {
            advance(&bar, &run.trace().seen);
        }
        bar.finish_and_clear();
        let trace = run.finish();
        let summary = Summary::new(&trace).at_speed(self.ways.speed);
        let json = serde_json::to_string_pretty(&summary)?;
        let all = u32::MAX;
        folder.write("trace.csv", |file| Ok(trace.write(file)?))?;
        folder.write("summary.json", |file| Ok(writeln!(file, "{json}")?))?;
        folder.write("explored.png", |file| draw::top_sheet(&trace, file))?;
        folder.write("oblique.png", |file| draw::oblique_sheet(&trace, file))?;
        folder.write("explored.gif", |file| {
            let steps = trace.seen.len() as u32;
            animate(steps, |step| top_view(&trace, step), file)
        })?;
        folder.write_coverage(&Coverage::from(&trace))?;
        folder.write("map.bt", |file| Ok(trace.octree(all).write(file)?))?;
        let ways = (0..trace.robots).map(|robot| export::over_heights(&trace, robot));
        self.ways.write(&mut folder, ways)?;
        let path = folder.path().to_path_buf();
        folder.close_run()?;
        match self.output.json {
            true => println!("{json}"),
            false => print(&summary, &path),
        }
        print::unmet(&summary.head);
        Ok(ended(&summary.head, "columns", summary.violations))
    }

    /// What is said of the metres of the terrain.
    fn metres(&self) -> TerrainOptions {
        TerrainOptions {
            metres_per_cell: self.metres_per_cell,
            metres_per_level: self.metres_per_level,
        }
    }

    /// A town with voxels of as many metres as was said, its origin in its corner.
    fn in_metres(&self, scene: Scene) -> Result<Scene, String> {
        let metres = self.metres();
        metres.check().map_err(|error| error.to_string())?;
        if metres.metres_per_level.is_some() {
            return Err("--metres-per-level does not apply in a town; leave it out".into());
        }
        Ok(match metres.metres_per_cell {
            None => scene,
            Some(voxel_size) => scene.framed(Some(Frame {
                voxel_size,
                ..Frame::PLAIN
            })),
        })
    }

    /// The same in a scene of voxels.
    fn run_in(self, scene: &Scene) -> Done {
        self.ways.check(scene.frame().is_some())?;
        let mut scenario = voxels::Scenario::new(self.robots.into(), 0);
        scenario.planner = self.planner_for_voxels()?;
        scenario.range = self.range as u8;
        scenario.clearance = self.body.among_voxels(scene)?;
        scenario.field = self.field(scenario.clearance);
        scenario.start = match &self.start {
            Some(start) => Some(start.voxel(scene)?),
            // A town with metres is flown from where it is without.
            None if self.scene.is_none() => scene.clone().framed(None).start(scenario.clearance),
            None => None,
        };
        self.set(&mut scenario.conditions)?;
        let cut = self.cut.map(|z| level(scene, z)).transpose()?;
        let run = Simulation::new(scene, &scenario);
        let mut run = run.map_err(|error| match (error, &self.start) {
            (ScenarioError::NoRoomAt { body, nearest, .. }, Some(start)) => {
                let found = start.typed.clone();
                ScenarioError::NoRoomAt {
                    found,
                    body,
                    nearest,
                }
            }
            (error, _) => error,
        })?;
        let mut folder = self.output.folder(scene.name())?;
        let bar = self.output.bar(run.trace().visible, "voxels");
        while run.step() {
            advance(&bar, &run.trace().seen);
        }
        bar.finish_and_clear();
        let trace = run.finish();
        let summary = VoxelSummary::new(&trace).at_speed(self.ways.speed);
        let json = serde_json::to_string_pretty(&summary)?;
        let all = u32::MAX;
        folder.write("trace.csv", |file| Ok(trace.write(file)?))?;
        folder.write("summary.json", |file| Ok(writeln!(file, "{json}")?))?;
        folder.write("explored.png", |file| draw::plan_sheet(&trace, cut, file))?;
        let cut = cut.or(usual_cut(&trace));
        folder.write("oblique.png", |file| {
            draw::oblique_voxels_sheet(&trace, cut, file)
        })?;
        folder.write("explored.gif", |file| {
            let ticks = trace.seen.len() as u32;
            animate(ticks, |tick| oblique_voxels(&trace, tick, cut), file)
        })?;
        folder.write_coverage(&Coverage::from(&trace))?;
        folder.write("map.bt", |file| Ok(trace.octree(all).write(file)?))?;
        folder.write("map.ply", |file| Ok(export::ply(&trace, file)?))?;
        self.ways.warn_of_cover(trace.starts_covered());
        let ways = (0..trace.ways.len()).map(|robot| export::among_voxels(&trace, robot));
        self.ways.write(&mut folder, ways)?;
        let path = folder.path().to_path_buf();
        folder.close_run()?;
        match self.output.json {
            true => println!("{json}"),
            false => print_voxels(&summary, &path),
        }
        print::unmet(&summary.head);
        Ok(ended(&summary.head, "visible voxels", summary.violations))
    }

    /// Sets the conditions that are given, over those of every survey.
    fn set(&self, conditions: &mut Conditions) -> Result<(), ScenarioError> {
        conditions.medium = MediumKind::Radio;
        self.conditions.clone().set(conditions)
    }

    fn field(&self, clearance: u8) -> Field {
        let sensor = self.sensor.unwrap_or_default();
        sensor.field_for(self.fov.unwrap_or_default(), clearance)
    }

    /// # Errors
    /// A planner that flies over heights alone.
    fn planner_for_voxels(&self) -> Result<voxels::Planner, String> {
        match self.planner {
            None => Ok(voxels::Planner::VoxelSurvey),
            Some(Planner::ClosestFrontier) => Ok(voxels::Planner::ClosestFrontier),
            Some(Planner::Greedy) => Ok(voxels::Planner::Greedy),
            Some(planner) => Err(format!(
                "--planner {planner} does not apply in a town or another scene of voxels; leave it \
                 out, or compare with closest-frontier or greedy"
            )),
        }
    }

    /// Nothing that a survey of voxels would have to ignore or round.
    fn check_for_voxels(&self) -> Result<(), String> {
        let given = [
            ("step", self.step.is_some()),
            ("min-altitude", self.min_altitude.is_some()),
            ("ceiling", self.ceiling.is_some()),
            ("skip", self.skip.is_some()),
        ];
        if let Some((option, _)) = given.iter().find(|(_, given)| *given) {
            return Err(format!(
                "--{option} does not apply among voxels, in a town or a --scene, where robots fly a \
                 voxel a step; leave it out, or choose gaussian:SEED, urban:SEED or a file as \
                 --terrain"
            ));
        }
        if self.fov.is_some() && self.sensor != Some(Sensor::Camera) {
            return Err(
                "--fov is of a camera's image; add --sensor camera, or leave it out".into(),
            );
        }
        if let Some(size) = self.size.filter(|&size| size > TOWN) {
            return Err(format!(
                "--size {size}: expected 8 to {TOWN} for a town of voxels"
            ));
        }
        match self.range.fract() == 0.0 && (2.0..=f32::from(MAX_RANGE)).contains(&self.range) {
            true => Ok(()),
            false => Err(format!(
                "--range {}: expected a whole number from 2 to {MAX_RANGE} among voxels",
                self.range
            )),
        }
    }

    fn scenario(&self, clearance: u8) -> Result<Scenario, ScenarioError> {
        let planner = self.planner.unwrap_or(Planner::CoordinatedSurvey);
        let scenario = Scenario::new(planner, self.robots.into(), 0);
        let mut scenario = scenario.with_clearance(clearance);
        let usual = scenario.limits;
        scenario.limits = Limits {
            range: self.range,
            step: self.step.unwrap_or(usual.step),
            min_altitude: self.min_altitude.unwrap_or(usual.min_altitude),
            ceiling: self.ceiling.unwrap_or(usual.ceiling),
            ..usual
        };
        scenario.skip = self.skip.unwrap_or(scenario.skip);
        self.set(&mut scenario.conditions)?;
        Ok(scenario)
    }
}

/// Three numbers, and how they were typed.
#[derive(Clone)]
struct Start {
    typed: String,
    at: [f64; 3],
}

impl FromStr for Start {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map_while(|part| part.parse().ok())
            .collect();
        match numbers[..] {
            [x, y, z] if numbers.len() == text.split(',').count() => Ok(Self {
                typed: text.into(),
                at: [x, y, z],
            }),
            _ => Err("expected X,Y,Z, three numbers with commas between".into()),
        }
    }
}

impl Start {
    fn voxel(&self, scene: &Scene) -> Result<Voxel, String> {
        let frame = scene.frame().unwrap_or(Frame::PLAIN);
        let voxel = frame.voxel(self.at);
        let voxel = voxel.filter(|voxel| scene.content(*voxel).is_some());
        voxel.ok_or_else(|| {
            let Extent { width, height } = scene.extent();
            let levels = i16::from(scene.levels());
            let last = Voxel::new(width as i16 - 1, height as i16 - 1, levels - 1);
            let corner = |voxel, side: f64| {
                let corner = frame.middle(voxel).map(|at| at + side * frame.voxel_size);
                corner.map(|at| format!("{at:.2}")).join(",")
            };
            format!(
                "--start {}: lies outside of the scene, which reaches from {} to {}",
                self.typed,
                corner(Voxel::new(0, 0, 0), -0.5),
                corner(last, 0.5),
            )
        })
    }
}

/// The level at this height.
///
/// # Errors
/// None is, and how high the scene is.
fn level(scene: &Scene, z: f64) -> Result<i16, String> {
    let frame = scene.frame().unwrap_or(Frame::PLAIN);
    let [x, y, lowest] = frame.middle(Voxel::new(0, 0, 0));
    let voxel = frame.voxel([x, y, z]);
    let voxel = voxel.filter(|voxel| scene.content(*voxel).is_some());
    voxel.map(|voxel| voxel.z).ok_or_else(|| {
        let bottom = lowest - 0.5 * frame.voxel_size;
        let top = bottom + f64::from(scene.levels()) * frame.voxel_size;
        format!("--cut {z}: lies outside of the scene, which reaches from {bottom:.2} to {top:.2}")
    })
}

/// A number of metres.
fn metres(text: &str) -> Result<f64, String> {
    let metres = text.parse();
    metres.map_err(|_| "expected a number of metres without a unit, such as 0.07".into())
}

/// Why a file is no scene; with the option for terrains if it is one.
fn no_scene(path: &Path, error: &SceneError) -> String {
    let name = path.display();
    let is_terrain = match error {
        SceneError::Missing => !matches!(name.to_string().parse(), Ok(TerrainSource::File(_))),
        SceneError::Unknown => Terrain::read(path, &TerrainOptions::default()).is_ok(),
        _ => false,
    };
    match is_terrain {
        true => format!("--scene {name}: is a terrain; give --terrain {name}"),
        false => format!("{name}: {error}"),
    }
}

/// Moves the bar to what has been seen after the last step.
fn advance(bar: &ProgressBar, seen: &[u32]) {
    bar.set_position(seen.last().copied().unwrap_or(0).into());
    bar.set_message(format!("step {}", seen.len()));
}
