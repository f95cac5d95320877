//! Licences of the crates and fonts that the programs embed.
//!
//! What is passed on in compiled form must carry the notices of what it is made of. They are
//! read from the sources that Cargo has fetched; a crate whose licence nobody has thought
//! about fails the check.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::shell::{cargo, root};

/// Where the notices go, from the top.
pub(crate) const FILE: &str = "dist/THIRD-PARTY.md";

/// What is passed on in compiled form.
const PROGRAMS: [&str; 3] = ["host-sim", "lab", "c-api"];

/// Licences that ask for no more than their notice.
const ACCEPTED: [&str; 14] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Crates whose manifests have a file of their licence in the place of its name, by what
/// the file says.
const BY_FILE: [(&str, &str); 1] = [("pcd-rs", "MIT")];

/// A crate that a program embeds.
struct Embedded {
    name: String,
    license: String,
    authors: String,
    /// Names and texts of the files that say how it may be used.
    notices: Vec<(String, String)>,
}

/// Writes the notices of all that the programs embed; returns what was written.
///
/// # Errors
/// A crate with a licence that is not in [`ACCEPTED`].
pub(crate) fn write() -> Result<String> {
    let embedded = embedded()?;
    for Embedded { name, license, .. } in &embedded {
        if !is_accepted(license) {
            bail!(
                "{name} has the licence `{license}`; replace the crate, or add the licence to \
                 ACCEPTED in xtask/src/notices.rs if it asks for no more than its notice \
                 (to BY_FILE if it is empty, and a file has its text)"
            );
        }
    }
    let file = root().join(FILE);
    fs::create_dir_all(file.parent().context("a file lies in a folder")?)?;
    fs::write(&file, text(&embedded)).with_context(|| format!("cannot write {FILE}"))?;
    Ok(format!("{FILE}: {} crates", embedded.len()))
}

/// The crates that the programs are made of, on any platform, without those that only
/// compile them.
fn embedded() -> Result<Vec<Embedded>> {
    let metadata = cargo([
        "metadata",
        "--format-version=1",
        "--locked",
        "--features=host-sim/parquet,host-sim/mcap",
    ])
    .output()?;
    if !metadata.success() {
        bail!("cargo metadata: {}", metadata.stderr);
    }
    let metadata: Value = serde_json::from_slice(&metadata.bytes)?;
    let list = |of: &Value| of.as_array().cloned().unwrap_or_default();
    let word = |of: &Value| of.as_str().unwrap_or_default().to_owned();
    let packages: BTreeMap<String, Value> = list(&metadata["packages"])
        .into_iter()
        .map(|package| (word(&package["id"]), package))
        .collect();
    let needs: BTreeMap<String, Value> = list(&metadata["resolve"]["nodes"])
        .into_iter()
        .map(|node| (word(&node["id"]), node["deps"].clone()))
        .collect();
    let is_program = |package: &Value| {
        package["source"].is_null() && PROGRAMS.iter().any(|name| package["name"] == *name)
    };
    let mut left: Vec<String> = packages
        .iter()
        .filter(|(_, package)| is_program(package))
        .map(|(id, _)| id.clone())
        .collect();
    let mut seen: BTreeSet<String> = left.iter().cloned().collect();
    while let Some(id) = left.pop() {
        for need in list(&needs[&id]) {
            let is_linked = list(&need["dep_kinds"])
                .iter()
                .any(|kind| kind["kind"].is_null());
            let id = word(&need["pkg"]);
            if is_linked && !is_macro(&packages[&id]) && seen.insert(id.clone()) {
                left.push(id);
            }
        }
    }
    let others = seen.iter().map(|id| &packages[id]);
    let others = others.filter(|package| !package["source"].is_null());
    let mut embedded = others
        .map(|package| {
            let authors = list(&package["authors"])
                .iter()
                .map(word)
                .collect::<Vec<_>>();
            let manifest = PathBuf::from(word(&package["manifest_path"]));
            Ok(Embedded {
                name: format!("{} {}", word(&package["name"]), word(&package["version"])),
                license: license(package),
                authors: authors.join(", "),
                notices: notices(manifest.parent().context("a manifest lies in a folder")?)?,
            })
        })
        .collect::<Result<Vec<_>>>()?;
    embedded.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(embedded)
}

