//! The image for the chip: built, measured, run in the emulator.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail};
use object::{Object, ObjectSegment, ObjectSymbol, SymbolKind};

use crate::shell::{self, Command, Output, cargo, command};
use crate::{budget, host, install, tools};

/// The chip's target: Cortex-M4 with its floating-point unit.
pub(crate) const TARGET: &str = "thumbv7em-none-eabihf";

/// An emulated STM32F405.
const MACHINE: &str = "netduinoplus2";

/// Many times what any of the images takes.
const LIMIT: Duration = Duration::from_secs(300);

/// A linked image.
pub(crate) struct Image {
    path: PathBuf,
    /// Bytes of flash: code, constants, initial values.
    flash: u64,
    /// Bytes of RAM that statics take; the stack is apart.
    statics: u64,
    /// Bytes of code of planner-core.
    planner: u64,
}

impl fmt::Display for Image {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "flash:      {:>7} bytes", self.flash)?;
        writeln!(f, "static RAM: {:>7} bytes", self.statics)?;
        write!(f, "image:      {}", self.path.display())
    }
}

/// A board that QEMU emulates, by QEMU's name of it.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Machine {
    /// STM32F405, the chip of the Crazyflie: Cortex-M4F.
    Netduinoplus2,
    /// Cortex-M3.
    Mps2An385,
    /// nRF51: Cortex-M0.
    Microbit,
}

impl Machine {
    const fn target(self) -> &'static str {
        match self {
            Self::Netduinoplus2 => TARGET,
            Self::Mps2An385 => "thumbv7m-none-eabi",
            Self::Microbit => "thumbv6m-none-eabi",
        }
    }
}

/// Builds the images of a board: the one that explores a built-in map and the robot among
/// voxels, where the board has room for them, and the robot of `host-sim firmware`. Returns
/// the latter last.
pub(crate) fn build_images(machine: Machine) -> Result<Vec<Image>> {
    let names: &[&str] = match machine {
        Machine::Netduinoplus2 => &["firmware", "voxels", "robot"],
        Machine::Mps2An385 | Machine::Microbit => &["robot"],
    };
    names
        .iter()
        .map(|name| build(name, machine.target()))
        .collect()
}

fn build(name: &str, target: &str) -> Result<Image> {
    install::target(target)?;
    cargo_build(target).arg(format!("--bin={name}")).run()?;
    let path = path(name, target);
    measure(&path).with_context(|| format!("{}: cannot be measured", path.display()))
}

/// Every planner decides on every board as on the host, over whole explorations,
/// and its calls keep to the budget.
pub(crate) fn decides_as_the_host() -> Result<String> {
    for machine in [
        Machine::Netduinoplus2,
        Machine::Mps2An385,
        Machine::Microbit,
    ] {
        build_images(machine)?;
    }
    cargo_build(TARGET)
        .args(["--example=stack-overflow", "--example=hangs"])
        .run()?;
    install::qemu()?;
    let output = show(host::test().args(["--test=chips", "--", "--ignored", "--nocapture"]))?;
    print!("{}", output.stdout);
    if !output.success() {
        eprint!("{}", output.stderr);
        bail!("a chip decides otherwise than the host, or does not get so far");
    }
    let measured: Vec<(&str, u64)> = output
        .stdout
        .lines()
        .filter(|line| line.starts_with("loop_"))
        .filter_map(|line| line.split_once(": "))
        .map(|(name, value)| Ok((name, value.parse().with_context(|| name.to_owned())?)))
        .collect::<Result<_>>()?;
    let within = budget::Budget::read(shell::root())
        .and_then(|budget| budget.check("loop_", &measured))
        .map_err(|error| anyhow!(error))?;
    for line in &within {
        println!("{line}");
    }
    // Each test that explores tells how often; a test that did not run tells nothing.
    let explorations: Vec<u32> = entries(&output.stdout, "explorations")
        .map(|count| count.parse().context("a number of explorations"))
        .collect::<Result<_>>()?;
    let sum: u32 = explorations.iter().sum();
    if explorations.len() != EXPLORING_TESTS || sum < EXPLORATIONS {
        bail!(
            "expected at least {EXPLORATIONS} explorations from {EXPLORING_TESTS} tests, \
             not {explorations:?}; were tests of host-sim/tests/chips renamed or taken out?"
        );
    }
    Ok(format!("{sum} explorations with the same decisions"))
}

