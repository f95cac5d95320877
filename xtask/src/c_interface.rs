//! The C interface: its header, what the library links, and its example in the emulator.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{self, cargo, command};
use crate::{c_library, firmware, host, install, tools};
use anyhow::{Context, Result, bail};

pub(crate) const HEADER: &str = "c-api/include/planner.h";

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
    tools::run("c-header", [shell::root().join("c-api")])
}

/// Asks the linker from which functions of a library a panic can be reached.
pub(crate) fn show_who_panics(library: &Path) -> Result<()> {
    let header = fs::read_to_string(shell::root().join(HEADER))?;
    let option = format!("--why-live=*{}*", c_library::PANIC_HANDLER);
    link(library, &functions(&header), &[option])
}

/// An image of the given functions and what they need.
fn link(library: &Path, functions: &[&str], options: &[String]) -> Result<()> {
    let linked = command(linker()?)
        .args(["-flavor", "gnu", "--gc-sections", "--entry=planner_create"])
        .args(functions.iter().map(|name| format!("--undefined={name}")))
        .args(options)
        .arg(library)
        .arg("-o")
        .arg(library.with_file_name("c-functions"));
    println!("$ {linked}");
    let output = linked.output()?;
    firmware::print_chains(&format!("{}{}", output.stdout, output.stderr));
    if !output.success() {
        bail!("the library does not link:\n{}", output.stderr);
    }
    Ok(())
}

/// The linker that comes with the compiler.
fn linker() -> Result<PathBuf> {
    let said = command("rustc")
        .args(["--print=sysroot", "--print=host-tuple"])
        .output()
        .context("rustc")?
        .stdout;
    let [sysroot, host] = said.lines().collect::<Vec<_>>()[..] else {
        bail!("rustc does not say where it lies:\n{said}");
    };
    let path = ["lib", "rustlib", host, "bin", "rust-lld"];
    Ok(path
        .iter()
        .fold(PathBuf::from(sysroot), |path, part| path.join(part)))
}

/// The names of the functions that a header declares.
pub(crate) fn functions(header: &str) -> Vec<&str> {
    let code = header
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    code.filter_map(|line| {
        let (before, _) = line.split_once('(')?;
        let name = before.rsplit([' ', '*']).next()?;
        let is_in_name = |it: char| it.is_ascii_alphanumeric() || it == '_';
        (name.starts_with("planner_") && name.chars().all(is_in_name)).then_some(name)
    })
    .collect()
}

/// A program in C that does everything wrongly gets answers, on the host and under
/// sanitizers; the header compiles as C and as C++, and so does the C in the
/// documents.
pub(crate) fn misuse_is_answered() -> Result<String> {
    install::host_compiler()?;
    cargo(["build", "-p=c-api"]).run()?;
    let folder = host::built().join("debug");
    let program = folder.join("c-misuse");
    let compiler = |language: &str| {
        command(install::HOST_C_COMPILER)
            .args(["-Wall", "-Wextra", "-Werror", "-I", "c-api/include"])
            .arg(format!("-std={language}"))
    };
    compiler("c11")
        .args([
            "-g",
            "-fsanitize=address,undefined",
            "-fno-sanitize-recover=all",
        ])
        .arg("c-api/tests/misuse.c")
        .arg(folder.join("libplanner.a"))
        .args(["-lpthread", "-ldl", "-lm", "-o"])
        .arg(&program)
        .run()?;
    command(&program).run()?;
    compiler("c++11")
        .args(["-fsyntax-only", "-x", "c++", HEADER])
        .run()?;
    let shown = folder.join("porting.c");
    let documents = ["docs/porting.md", "docs/features.md"].map(shown_in);
    fs::write(&shown, documents.into_iter().collect::<Result<String>>()?)?;
    compiler("c11").arg("-fsyntax-only").arg(&shown).run()?;
    Ok(String::new())
}

/// The blocks of C in a document.
fn shown_in(document: &str) -> Result<String> {
    let text = fs::read_to_string(shell::root().join(document)).context(document.to_owned())?;
    let blocks = text.split("\n```c\n").skip(1);
    let code: String = blocks
        .filter_map(|block| block.split("```").next())
        .collect();
    if code.is_empty() {
        bail!("{document} shows no C");
    }
    Ok(code)
}

/// The example in C links with the object and newlib, explores in the emulator, and runs
/// on newlib's functions where both have one.
pub(crate) fn example_explores() -> Result<String> {
    install::qemu()?;
    install::newlib()?;
    let object = c_library::build(firmware::TARGET, c_library::Cells::Many)?;
    let image = object.with_file_name("c-example");
    let source = |name: &str| PathBuf::from("c-api/example").join(name);
    let link = command(install::C_COMPILER)
        .args(CHIP)
        .args(["-std=c11", "-Os", "-Wall", "-Wextra", "-Werror"])
        .args(["-nostartfiles", "--specs=nano.specs"])
        .args(["-I", "c-api/include", "-T"])
        .arg(source("stm32f405.ld"))
        .args([source("main.c"), source("board.c"), object])
        .args(["-lm", "-Wl,--gc-sections,-z,noexecstack"])
        .args(NEWLIBS.map(|(name, _)| format!("-Wl,--trace-symbol={name}")))
        .arg("-o")
        .arg(&image);
    println!("$ {link}");
    let linked = link.output()?;
    let said = format!("{}{}", linked.stdout, linked.stderr);
    if !linked.success() {
        bail!("the example in C does not link:\n{said}");
    }
    for (name, library) in NEWLIBS {
        comes_from(&said, name, library)?;
    }
    other_enumerations_do_not_compile()?;
    let output = firmware::emulate("c-example")?;
    print!("{}{}", output.stdout, output.stderr);
    if !output.success() || !format!("{}{}", output.stdout, output.stderr).contains("complete") {
        bail!("the example in C ended with {:?}", output.status);
    }
    let flash = firmware::flash(&image)?;
    Ok(format!("flash {flash} bytes"))
}

/// What the chip's compiler is told of the chip.
pub(crate) const CHIP: [&str; 4] = [
    "-mcpu=cortex-m4",
    "-mthumb",
    "-mfloat-abi=hard",
    "-mfpu=fpv4-sp-d16",
];

/// Functions that the library has too, and whose the example's must be.
const NEWLIBS: [(&str, &str); 2] = [("memcpy", "libc"), ("sinf", "libm")];

/// The linker says that it took the function from that library, and from nowhere else.
fn comes_from(said: &str, name: &str, library: &str) -> Result<()> {
    let mark = format!(": definition of {name}");
    let found: Vec<&str> = said
        .lines()
        .filter_map(|line| line.strip_suffix(&mark))
        .collect();
    match found[..] {
        [place] if place.contains(&format!("/{library}")) => {
            println!("{name}: {place}");
            Ok(())
        }
        _ => bail!("{name} is to come from {library}, not from {found:?}:\n{said}"),
    }
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

#[cfg(test)]
mod tests {
    use super::functions;

    #[test]
    fn functions_are_found_in_a_header() {
        let header = "\
// What `planner_ghost(` does.
typedef struct {
  uint64_t words[PLANNER_WORDS];
} Planner;
  // See planner_tick().
PlannerResult planner_observe(Planner *planner,
                              size_t count);
bool planner_is(uint8_t stop);
void *planner_memory(void);
static_assert(sizeof(Planner) == 8, \"\");
typedef char planner_has_its_size[sizeof(Planner) == 8 ? 1 : -1];
";
        let found = functions(header);
        assert_eq!(found, ["planner_observe", "planner_is", "planner_memory"]);
    }
}