/// The expression of a crate's licence; empty if it has none.
fn license(package: &Value) -> String {
    let by_file = BY_FILE.iter().find(|(name, _)| package["name"] == *name);
    let license = package["license"].as_str();
    let license = license.or_else(|| by_file.map(|(_, license)| *license));
    // As written before there was a standard.
    license.unwrap_or_default().replace('/', " OR ")
}

fn is_macro(package: &Value) -> bool {
    let targets = package["targets"].as_array();
    targets.is_some_and(|targets| targets.iter().any(|it| it["kind"][0] == "proc-macro"))
}

/// The files of a crate that say how it may be used, those of its fonts among them.
fn notices(folder: &Path) -> Result<Vec<(String, String)>> {
    const BEGINNINGS: [&str; 6] = ["licen", "copying", "copyright", "notice", "unlicen", "ofl"];
    let mut found = Vec::new();
    for place in [folder.to_path_buf(), folder.join("fonts")] {
        let Ok(entries) = fs::read_dir(&place) else {
            continue;
        };
        for entry in entries {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().display().to_string();
            let lower = name.to_lowercase();
            let is_notice = BEGINNINGS.iter().any(|it| lower.starts_with(it))
                // Beside a font lies what is to be said of it.
                || place != folder && lower.ends_with(".txt");
            if is_notice && path.is_file() {
                let text = String::from_utf8_lossy(&fs::read(&path)?).into_owned();
                found.push((name, text.replace('\r', "").trim_end().to_owned()));
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Whether an expression of SPDX can be met by licences that are accepted.
fn is_accepted(license: &str) -> bool {
    // What is in parentheses is judged first, from the inside out.
    let mut license = license.to_owned();
    while let Some(end) = license.find(')') {
        let Some(begin) = license[..end].rfind('(') else {
            return false;
        };
        let inner = match is_accepted(&license[begin + 1..end]) {
            true => ACCEPTED[0],
            false => "refused",
        };
        license.replace_range(begin..=end, inner);
    }
    license.split(" OR ").any(|all| {
        let mut all = all.split(" AND ");
        all.all(|one| ACCEPTED.contains(&one.trim()))
    })
}

fn text(embedded: &[Embedded]) -> String {
    let mut page = String::from(
        "# What the programs are made of\n\n\
         host-sim, the lab and the library for C embed these crates, some of them on some platforms \
         only; the lab and the charts of host-sim also the fonts Ubuntu Light, Hack, Noto Emoji and \
         an emoji icon font, which come with epaint_default_fonts. Their notices \
         follow; where a crate has no file of its own, the text of its licence stands with another.\n\n\
         | crate | licence | authors |\n|---|---|---|\n",
    );
    for it in embedded {
        let authors = it.authors.replace('|', "/");
        let _ = writeln!(page, "| {} | {} | {authors} |", it.name, it.license);
    }
    // Many have the very same text.
    let mut texts: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for it in embedded {
        for (file, text) in &it.notices {
            let of = format!("{} ({file})", it.name);
            texts.entry(text).or_default().push(of);
        }
    }
    let mut texts: Vec<_> = texts.into_iter().collect();
    texts.sort_by(|a, b| a.1.cmp(&b.1));
    for (text, of) in texts {
        let _ = write!(page, "\n## {}\n\n~~~~text\n{text}\n~~~~\n", of.join(", "));
    }
    page
}

#[cfg(test)]
mod tests {
    use super::is_accepted;

    #[test]
    fn licences_are_judged_by_their_expression() {
        for accepted in [
            "MIT",
            "MIT OR GPL-2.0-only",
            "Apache-2.0 WITH LLVM-exception OR GPL-2.0-only",
            "(MIT OR GPL-3.0) AND Unicode-3.0",
        ] {
            assert!(is_accepted(accepted), "{accepted}");
        }
        for refused in [
            "",
            "GPL-3.0",
            "MIT AND GPL-3.0",
            "(GPL-3.0 OR MPL-2.0) AND MIT",
            "MIT)",
        ] {
            assert!(!is_accepted(refused), "{refused}");
        }
    }
}
