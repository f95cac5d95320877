//! Files of surveys: any bytes are an error or a terrain, a tree, a scene or a trace that can be
//! drawn and written again. The last two kinds have a digest that fits, so that what is
//! behind it is reached.
#![no_main]

use host_sim::draw;
use host_sim::scenario::Event;
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::voxels::Scenario as VoxelScenario;
use host_sim::scene::{Free, Scene, SceneOptions};
use host_sim::scene::octree::OcTree;
use host_sim::record::voxels::{self, VoxelTrace};
use host_sim::record::Deed;
use host_sim::record::heights::Trace;
use host_sim::summary::heights::Summary;
use host_sim::terrain::Terrain;
use libfuzzer_sys::fuzz_target;
use planner_core::surface::Height;
use planner_core::volume::Voxel;
use planner_core::{Cell, Extent, Point};

fuzz_target!(|input: &[u8]| {
    let &[kind, ref bytes @ ..] = input else {
        return;
    };
    match kind % 7 {
        0 => {
            if let Ok(terrain) = Terrain::from_bytes(bytes, "bt") {
                assert!(terrain.extent().cells() > 0);
            }
        }
        1 => tree(bytes),
        2 => heights(Trace::read(bytes)),
        3 => voxels(VoxelTrace::read(bytes)),
        4 => {
            let mut file = Vec::new();
            let made = made_heights(&mut Bytes(bytes));
            if made.write(&mut file).is_ok() {
                heights(Trace::read(&file[..]));
            }
        }
        6 => scene(bytes),
        _ => {
            let mut file = Vec::new();
            if made_voxels(&mut Bytes(bytes)).write(&mut file).is_ok() {
                voxels(VoxelTrace::read(&file[..]));
            }
        }
    }
});

/// A tree with a header that fits.
fn tree(bytes: &[u8]) {
    let mut file = b"# Octomap OcTree binary file\nid OcTree\n".to_vec();
    let &[low, high, ref data @ ..] = bytes else {
        return;
    };
    let size = u16::from_le_bytes([low, high]);
    file.extend(format!("size {size}\nres 0.1\ndata\n").bytes());
    file.extend(data);
    if let Ok(tree) = OcTree::read(&file[..]) {
        assert_eq!(tree.nodes(), usize::from(size));
        let mut again = Vec::new();
        tree.write(&mut again).unwrap();
        assert_eq!(OcTree::read(&again[..]).unwrap(), tree);
    }
    let _ = Terrain::from_bytes(&file, "bt");
}

/// A tree, a cloud or a mesh, in any of its formats; the beginning that each needs is found
/// from the files of the corpus. What is refused is refused in words that a terminal can show.
fn scene(bytes: &[u8]) {
    let &[options, ref file @ ..] = bytes else {
        return;
    };
    let options = SceneOptions {
        voxel_size: (options & 1 == 0).then_some(0.25),
        free: [None, Some(Free::Rest), Some(Free::Rays), None][usize::from(options >> 1 & 3)],
        margin: (options & 8 != 0).then_some(0.5),
    };
    match Scene::from_bytes(file, "stl", &options) {
        Ok(scene) => assert!(scene.voxels().next().is_some()),
        Err(error) => {
            let words = error.to_string();
            assert!(words.chars().count() < 1_000, "{words}");
            assert!(!words.chars().any(char::is_control), "{words:?}");
        }
    }
}

fn heights<E>(read: Result<Trace, E>) {
    let Ok(trace) = read else { return };
    let summary = Summary::new(&trace);
    assert!(summary.head.seen_cells <= summary.head.reachable_cells);
    let ticks = trace.seen.len() as u32;
    let _ = draw::oblique_view(&trace, ticks / 2);
    let _ = draw::top_view(&trace, ticks);
    let _ = trace.octree(ticks);
    let mut file = Vec::new();
    trace.write(&mut file).unwrap();
    let again = Trace::read(&file[..]).ok().expect("it is read again");
    assert_eq!(again.found, trace.found);
}

fn voxels<E>(read: Result<VoxelTrace, E>) {
    let Ok(trace) = read else { return };
    assert!(trace.seen.iter().all(|&seen| seen <= trace.visible));
    let ticks = trace.seen.len() as u32;
    let _ = draw::oblique_voxels(&trace, ticks, draw::usual_cut(&trace));
    let mut file = Vec::new();
    trace.write(&mut file).unwrap();
    let again = VoxelTrace::read(&file[..]).ok().expect("it is read again");
    assert_eq!(again.found, trace.found);
}

/// Numbers out of the input; zeros when it is used up.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn array<const N: usize>(&mut self) -> [u8; N] {
        let mut array = [0; N];
        let length = N.min(self.0.len());
        let (taken, rest) = self.0.split_at(length);
        array[..length].copy_from_slice(taken);
        self.0 = rest;
        array
    }

    fn byte(&mut self) -> u8 {
        self.array::<1>()[0]
    }

    /// Mostly something that may be in a box, now and then anything.
    fn length(&mut self, most: f32) -> f32 {
        match self.byte() {
            255 => f32::from_le_bytes(self.array()),
            byte => f32::from(byte) / 200.0 * most,
        }
    }
}