/// The same of the planners that fly when both sides calculate with micromath, which
/// is another planner: its traces are compared with its own on the host.
pub(crate) fn decides_as_the_host_with_micromath() -> Result<String> {
    const MICROMATH: &str = "--features=planner-core/micromath";
    install::target(TARGET)?;
    install::qemu()?;
    cargo_build(TARGET).args(["--bin=robot", MICROMATH]).run()?;
    let flash = flash(&path("robot", TARGET))?;
    let output = show(
        host::test()
            .args([MICROMATH, "--test=chips", "--", "--ignored", "--nocapture"])
            .arg("flying_robots_decide_on_the_chip_as_on_the_host"),
    )?;
    print!("{}", output.stdout);
    let explorations = entry(&output.stdout, "explorations");
    let Some(explorations) = explorations.filter(|_| output.success()) else {
        eprint!("{}", output.stderr);
        bail!("a chip decides otherwise than the host, or does not get so far");
    };
    Ok(format!(
        "{explorations} explorations with the same decisions; flash {flash}"
    ))
}

/// Tests of host-sim/tests/chips that let chips explore, and how many whole
/// explorations they make at least.
const EXPLORING_TESTS: usize = 4;
const EXPLORATIONS: u32 = 50;

/// Builds the image, runs it and shows its report.
pub(crate) fn build_and_run() -> Result<()> {
    let image = build("firmware", TARGET)?;
    install::qemu()?;
    let output = emulate("firmware")?;
    print!("{}", output.stdout);
    eprint!("{}", output.stderr);
    println!("{image}");
    if !output.success() {
        bail!("the image did not explore completely");
    }
    Ok(())
}

/// The image explores its map completely, within the budget. Returns what it took.
pub(crate) fn explores() -> Result<String> {
    let image = build("firmware", TARGET)?;
    install::qemu()?;
    let output = emulate("firmware")?;
    print!("{}", output.stdout);
    let stop = entry(&output.stdout, "stop");
    if !output.success() || stop != Some("complete") {
        bail!(
            "the image ended with status {:?} and stop reason {stop:?}, not 0 and \"complete\"\n{}",
            output.status,
            output.stderr
        );
    }
    let stack = entry(&output.stdout, "peak stack bytes")
        .and_then(|bytes| bytes.parse().ok())
        .context("the image does not report `peak stack bytes`")?;
    let measured = [
        ("firmware_flash_bytes", image.flash),
        ("firmware_planner_code_bytes", image.planner),
        ("firmware_static_bytes", image.statics),
        ("firmware_peak_stack_bytes", stack),
    ];
    let within = budget::Budget::read(shell::root())
        .and_then(|budget| budget.check("firmware_", &measured))
        .map_err(|error| anyhow!(error))?;
    for line in &within {
        println!("{line}");
    }
    Ok(format!(
        "flash {}, static RAM {}, stack {stack} bytes",
        image.flash, image.statics
    ))
}

/// The example that users start from links with the memory layout of its chip, and
/// explores a pretended room in the emulator; its logs can be read.
pub(crate) fn example_explores() -> Result<String> {
    install::target(TARGET)?;
    cargo([
        "build",
        "--profile=firmware",
        "-p=stm32f405",
        "--target",
        TARGET,
    ])
    // The level of the logs is that of the example, whatever the user prefers.
    .env("DEFMT_LOG", "debug")
    .run()?;
    let image = measure(&path("stm32f405", TARGET))?;
    // What is flashed logs over RTT, which the emulator has not; but what it says
    // can be read if its table can.
    tools::run("logs", [&image.path])?;
    tools::run("logs", [&path("rtic", TARGET)])?;
    install::qemu()?;
    let logs = logs_of("emulated", &EXPECTED_LOGS)?;
    let with_radio = logs_of("rtic_emulated", &EXPECTED_LOGS_WITH_RADIO)?;
    Ok(format!(
        "flash {}, static RAM {} bytes; {logs} logs; with RTIC {with_radio}",
        image.flash, image.statics,
    ))
}

