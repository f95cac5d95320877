//! What a survey came to, in words.

use std::path::Path;
use std::process::ExitCode;

use host_sim::scene::Free;
use host_sim::summary::heights::Summary;
use host_sim::summary::voxels::Summary as VoxelSummary;
use host_sim::summary::{Flown, Head};

/// The exit status; says what is left, if something is.
pub(super) fn ended(head: &Head, places: &str, violations: u32) -> ExitCode {
    if head.complete {
        return ExitCode::SUCCESS;
    }
    eprintln!(
        "not complete: {} of {} {places} unseen after {} steps, {violations} violations",
        head.reachable_cells - head.seen_cells,
        head.reachable_cells,
        head.ticks,
    );
    if head.ticks_to_stopped.is_none() {
        eprintln!("not every robot had stopped: raise --max-ticks, or take larger cells");
    }
    ExitCode::FAILURE
}

/// Says which robots were not told to go on that should have been.
pub(super) fn unmet(head: &Head) {
    let faults = &head.conditions.faults;
    for event in &faults.resumes {
        let (robot, tick) = (event.robot.0, event.tick);
        let why = match () {
            () if tick > head.ticks || tick == head.ticks && head.ticks_to_stopped.is_none() => {
                format!("the run ended after {} steps; see --max-ticks", head.ticks)
            }
            () if !faults.is_alive(event.robot, tick) => "the robot was dead".into(),
            () => continue,
        };
        eprintln!("--resume {robot}@{tick} was not carried out: {why}");
    }
}

fn after(ticks: Option<u32>) -> String {
    ticks.map_or("never".into(), |ticks| format!("after {ticks} ticks"))
}

pub(super) fn print(summary: &Summary, out: &Path) {
    let places = "columns";
    print_head(
        &summary.head,
        places,
        summary.ticks_to_95,
        summary.violations,
    );
    let robots = summary.robots.iter();
    let robots: Vec<_> = robots
        .map(|robot| (robot.steps.into(), &robot.flown))
        .collect();
    print_robots(&robots, places);
    print_metres(summary.seconds.zip(summary.speed), &robots);
    print_home(&summary.head, &robots);
    print_wind(
        &summary.head,
        summary.contacts,
        "on the ground or too near to another robot",
    );
    if let Some(slope) = summary.slope {
        println!(
            "  clearance          {} columns; with this range and least altitude for slopes of at \
             most {slope:.2}",
            summary.clearance
        );
    }
    print_end(&summary.head, out);
}

pub(super) fn print_voxels(summary: &VoxelSummary, out: &Path) {
    print_head(
        &summary.head,
        "visible voxels",
        summary.ticks_to_95,
        summary.violations,
    );
    if !summary.head.conditions.trouble.is_none() {
        println!(
            "  false claims       {} robots say that all is known while something is not",
            summary.false_claims
        );
        println!(
            "  bumps              {} steps into what was not seen",
            summary.bumps
        );
    }
    let robots = summary.robots.iter();
    let robots: Vec<_> = robots
        .map(|robot| (robot.steps as u64, &robot.flown))
        .collect();
    print_robots(&robots, "voxels");
    print_metres(summary.seconds.zip(summary.speed), &robots);
    print_home(&summary.head, &robots);
    print_wind(&summary.head, summary.contacts, "beside or in something");
    println!("  clearance          {} voxels", summary.clearance);
    if let Some(free) = summary.free_space {
        let what = match free {
            Free::Rest => "taken for free where the file has nothing",
            Free::Rays => "free along the rays from the viewpoint",
        };
        println!("  free space         {what}");
    }
    if summary.edge_cells > 0 {
        println!(
            "  end of the scene   {} voxels beside what was seen are unknown in the file",
            summary.edge_cells
        );
    }
    print_end(&summary.head, out);
}

/// The steps of each robot, and the rest.
type Robots<'a> = [(u64, &'a Flown)];

fn print_robots(robots: &Robots<'_>, places: &str) {
    for (number, (steps, robot)) in robots.iter().enumerate() {
        println!(
            "  robot {number:<3} {steps:>6} steps, {:>6} {places} known, {:>5} frames of {:>7} bytes sent, {}",
            robot.cells_known,
            robot.frames_sent,
            robot.bytes_sent,
            state(robot.alive, robot.stop_reason.as_deref()),
        );
    }
}

/// What the wind did.
fn print_wind(head: &Head, contacts: u32, with: &str) {
    if !head.conditions.wind.is_none() {
        println!("  contacts           {contacts} steps that the wind ended {with}");
    }
}

fn print_head(head: &Head, places: &str, ticks_to_95: Option<u32>, violations: u32) {
    let Head {
        map,
        seen_cells,
        reachable_cells,
        ..
    } = head;
    println!("{map}: {seen_cells} of {reachable_cells} {places} seen");
    println!("  95 % seen          {}", after(ticks_to_95));
    println!("  everything seen    {}", after(head.ticks_to_seen));
    println!("  every robot done   {}", after(head.ticks_to_stopped));
    println!(
        "  most work          {} in one tick",
        head.max_work_per_tick
    );
    println!("  violations         {violations}");
}

/// Seconds and speed, and the longest way, where there are any.
fn print_metres(time: Option<(f64, f64)>, robots: &Robots<'_>) {
    if let Some((seconds, speed)) = time {
        println!("  time               {seconds:.0} s at {speed} m/s");
    }
    let ways = robots.iter().filter_map(|(_, robot)| robot.metres);
    if let Some(most) = ways.reduce(f64::max) {
        println!("  longest way        {most:.1} m");
    }
}

/// How many are home that were to come there, and what they had left of their energy.
fn print_home(head: &Head, robots: &Robots<'_>) {
    let mission = head.conditions.mission;
    if !mission.come_home && mission.energy == 0 {
        return;
    }
    let home = robots.iter().filter(|(_, robot)| robot.is_home).count();
    println!("  at home            {home} of {} robots", robots.len());
    for (number, (_, robot)) in robots.iter().enumerate() {
        match robot.energy_left {
            None => {}
            Some(left) if left >= 0 => {
                println!("  energy             robot {number} had {left} steps left");
            }
            Some(left) => println!(
                "  energy             robot {number} exceeded it by {} steps",
                -left
            ),
        }
    }
}

fn print_end(head: &Head, out: &Path) {
    println!("  trace digest       {}", head.trace_digest);
    println!("  results            {}", out.display());
}

fn state(alive: bool, stop: Option<&str>) -> &str {
    match stop {
        _ if !alive => "died",
        Some(reason) => reason,
        None => "had not stopped",
    }
}
