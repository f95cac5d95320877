//! Fuzzing: planner-core's radio on bytes that no robot would send, host-sim's readers on
//! files that no program would write.

use std::time::Duration;

use anyhow::{Context, Result, bail};

use crate::install;
use crate::shell::{Command, command};

/// The binaries of `fuzz/`.
const TARGETS: [&str; 4] = ["decoder", "files", "robot", "surveys"];

/// Building may take this long, and a last input a little.
const SLACK: Duration = Duration::from_secs(900);

/// Runs every target for this long, from the committed corpus; new inputs stay in
/// `fuzz/found`. Returns executions and coverage of each.
pub(crate) fn run(seconds: u32) -> Result<String> {
    install::cargo_fuzz()?;
    let results: Vec<String> = TARGETS
        .iter()
        .map(|target| one(target, seconds))
        .collect::<Result<_>>()?;
    Ok(results.join("; "))
}

fn one(target: &str, seconds: u32) -> Result<String> {
    let found = format!("fuzz/found/{target}");
    std::fs::create_dir_all(crate::shell::root().join(&found))
        .with_context(|| format!("cannot make {found}"))?;
    let fuzz = cargo_fuzz()
        .args(["run", target, &found, &format!("fuzz/corpus/{target}")])
        .arg("--")
        .arg(format!("-max_total_time={seconds}"))
        .args(["-print_final_stats=1", "-timeout=20"]);
    println!("$ {fuzz}");
    let output = fuzz.output_within(SLACK + Duration::from_secs(seconds.into()))?;
    if !output.success() {
        bail!("{target} failed\n{}", last_lines(&output.stderr, 60));
    }
    let executions = output
        .stderr
        .lines()
        .find_map(|line| line.strip_prefix("stat::number_of_executed_units:"))
        .map_or("?", str::trim);
    let coverage = output
        .stderr
        .lines()
        .rev()
        .find_map(|line| line.split_once(" cov: ")?.1.split(' ').next())
        .unwrap_or("?");
    let result = format!("{target}: {executions} executions, {coverage} edges covered");
    println!("{result}");
    Ok(result)
}

fn cargo_fuzz() -> Command {
    command("rustup").args(["run", install::NIGHTLY, "cargo", "fuzz"])
}

fn last_lines(text: &str, count: usize) -> String {
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(count)..].join("\n")
}