/// Runs an example in the emulator, and looks for what it must log; returns how much it logs.
fn logs_of(image: &str, expected: &[&str]) -> Result<usize> {
    let output = emulate(image)?;
    if !output.success() {
        bail!(
            "the example {image} ended with {:?}\n{}",
            output.status,
            output.stderr
        );
    }
    let image_that_ran = path(image, TARGET);
    let bytes = image_that_ran.with_extension("logs");
    std::fs::write(&bytes, &output.bytes)?;
    let logs = tools::run("logs", [image_that_ran, bytes])?;
    print!("{logs}");
    for expected in expected {
        if !logs.contains(expected) {
            bail!("the example {image} never logs {expected:?}");
        }
    }
    Ok(logs.lines().count())
}

/// What the example logs: in its room everything can be seen, one sensor once does not
/// answer, and at a place glass is in the way.
const EXPECTED_LOGS: [&str; 4] = [
    "DEBUG at Cell { x: 32, y: 32 }: learnt Learnt { cells: ",
    "WARN sensor 0x10: NoAcknowledge(Address)",
    "DEBUG stopped on the way to Cell { x: 37, y: 33 }",
    "INFO Complete; ",
];

/// With RTIC it also hears a second robot, through the interrupt of its radio.
const EXPECTED_LOGS_WITH_RADIO: [&str; 3] = [
    "INFO robot 0: starts at Cell { x: 32, y: 32 }",
    "DEBUG robot 0: hears robot 1 at Cell { x: 37, y: 32 }",
    "INFO Complete; ",
];

/// An image that runs out of stack faults at once, and says so.
pub(crate) fn stack_overflow_faults() -> Result<String> {
    install::target(TARGET)?;
    install::qemu()?;
    cargo_build(TARGET).arg("--example=stack-overflow").run()?;
    let output = emulate("examples/stack-overflow")?;
    print!("{}", output.stderr);
    if output.status != Some(1) || !output.stderr.contains("the stack overflowed") {
        bail!(
            "an image that recurses without end must report \"the stack overflowed\" and end \
             with status 1; it ended with {:?}\nLook at STACK in memory-layout.x.",
            output.status
        );
    }
    Ok(String::new())
}

/// An image that does not fit in RAM does not link, and is told why.
pub(crate) fn too_large_is_refused() -> Result<String> {
    must_not_link(
        "too-large",
        "ERROR(memory-layout.x): the statics of the image do not fit in RAM",
    )
}

/// No path from any planner of planner-core leads to a panic: an image that would need
/// the panic handler does not link.
pub(crate) fn has_no_panic() -> Result<String> {
    must_not_link("no-panic-control", NO_PANIC)?;
    let output = show(cargo_build(TARGET).arg("--example=no-panic"))?;
    if output.success() {
        return Ok(String::new());
    }
    eprint!("{}", output.stderr);
    if output.stderr.contains(NO_PANIC) {
        show_who_panics()?;
    }
    bail!("planner-core can panic, or its proof does not build; see the linker's messages above")
}

/// An image with a panic in it: the control again, whose handler has somewhere to go.
pub(crate) fn image_that_panics() -> Result<PathBuf> {
    cargo([
        "rustc",
        "--profile=firmware",
        "-p=firmware",
        "--target",
        TARGET,
    ])
    .args(["--example=no-panic-control", "--"])
    .arg("-Clink-arg=--defsym=a_panic_is_reachable=0")
    .run()?;
    Ok(path("examples/no-panic-control", TARGET))
}

