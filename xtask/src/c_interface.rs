//! The C interface: its header, and its example in the emulator.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};

use crate::shell::{self, cargo, command};
use crate::{firmware, install};

const HEADER: &str = "c-api/include/planner.h";

/// Writes the header.
pub(crate) fn write_header() -> Result<()> {
    let path = shell::root().join(HEADER);
    fs::write(&path, header()?).with_context(|| path.display().to_string())?;
    println!("wrote {HEADER}");
    Ok(())
}

/// The committed header is what the sources say.
pub(crate) fn header_is_current() -> Result<String> {
    let committed = fs::read_to_string(shell::root().join(HEADER)).context(HEADER)?;
    if committed != header()? {
        bail!("{HEADER} is not what c-api/src says; run `cargo xtask c-header` and commit it");
    }
    Ok(String::new())
}

fn header() -> Result<String> {
    let folder = shell::root().join("c-api");
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml"))
        .map_err(|error| anyhow::anyhow!("c-api/cbindgen.toml: {error}"))?;
    let mut sources = cbindgen::Builder::new().with_config(config);
    for source in ["lib.rs", "place.rs", "types.rs"] {
        sources = sources.with_src(folder.join("src").join(source));
    }
    let mut text = Vec::new();
    sources.generate()?.write(&mut text);
    Ok(String::from_utf8(text)?)
}

/// The example in C links with the static library, without a C library, and
/// explores in the emulator.
pub(crate) fn example_explores() -> Result<String> {
    install::target(firmware::TARGET)?;
    install::qemu()?;
    install::c_compiler()?;
    cargo([
        "build",
        "--profile=firmware",
        "-p=c-api",
        "--target",
        firmware::TARGET,
    ])
    .run()?;
    let library = firmware::path("libplanner.a", firmware::TARGET);
    let image = library.with_file_name("c-example");
    let source = |name: &str| PathBuf::from("c-api/example").join(name);
    command(install::C_COMPILER)
        .args([
            "-mcpu=cortex-m4",
            "-mthumb",
            "-mfloat-abi=hard",
            "-mfpu=fpv4-sp-d16",
        ])
        .args([
            "-std=c11",
            "-Os",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-ffreestanding",
            "-nostdlib",
        ])
        .args(["-I", "c-api/include", "-T"])
        .arg(source("stm32f405.ld"))
        .args([source("main.c"), source("board.c"), library])
        .args(["-Wl,--gc-sections,-z,noexecstack", "-o"])
        .arg(&image)
        .run()?;
    other_enumerations_do_not_compile()?;
    let output = firmware::emulate("c-example")?;
    print!("{}{}", output.stdout, output.stderr);
    if !output.success() || !format!("{}{}", output.stdout, output.stderr).contains("complete") {
        bail!("the example in C ended with {:?}", output.status);
    }
    let flash = firmware::flash(&image)?;
    Ok(format!("flash {flash} bytes"))
}

/// With enumerations of four bytes, structures would not look as the library thinks:
/// the header says so.
fn other_enumerations_do_not_compile() -> Result<()> {
    let compile = command(install::C_COMPILER)
        .args(["-mcpu=cortex-m4", "-mthumb", "-std=c11"])
        .args([
            "-fno-short-enums",
            "-fsyntax-only",
            "c-api/include/planner.h",
        ]);
    println!("$ {compile}");
    let output = compile.output()?;
    if output.success() || !output.stderr.contains("compile with -fshort-enums") {
        bail!("{HEADER} must refuse -fno-short-enums");
    }
    Ok(())
}
