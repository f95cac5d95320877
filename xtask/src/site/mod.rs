//! The site: the book, the documentation of the code and the lab's page in one folder.

mod book;
mod links;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::shell::{cargo, root};
use crate::{host, install, lab, notices};

/// The folder of the site, below the top.
const FOLDER: &str = "site";

/// Builds the site; any file server can serve it. Returns what it holds.
///
/// # Errors
/// A link of the book that leads nowhere, or what does not compile.
pub(crate) fn build() -> Result<String> {
    let site = root().join(FOLDER);
    if site.exists() {
        fs::remove_dir_all(&site).with_context(|| format!("cannot empty {}", site.display()))?;
    }
    let chapters = book::build(&site.join("book"))?;
    document()?;
    copy(&host::built().join("doc"), &site.join("api"))?;
    lab::build_page()?;
    fs::create_dir_all(site.join("lab"))?;
    for file in lab::PAGE {
        fs::copy(root().join("dist").join(file), site.join("lab").join(file))?;
    }
    notices::write()?;
    fs::copy(root().join(notices::FILE), site.join("third-party.md"))?;
    fs::copy(root().join("docs/site.html"), site.join("index.html"))?;
    let links = links::check(&site)?;
    Ok(format!("{FOLDER}/: {chapters} chapters, {links} links"))
}

/// The documentation of the code, in which nothing may be doubtful.
pub(crate) fn document() -> Result<()> {
    cargo([
        "doc",
        "--workspace",
        "--no-deps",
        "--features=host-sim/parquet,host-sim/mcap",
    ])
    .env("RUSTDOCFLAGS", "-Dwarnings")
    .run()
}

/// The site in a real browser, wide and narrow.
pub(crate) fn works() -> Result<String> {
    install::chromium()?;
    let holds = build()?;
    host::test()
        .args(["--test=page", "--", "--ignored", "the_site"])
        .run()?;
    Ok(holds)
}

/// Copies a folder and all that is in it.
fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from).with_context(|| format!("cannot read {}", from.display()))? {
        let entry = entry?;
        let to = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &to)?;
        } else {
            fs::copy(entry.path(), to)?;
        }
    }
    Ok(())
}
