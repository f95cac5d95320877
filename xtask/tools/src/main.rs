//! The part of `cargo xtask` that few of the checks need and that takes minutes to
//! compile: `xtask` runs it when one of them comes.

mod logs;

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["c-header", folder] => c_header(Path::new(folder)),
        ["logs", image] => logs::table(Path::new(image)).map(|_| Vec::new()),
        ["logs", image, bytes] => logs::decode(Path::new(image), Path::new(bytes)),
        ["page", program, folder] => page(Path::new(program), Path::new(folder)),
        _ => Err(anyhow!("this program is for `cargo xtask`")),
    };
    match done.and_then(|text| Ok(std::io::stdout().write_all(&text)?)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// The header of the C interface, from its sources.
fn c_header(folder: &Path) -> Result<Vec<u8>> {
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml"))
        .map_err(|error| anyhow!("c-api/cbindgen.toml: {error}"))?;
    let mut sources = cbindgen::Builder::new().with_config(config);
    for source in ["lib.rs", "place.rs", "types.rs"] {
        sources = sources.with_src(folder.join("src").join(source));
    }
    let mut text = Vec::new();
    sources.generate()?.write(&mut text);
    Ok(text)
}

/// Fits the page's program for the browser.
fn page(program: &Path, folder: &Path) -> Result<Vec<u8>> {
    Bindgen::new()
        .input_path(program)
        .web(true)
        .and_then(|bindgen| {
            bindgen
                .typescript(false)
                // The page does not say where the program is: beside the script.
                .omit_default_module_path(false)
                .remove_name_section(true)
                .out_name("lab")
                .generate(folder)
        })
        .context("the program cannot be fitted for the browser")?;
    Ok(Vec::new())
}
