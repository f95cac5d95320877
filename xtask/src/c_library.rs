//! The library for C as one object that links into any firmware: nothing of it is seen
//! but `planner_*`, and nothing is left for it to look up elsewhere.
//!
//! A static library would not do: it carries `memcpy`, `sinf` and the helpers for numbers
//! that the processor has not, and firmware that links it before its own C library would
//! run on these.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use object::{Object, ObjectSection, ObjectSymbol, SectionKind};

use crate::shell::{self, cargo, command};
use crate::{c_interface, c_stack, firmware, host, install};

/// What objects are made for: all processors of microcontrollers by Arm, with a
/// floating-point unit (`hf`) and without.
pub(crate) const TARGETS: [&str; 6] = [
    "thumbv6m-none-eabi",
    "thumbv7m-none-eabi",
    "thumbv7em-none-eabi",
    "thumbv7em-none-eabihf",
    "thumbv8m.main-none-eabi",
    "thumbv8m.main-none-eabihf",
];

/// Largest width and height of a map, in cells.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Cells {
    #[value(name = "32")]
    Few,
    #[value(name = "64")]
    Some,
    #[value(name = "128")]
    Many,
}

impl Cells {
    const fn feature(self) -> &'static str {
        match self {
            Self::Few => "--features=cells-32",
            Self::Some => "--features=cells-64",
            Self::Many => "--features=",
        }
    }

    const fn object(self) -> &'static str {
        match self {
            Self::Few => "planner-32.o",
            Self::Some => "planner-64.o",
            Self::Many => "planner.o",
        }
    }
}

/// Builds the object of a target and says what it is.
pub(crate) fn build_and_tell(target: &str, cells: Cells) -> Result<()> {
    let path = build(target, cells)?;
    println!("{} bytes of code and constants", size(&path)?);
    println!("{}", path.display());
    Ok(())
}

/// Builds the object of a target; returns its path.
pub(crate) fn build(target: &str, cells: Cells) -> Result<PathBuf> {
    install::target(target)?;
    install::c_compiler()?;
    cargo(["build", "--profile=firmware", "-p=c-api", "--target"])
        .args([target, cells.feature()])
        .run()?;
    let library = host::built()
        .join(target)
        .join("firmware")
        .join("libplanner.a");
    let header = fs::read_to_string(shell::root().join(c_interface::HEADER))?;
    let whole = library.with_file_name("all-of-planner.o");
    command("arm-none-eabi-ld")
        .args(["-r", "--gc-sections", "--entry=planner_create"])
        .args(
            c_interface::functions(&header)
                .iter()
                .map(|name| format!("--undefined={name}")),
        )
        .arg(&library)
        .arg("-o")
        .arg(&whole)
        .run()?;
    let path = library.with_file_name(cells.object());
    command("arm-none-eabi-objcopy")
        .args(["--wildcard", "--keep-global-symbol=planner_*"])
        // What the compiler left for optimisers of its own kind: others cannot read it.
        .args(["--remove-section=.llvmbc", "--remove-section=.llvmcmd"])
        .args([&whole, &path])
        .run()?;
    stands_alone(&path, &c_interface::functions(&header))?;
    Ok(path)
}

/// The object has all functions of the header, shows nothing else, needs nothing and
/// cannot panic.
fn stands_alone(path: &Path, functions: &[&str]) -> Result<()> {
    let bytes = fs::read(path)?;
    let elf = object::File::parse(&*bytes)?;
    let mut seen = Vec::new();
    for symbol in elf.symbols() {
        let name = symbol.name()?;
        if name.contains(PANIC_HANDLER) {
            c_interface::show_who_panics(&path.with_file_name("libplanner.a"))?;
            bail!(
                "{} can panic; the linker says above from where",
                path.display()
            );
        }
        match (symbol.is_undefined(), symbol.is_global()) {
            (true, _) if !name.is_empty() => bail!("{} needs {name}", path.display()),
            (false, true) => seen.push(name),
            _ => {}
        }
    }
    if let Some(foreign) = seen.iter().find(|name| !functions.contains(name)) {
        bail!("{} defines {foreign} for everyone", path.display());
    }
    let missing = functions.iter().find(|name| !seen.contains(name));
    missing.map_or(Ok(()), |name| bail!("{} has no {name}", path.display()))
}

/// Part of the name of the function that every panic ends in.
pub(crate) const PANIC_HANDLER: &str = "rust_begin_unwind";

/// An image that does panic has the handler by that name.
fn handler_has_its_name() -> Result<()> {
    let bytes = fs::read(firmware::image_that_panics()?)?;
    let elf = object::File::parse(&*bytes)?;
    let has_it = elf
        .symbols()
        .any(|symbol| symbol.name().is_ok_and(|name| name.contains(PANIC_HANDLER)));
    match has_it {
        true => Ok(()),
        false => bail!("an image that panics has no {PANIC_HANDLER}: has it another name now?"),
    }
}

/// Bytes of flash.
pub(crate) fn size(path: &Path) -> Result<u64> {
    let bytes = fs::read(path).with_context(|| path.display().to_string())?;
    let elf = object::File::parse(&*bytes)?;
    let kept = elf.sections().filter(|section| {
        use SectionKind::{Data, ReadOnlyData, ReadOnlyString, Text};
        matches!(section.kind(), Text | Data | ReadOnlyData | ReadOnlyString)
    });
    Ok(kept.map(|section| section.size()).sum())
}

/// Processors without a floating-point unit, the least of all among them, have their
/// object, and so has each size of maps; no path of them leads to a panic, and calls take
/// no more stack than the header says.
pub(crate) fn links_anywhere() -> Result<String> {
    handler_has_its_name()?;
    for target in ["thumbv6m-none-eabi", "thumbv7em-none-eabi"] {
        build(target, Cells::Some)?;
    }
    let mut sizes = Vec::new();
    for cells in [Cells::Few, Cells::Some, Cells::Many] {
        let object = build(firmware::TARGET, cells)?;
        sizes.push(size(&object)?);
        c_stack::keeps_to_the_header(&object)?;
    }
    let [few, some, many] = sizes[..] else {
        bail!("there are three sizes");
    };
    if many > few + 4096 {
        bail!(
            "{few} bytes of flash for maps of 32×32 cells, and {many} for 128×128: is a vacant \
             planner not all zero any more? Then there is a copy of it in flash."
        );
    }
    Ok(format!("flash {few}, {some}, {many} bytes"))
}