/// Links the proof with a handler at address 0, asks the linker who needs it, and
/// prints the chains of callers. Inlined callers are not named; `llvm-addr2line -i`
/// on the address of the call names them.
fn show_who_panics() -> Result<()> {
    let output = show(
        cargo([
            "rustc",
            "--profile=firmware",
            "-p=firmware",
            "--target",
            TARGET,
        ])
        .args(["--example=no-panic", "--", "-Wlinker-messages"])
        .arg("-Clink-arg=--defsym=a_panic_is_reachable=0")
        .arg("-Clink-arg=--why-live=*9panicking*"),
    )?;
    print_chains(&output.stderr);
    Ok(())
}

/// Prints what the linker says of symbols that it was asked about.
pub(crate) fn print_chains(said: &str) {
    for line in said.lines() {
        if let Some((before, symbol)) = line.rsplit_once(":(") {
            let arrow = if before.contains(">>>") {
                "  called by"
            } else {
                "reachable:"
            };
            println!("{arrow} {}", symbol.trim_end_matches(')'));
        }
    }
}

/// The symbol that only a panic would need.
const NO_PANIC: &str = "undefined symbol: a_panic_is_reachable";

fn must_not_link(example: &str, reason: &str) -> Result<String> {
    install::target(TARGET)?;
    let output = show(cargo_build(TARGET).arg(format!("--example={example}")))?;
    if output.success() {
        bail!("the example {example} links, and must not");
    }
    if !output.stderr.contains(reason) {
        eprint!("{}", output.stderr);
        bail!("the example {example} fails to link, but not with \"{reason}\"");
    }
    println!("does not link, as it must: {reason}");
    Ok(String::new())
}

fn show(command: Command) -> Result<Output> {
    println!("$ {command}");
    command.output()
}

fn cargo_build(target: &str) -> Command {
    cargo([
        "build",
        "--profile=firmware",
        "-p=firmware",
        "--target",
        target,
    ])
}

pub(crate) fn path(image: &str, target: &str) -> PathBuf {
    host::built().join(target).join("firmware").join(image)
}

pub(crate) fn emulate(image: &str) -> Result<Output> {
    emulate_with(image, &[])
}

/// Builds an image and runs it with a clock that counts instructions, a nanosecond each.
pub(crate) fn build_and_count(image: &str) -> Result<Output> {
    build(image, TARGET)?;
    emulate_with(image, &["-icount", "shift=0"])
}

fn emulate_with(image: &str, options: &[&str]) -> Result<Output> {
    let run = command(install::QEMU)
        .args([
            "-machine",
            MACHINE,
            "-nographic",
            "-monitor",
            "none",
            "-serial",
            "none",
        ])
        .args(options)
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(path(image, TARGET));
    println!("$ {run}");
    run.output_within(LIMIT)
}

/// Bytes of flash that an image takes.
pub(crate) fn flash(image: &Path) -> Result<u64> {
    let bytes = std::fs::read(image)?;
    let elf = object::File::parse(&*bytes)?;
    Ok(elf.segments().map(|segment| segment.file_range().1).sum())
}

fn measure(path: &PathBuf) -> Result<Image> {
    let bytes = std::fs::read(path)?;
    let elf = object::File::parse(&*bytes)?;
    let address = |name: &str| {
        elf.symbol_by_name(name)
            .map(|symbol| symbol.address())
            .with_context(|| format!("no symbol {name}; was it linked with memory-layout.x?"))
    };
    Ok(Image {
        path: path.clone(),
        flash: flash(path)?,
        // RAM begins where the stack does.
        statics: address("__euninit")? - address("_stack_start")?,
        planner: elf
            .symbols()
            .filter(|symbol| symbol.kind() == SymbolKind::Text)
            .filter(|symbol| symbol.name().is_ok_and(|it| it.contains("planner_core")))
            .map(|symbol| symbol.size())
            .sum(),
    })
}

/// The value of the first `key: value` line.
fn entry<'a>(report: &'a str, key: &str) -> Option<&'a str> {
    entries(report, key).next()
}

/// The values of all `key: value` lines with this key.
fn entries<'a>(report: &'a str, key: &str) -> impl Iterator<Item = &'a str> {
    report
        .lines()
        .filter_map(move |line| line.strip_prefix(key)?.strip_prefix(": "))
}
