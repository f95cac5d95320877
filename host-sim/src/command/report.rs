//! A summary in words.

use std::path::Path;

use host_sim::measured::Measured;
use host_sim::summary::{RobotSummary, Summary};
use planner_core::radio::Hearsay;

/// Prints the summary on standard output.
pub(super) fn print(summary: &Summary, out: &Path) {
    let ticks =
        |ticks: Option<u32>| ticks.map_or("never".into(), |ticks| format!("after {ticks} ticks"));
    println!(
        "{}: {} of {} reachable cells seen",
        summary.head.map, summary.head.seen_cells, summary.head.reachable_cells
    );
    if summary.unreachable_cells > 0 {
        println!(
            "  {} more free cells cannot be reached from the start",
            summary.unreachable_cells
        );
    }
    println!("  everything seen    {}", ticks(summary.head.ticks_to_seen));
    println!(
        "  every robot done   {}",
        ticks(summary.head.ticks_to_stopped)
    );
    println!(
        "  seen by several    {:.0} % of the seen cells",
        100.0 * summary.overlap
    );
    println!(
        "  most work          {} in one tick",
        summary.head.max_work_per_tick
    );
    println!(
        "  maps agree         {}",
        summary
            .maps_differ_because
            .map_or("yes".into(), |why| format!("no: {why}"))
    );
    for (number, robot) in summary.robots.iter().enumerate() {
        println!(
            "  robot {number:<3} {:>6} steps, {:>5} frames of {:>7} bytes sent, {}; {} of {} cells were first learnt from others",
            robot.steps,
            robot.frames_sent,
            robot.bytes_sent,
            state(robot),
            robot.hearsay.cells,
            robot.cells_known,
        );
    }
    if summary.head.conditions.mission.come_home || summary.head.conditions.mission.energy > 0 {
        let home = summary.robots.iter().filter(|robot| robot.is_home).count();
        let robots = summary.robots.len();
        println!("  at home            {home} of {robots} robots");
    }
    if !summary.head.conditions.trouble.is_none() {
        println!(
            "  bumps              {} steps into what was not seen",
            summary.bumps
        );
    }
    if let Some(body) = &summary.body {
        println!(
            "  touches            {} of walls, {} of bodies; no body fits into {} free cells that were seen",
            body.touches.walls, body.touches.bodies, body.narrow_cells
        );
    }
    if let Some(motion) = &summary.motion {
        let after = |seconds: Option<f64>| {
            seconds.map_or("never".into(), |seconds| format!("after {seconds:.0} s"))
        };
        println!(
            "  {:<18} everything seen {}, every robot done {}",
            format!("{} at {} m/s", motion.motion.drive, motion.motion.speed),
            after(motion.seconds_to_seen),
            after(motion.seconds_to_stopped),
        );
        println!(
            "  in all             {:.1} m, {:.1} full turns; touched walls {} times, each other {} times",
            motion.metres, motion.turns, motion.touches.walls, motion.touches.bodies
        );
    }
    for (number, robot) in summary.robots.iter().enumerate() {
        for doubt in doubts(robot) {
            println!("  robot {number:<3} {doubt}");
        }
    }
    if let Some(measured) = &summary.firmware {
        print_measured(measured);
    }
    println!("  trace digest       {}", summary.head.trace_digest);
    println!("  files in           {}", out.display());
}

/// The table of instructions and memory.
fn print_measured(measured: &Measured) {
    println!(
        "  on {:<14} {:>9} {:>9} {:>9} instructions {:>6} bytes of stack",
        measured.machine, "calls", "mean", "largest", "most"
    );
    for (call, tally) in &measured.calls {
        println!(
            "    {:<13} {:>9} {:>9} {:>9} {:>19}",
            call.to_string(),
            tally.calls,
            tally.mean,
            tally.largest,
            tally.stack_bytes
        );
    }
    println!(
        "    planner {} bytes; image: {} bytes of flash, {} of statics, at most {} of {} of stack",
        measured.planner_bytes,
        measured.flash_bytes,
        measured.static_bytes,
        measured.peak_stack_bytes,
        measured.stack_bytes
    );
}

/// What speaks against what a robot believes, heard or claims.
fn doubts(robot: &RobotSummary) -> Vec<String> {
    let Hearsay {
        contradictions,
        contradicted_by,
        same_id,
        refused,
        ..
    } = robot.hearsay;
    let mut doubts = Vec::new();
    if robot.is_lost {
        doubts.push("is lost: what it sees contradicts its map".into());
    }
    if robot.claims_falsely {
        doubts.push(format!(
            "claims falsely: {} cells that it could reach are not on its map",
            robot.cells_unnamed
        ));
    }
    if robot.cells_closed + robot.cells_opened > 0 {
        doubts.push(format!(
            "its map is wrong: {} free cells that it could reach are obstacles, {} obstacles are free",
            robot.cells_closed, robot.cells_opened
        ));
    }
    if same_id > 0 {
        doubts.push(format!(
            "heard {same_id} frames of another robot with its id: each needs its own"
        ));
    }
    if contradictions > 0 {
        let by = contradicted_by.map_or(String::new(), |id| format!(", mostly robot {}", id.0));
        doubts.push(format!(
            "was told {contradictions} cells otherwise than it saw them{by}: do its origin and axes agree?"
        ));
    }
    if refused > 0 {
        doubts.push(format!(
            "refused {refused} frames: damaged, or not signed with its key"
        ));
    }
    doubts
}

/// What an incomplete run left, and why.
pub(super) fn left(summary: &Summary) -> String {
    let mut text = format!(
        "not complete: {} of {} reachable cells unseen after {} ticks",
        summary.head.reachable_cells - summary.head.seen_cells,
        summary.head.reachable_cells,
        summary.head.ticks
    );
    for (number, robot) in summary.robots.iter().enumerate() {
        text += &format!("\n  robot {number}: {}", state(robot));
    }
    text
}

fn state(robot: &RobotSummary) -> &str {
    match &robot.stop_reason {
        _ if !robot.alive => "died",
        Some(reason) => reason,
        None => "still under way",
    }
}
