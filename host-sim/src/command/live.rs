//! `host-sim world` and `host-sim robot`.

use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use host_sim::live::{self, Event, RobotOptions, Server, WorldOptions};
use host_sim::planners::PlannerKind;
use host_sim::scenario::grid::default_max_ticks;
use host_sim::scenario::{LinkArgs, Preset};
use host_sim::world::{self, ReadOptions};

use super::{Done, tell_notes};

/// Where the world is served unless said otherwise.
const WORLD_PORT: u16 = 47100;
/// Where robot 0 hears frames unless said otherwise; robot 1 on the next, and so on.
const ROBOT_PORT: u16 = 47101;
/// Ticks between two lines of progress.
const PROGRESS: u32 = 20;
/// Notes that are printed: strangers may make any number of them.
const TROUBLES: u32 = 50;

#[derive(Args)]
pub(crate) struct World {
    /// The map, one cell a pixel or character.
    map: PathBuf,
    /// Number of robots, 1 to 255.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..))]
    robots: u8,
    /// Sensor range in cells, 1 to 15.
    #[arg(long, value_name = "R", default_value_t = 5, value_parser = clap::value_parser!(u8).range(1..=15))]
    range: u8,
    /// Where robots find the world; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS", default_value_t = local(WORLD_PORT))]
    listen: SocketAddr,
    /// Least duration of a tick; 0: as fast as the robots answer.
    #[arg(long, value_name = "MS", default_value_t = 10)]
    pace: u64,
    /// Seconds to wait for a robot that has not come or is gone.
    #[arg(long, value_name = "S", default_value_t = 30)]
    absence: u64,
}

#[derive(Args)]
pub(crate) struct Robot {
    /// Its number, from 0.
    #[arg(long, value_name = "N")]
    id: u8,
    /// Where the world is served.
    #[arg(long, value_name = "ADDRESS", default_value_t = local(WORLD_PORT))]
    world: SocketAddr,
    /// Where it hears frames. Default: port 47101 and its number, on loopback.
    #[arg(long, value_name = "ADDRESS")]
    listen: Option<SocketAddr>,
    /// Where another robot hears frames; repeat it for several. Default: the
    /// default ports of robots 0 to 9.
    #[arg(long = "peer", value_name = "ADDRESS")]
    peers: Vec<SocketAddr>,
    /// What decides.
    #[arg(long, value_name = "NAME", default_value = "explorer")]
    planner: PlannerKind,
    /// Its model of its sensor: truthful, lidar or rangers. Explorer only.
    #[arg(long, value_name = "NAME", default_value = "truthful")]
    preset: Preset,
    #[command(flatten)]
    link: LinkArgs,
}

impl World {
    pub(crate) fn run(self) -> Done {
        let world = Arc::new(world::World::read(&self.map, &ReadOptions::default())?);
        tell_notes(&self.map, &world);
        let starts = world.place(self.robots.into(), &world.default_starts(), false)?;
        let max_ticks = default_max_ticks(&world.reachable(&starts), PlannerKind::Explorer);
        let server = Server::open(WorldOptions {
            world,
            starts,
            range: self.range,
            listen: self.listen,
            pace: Duration::from_millis(self.pace),
            absence: Duration::from_secs(self.absence),
            max_ticks,
        })?;
        println!("listening on {}", server.address());
        let mut troubles = 0;
        let report = server.run(|event| match event {
            Event::Ticked { tick, .. } => {
                if tick.is_multiple_of(PROGRESS) {
                    println!("{event}");
                }
            }
            _ => {
                troubles += 1;
                if troubles <= TROUBLES {
                    eprintln!("note: {event}");
                }
            }
        });
        if troubles > TROUBLES {
            eprintln!("note: {} more notes were left out", troubles - TROUBLES);
        }
        println!("{}", serde_json::to_string(&report)?);
        Ok(match report.is_complete() {
            true => ExitCode::SUCCESS,
            false => ExitCode::from(1),
        })
    }
}

impl Robot {
    pub(crate) fn run(self) -> Done {
        let default_port = |id: u8| local(ROBOT_PORT + u16::from(id));
        let listen = self.listen.unwrap_or_else(|| default_port(self.id));
        let mut peers = self.peers;
        if peers.is_empty() {
            peers = (0..10)
                .filter(|&id| id != self.id)
                .map(default_port)
                .collect();
        }
        let report = live::explore(&RobotOptions {
            robot: self.id,
            planner: self.planner,
            world: self.world,
            listen,
            peers,
            link: self.link.link(),
            preset: self.preset,
        })?;
        println!("{}", serde_json::to_string(&report)?);
        Ok(match report.stop {
            Some(_) => ExitCode::SUCCESS,
            None => ExitCode::from(1),
        })
    }
}

fn local(port: u16) -> SocketAddr {
    (Ipv4Addr::LOCALHOST, port).into()
}
