//! The Crazyflie's app: built against a stub of its firmware and flown in the emulator.
//!
//! Three emulated Crazyflies explore a room. Their sensors are noisy, they tilt, gusts push
//! them into other cells, the radio loses packets, and all have the address that every
//! Crazyflie has when it leaves the factory.

mod room;
mod stub;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use crate::c_library::{self, Cells};
use crate::shell::command;
use crate::{c_interface, firmware, install};
use room::{Drone, Noise, Room};
use stub::{Chip, Packet, Reply};

const DRONES: usize = 3;
const SEEDS: u64 = 20;

/// The app's task has 900 words; a task that is interrupted leaves its registers, those of
/// the floating-point unit too, on its stack.
const STACK: u32 = 900 * 4 - 208;

/// States of the app, as its log has them.
const LANDED: u8 = 4;

/// Seconds of simulated time after which a flight has failed.
const LIMIT_S: u32 = 1200;

/// The app builds without warnings; three of them explore a room, whatever the seed.
pub(crate) fn explores() -> Result<String> {
    install::qemu()?;
    install::newlib()?;
    let image = build()?;
    let (mut longest, mut stack) = (0, 0);
    for seed in 1..=SEEDS {
        let flight = fly(&image, seed).with_context(|| format!("seed {seed}"))?;
        println!(
            "seed {seed:>2}: {:>4} s, {} pushed into another cell, {} packets lost, stack {}",
            flight.seconds, flight.pushed, flight.lost, flight.stack
        );
        longest = longest.max(flight.seconds);
        stack = stack.max(flight.stack);
    }
    if stack > STACK {
        bail!("the app takes {stack} bytes of stack; its task has {STACK}");
    }
    let flash = firmware::flash(&image)?;
    Ok(format!(
        "{SEEDS} of {SEEDS} complete, the longest {longest} s; stack {stack}, flash {flash}"
    ))
}

fn build() -> Result<PathBuf> {
    let object = c_library::build(firmware::TARGET, Cells::Some)?;
    let image = object.with_file_name("crazyflie");
    command(install::C_COMPILER)
        .args(c_interface::CHIP)
        .args(["-std=gnu11", "-Os", "-Wall", "-Wextra", "-Werror"])
        .args(["-Wdouble-promotion", "-DPLANNER_CELLS_64"])
        .args(["-nostartfiles", "--specs=nano.specs"])
        .args(["-I", "c-api/include", "-I", "c-api/example"])
        .args(["-I", "examples/crazyflie/stub"])
        .args(["-T", "c-api/example/stm32f405.ld"])
        .args([
            "examples/crazyflie/src/explore.c",
            "examples/crazyflie/stub/stub.c",
        ])
        .arg("c-api/example/board.c")
        .arg(object)
        .args(["-lm", "-Wl,--gc-sections,-z,noexecstack", "-o"])
        .arg(&image)
        .run()?;
    Ok(image)
}

/// What came of a flight.
struct Flight {
    seconds: u32,
    pushed: u32,
    lost: u32,
    stack: u32,
}

/// One Crazyflie: its chip, its body, and when its app wants to hear again.
struct Robot {
    chip: Chip,
    body: Drone,
    wakes: u32,
    inbox: Vec<Packet>,
    state: u8,
    stop: u8,
    id: u32,
    known: u32,
    stack: u32,
}

/// Flies until all have landed, in steps that the apps ask for; the one that wakes first
/// comes first, so that a seed gives one flight.
fn fly(image: &Path, seed: u64) -> Result<Flight> {
    let room = Room::new();
    let mut noise = Noise::new(seed);
    let mut robots = Vec::new();
    for start in room.starts() {
        robots.push(Robot {
            chip: Chip::start(image)?,
            body: Drone::at(start),
            wakes: 0,
            inbox: Vec::new(),
            state: 0,
            stop: 0,
            id: 0,
            known: 0,
            stack: 0,
        });
    }
    let mut lost = 0;
    while robots.iter().any(|robot| robot.state != LANDED) {
        let turn = (0..DRONES)
            .min_by_key(|&robot| robots[robot].wakes)
            .unwrap_or(0);
        let now = robots[turn].wakes;
        if now > 1000 * LIMIT_S {
            let told: Vec<_> = robots
                .iter()
                .map(|it| (it.state, it.stop, it.known))
                .collect();
            bail!("not landed after {LIMIT_S} s; state, stop and known cells are {told:?}");
        }
        let others: Vec<_> = (0..DRONES)
            .filter(|&robot| robot != turn)
            .map(|robot| robots[robot].body.place())
            .collect();
        let robot = &mut robots[turn];
        // The first word is the app's: until then there is nothing to answer.
        if now > 0 {
            robot.body.pass(now, &room, &others, &mut noise)?;
            let reply = Reply {
                now,
                sensed: robot.body.sense(&room, &others, &mut noise),
                go: now > 1000,
                packets: std::mem::take(&mut robot.inbox),
            };
            robot.chip.send(&reply)?;
        }
        let request = robot.chip.receive()?;
        robot.body.command(&request, now, &mut noise);
        robot.wakes = now + request.delay.max(1);
        (robot.state, robot.stop) = (request.state, request.stop);
        (robot.id, robot.known, robot.stack) = (request.id, request.known, request.stack);
        for packet in request.packets {
            for other in (0..DRONES).filter(|&other| other != turn) {
                match noise.chance(0.2) || robots[other].inbox.len() == stub::PACKETS {
                    true => lost += 1,
                    false => robots[other].inbox.push(packet),
                }
            }
        }
    }
    let mut ids: Vec<_> = robots.iter().map(|robot| robot.id).collect();
    ids.sort_unstable();
    ids.dedup();
    if ids.len() < DRONES {
        bail!("two have one id: {ids:?}");
    }
    let reachable = room.visible();
    for robot in &robots {
        if !room::COMPLETE.contains(&robot.stop) || robot.known < reachable {
            bail!(
                "stopped for reason {} with {} cells known of at least {reachable}",
                robot.stop,
                robot.known
            );
        }
    }
    Ok(Flight {
        seconds: robots
            .iter()
            .map(|robot| robot.wakes / 1000)
            .max()
            .unwrap_or(0),
        pushed: robots.iter().map(|robot| robot.body.pushed).sum(),
        lost,
        stack: robots.iter().map(|robot| robot.stack).max().unwrap_or(0),
    })
}