fn made_heights(from: &mut Bytes<'_>) -> Trace {
    let (width, height) = (1 + from.byte() % 24, 1 + from.byte() % 24);
    let extent = Extent::new(width.into(), height.into());
    let relief = from.byte();
    let terrain = Terrain::from_fn(extent, |cell| {
        Height(((cell.x * 7 + cell.y * 3) as u8) % relief.max(1))
    });
    let robots = usize::from(1 + from.byte() % 4);
    let mut scenario = Scenario::new(Planner::Fcao, robots, 0);
    scenario.conditions.max_ticks = u32::from_le_bytes(from.array());
    if from.byte() & 1 == 1 {
        scenario.limits.range = from.length(12.0);
        scenario.limits.step = from.length(9.0);
        scenario.limits.min_altitude = from.length(9.0);
        scenario.limits.ceiling = from.length(99.0);
        scenario.limits.separation = from.length(2.0);
        scenario.limits.clearance = from.byte() % 5;
        scenario.conditions.loss = from.length(1.0).into();
        let death = Event::from((from.byte(), from.byte().into()));
        scenario.conditions.faults.deaths.push(death);
    }
    let point = |from: &mut Bytes<'_>| {
        let (x, y) = (from.length(width.into()), from.length(height.into()));
        Point::new(x, y, from.length(40.0))
    };
    let starts: Vec<_> = (0..robots).map(|_| point(from)).collect();
    let mut records = Vec::new();
    let mut tick = 0u32;
    while !from.0.is_empty() && records.len() < 200 {
        let what = from.byte();
        let pause = match what & 7 {
            0 => u32::from_le_bytes(from.array()),
            1 => u32::from(from.byte()),
            2 => 0,
            _ => 1,
        };
        tick = tick.wrapping_add(pause);
        records.push(host_sim::record::heights::Record {
            tick,
            robot: from.byte() % 5,
            at: point(from),
            deed: [
                Deed::Flew,
                Deed::Refused,
                Deed::Hovered,
            ][usize::from(what >> 3) % 3],
            goal: (what & 0x80 != 0).then(|| Cell::new(from.byte().into(), -1)),
            gain: from.length(9.0),
            known: from.byte().into(),
            work: u32::from_le_bytes(from.array()),
            sent: Default::default(),
        });
    }
    Trace {
        scenario,
        extent,
        terrain,
        robots,
        starts,
        records,
        seen: Vec::new(),
        found: Vec::new(),
        all_stopped: false,
        stops: vec![None; robots],
        safety: Default::default(),
        contacts: 0,
        decision_nanoseconds: Vec::new(),
    }
}

fn made_voxels(from: &mut Bytes<'_>) -> VoxelTrace {
    let extent = Extent::new((1 + from.byte() % 9).into(), (1 + from.byte() % 9).into());
    let levels = 1 + from.byte() % 7;
    let solid = from.byte();
    let scene = Scene::from_fn("made", extent, levels, |Voxel { x, y, z }| {
        z == 0 || (x * 5 + y * 3 + z * 11) % 13 < i16::from(solid) % 4
    });
    let robots = usize::from(1 + from.byte() % 3);
    let mut scenario = VoxelScenario::new(robots, 0);
    scenario.range = from.byte() % 16;
    let voxel = |from: &mut Bytes<'_>| {
        let [x, y, z] = from.array().map(|byte: u8| match byte {
            255 => i16::MIN,
            byte => i16::from(byte % 9),
        });
        Voxel::new(x, y, z)
    };
    let ways = (0..robots).map(|_| vec![voxel(from)]).collect();
    let mut records = Vec::new();
    let mut tick = 0u32;
    while !from.0.is_empty() && records.len() < 200 {
        let what = from.byte();
        let pause = match what & 7 {
            0 => u32::from_le_bytes(from.array()),
            1 => u32::from(from.byte()),
            2 => 0,
            _ => 1,
        };
        tick = tick.wrapping_add(pause);
        records.push(voxels::Record {
            tick,
            robot: from.byte() % 4,
            at: voxel(from),
            deed: [Deed::Flew, Deed::Hovered][usize::from(what >> 3) % 2],
            goal: (what & 0x80 != 0).then(|| voxel(from)),
            gain: host_sim::record::Nothing {},
            known: 7,
            work: 7,
            sent: Default::default(),
        });
    }
    VoxelTrace {
        scenario,
        scene,
        ways,
        headings: Vec::new(),
        records,
        found: Vec::new(),
        visible: 0,
        seen: Vec::new(),
        all_stopped: false,
        stops: vec![None; robots],
        violations: 0,
        contacts: 0,
        bumps: 0,
        false_claims: 0,
        wrong: Vec::new(),
    }
}
