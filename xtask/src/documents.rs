//! Commands that the documents show must exist.

use std::fs;
use std::path::PathBuf;
use std::sync::OnceLock;

use anyhow::{Context, Result, anyhow, bail};
use clap::Parser;
use serde_json::Value;

use crate::host;
use crate::shell::{self, cargo};

/// Checks every `cargo` line in the code blocks of the documents: options of
/// `cargo xtask`, subcommands and options of the simulator, files of fixtures/.
pub(crate) fn check() -> Result<String> {
    let documents = documents()?;
    let mut commands = 0;
    for document in &documents {
        let text = fs::read_to_string(document)?;
        for (line, command) in commands_in(&text) {
            let name = document.strip_prefix(shell::root()).unwrap_or(document);
            exists(&command).with_context(|| format!("{}:{line}: `{command}`", name.display()))?;
            commands += 1;
        }
    }
    Ok(format!(
        "{commands} commands in {} documents",
        documents.len()
    ))
}

/// The Markdown files at the top, in docs/ and of each crate.
fn documents() -> Result<Vec<PathBuf>> {
    let mut documents = Vec::new();
    let mut folders = vec![shell::root().to_path_buf()];
    for name in ["docs", "planner-core", "host-sim", "firmware", "xtask"] {
        folders.extend(Some(shell::root().join(name)).filter(|folder| folder.is_dir()));
    }
    for folder in folders {
        for entry in fs::read_dir(folder)? {
            documents.extend(
                Some(entry?.path()).filter(|path| path.extension().is_some_and(|it| it == "md")),
            );
        }
    }
    documents.sort();
    Ok(documents)
}

/// The `cargo` commands of the code blocks, with their line numbers.
fn commands_in(text: &str) -> Vec<(usize, String)> {
    let mut commands = Vec::new();
    let mut in_block = false;
    let mut lines = text.lines().zip(1..);
    while let Some((line, number)) = lines.next() {
        let line = line.trim();
        if line.starts_with("```") {
            in_block = !in_block;
        }
        let line = line.trim_start_matches("$ ");
        if in_block && line.starts_with("cargo ") {
            let mut command = line.to_owned();
            while let Some(beginning) = command.strip_suffix('\\') {
                command = beginning.to_owned();
                command.extend(lines.next().map(|(next, _)| next.trim()));
            }
            let end = command.find(" #").unwrap_or(command.len());
            commands.push((number, command[..end].trim().to_owned()));
        }
    }
    commands
}

fn exists(command: &str) -> Result<()> {
    let words: Vec<&str> = command.split_whitespace().skip(1).collect();
    for word in words.iter().filter(|word| word.starts_with("fixtures/")) {
        if !shell::root().join(word).exists() {
            bail!("{word} does not exist");
        }
    }
    match words.first() {
        Some(&"xtask") => crate::Cli::try_parse_from(&words)
            .map(drop)
            .or_else(is_help),
        Some(&"run") => simulator_takes(&words),
        Some(&word) if !word.starts_with(['-', '+']) => {
            let known = cargo(["--list"]).output()?.stdout;
            if known
                .lines()
                .any(|line| line.split_whitespace().next() == Some(word))
            {
                Ok(())
            } else {
                bail!("Cargo has no command {word}")
            }
        }
        _ => Ok(()),
    }
}

/// Asking for help is no mistake.
fn is_help(error: clap::Error) -> Result<()> {
    if error.use_stderr() {
        return Err(anyhow!("{error}"));
    }
    Ok(())
}

/// Whether `cargo run … -- SUBCOMMAND …` has its subcommand and options, by the
/// simulator's own help.
fn simulator_takes(words: &[&str]) -> Result<()> {
    let split = words
        .iter()
        .position(|&word| word == "--")
        .unwrap_or(words.len());
    let (cargo_words, ours) = words.split_at(split);
    let mut ours = ours.iter().skip(1).copied().peekable();
    let subcommand = ours.next_if(|word| !word.starts_with('-'));
    let help = shell::command(program(cargo_words)?)
        .args(subcommand)
        .arg("--help")
        .output()?;
    if !help.success() {
        bail!("its help fails:\n{}", help.stderr);
    }
    let known = |option: &str| {
        help.stdout
            .split(|character: char| !(character.is_alphanumeric() || character == '-'))
            .any(|word| word == option)
    };
    for word in ours.filter(|word| word.starts_with("--")) {
        let option = word.split('=').next().unwrap_or(word);
        if !known(option) {
            bail!("there is no option {option}");
        }
    }
    Ok(())
}

/// The program that `cargo run …` runs. An optimised one would say the same; this one
/// is built for the tests anyway.
fn program(cargo_words: &[&str]) -> Result<PathBuf> {
    let mut words = cargo_words.iter().skip(1);
    let mut program = None;
    let mut package = None;
    while let Some(&word) = words.next() {
        match word {
            "--release" => {}
            "-p" => package = words.next().copied(),
            "--example" => program = words.next().map(|name| format!("examples/{name}")),
            _ => bail!("whether Cargo takes {word} is not known here"),
        }
    }
    let (default_members, host_sim) = runnable()?;
    match package {
        None if default_members == ["host-sim"] => {}
        None => bail!("`cargo run` could run any of {default_members:?}"),
        Some("host-sim") if host_sim == ["host-sim"] => {}
        Some(package) => bail!("what `cargo run -p {package}` runs is not known here"),
    }
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    if FOLDER.get().is_none() {
        let _ = FOLDER.set(host::build_simulator()?);
    }
    let folder = FOLDER.get().context("it was just set")?;
    Ok(folder.join(program.as_deref().unwrap_or("host-sim")))
}

/// The programs of the default members of the workspace, and those of host-sim.
fn runnable() -> Result<(Vec<String>, Vec<String>)> {
    let metadata = cargo(["metadata", "--no-deps", "--format-version=1"]).output()?;
    let metadata: Value = serde_json::from_slice(&metadata.bytes)?;
    let list = |of: &Value| of.as_array().cloned().unwrap_or_default();
    let defaults = list(&metadata["workspace_default_members"]);
    let programs = |is_meant: &dyn Fn(&Value) -> bool| -> Vec<String> {
        list(&metadata["packages"])
            .iter()
            .filter(|package| is_meant(package))
            .flat_map(|package| list(&package["targets"]))
            .filter(|target| list(&target["kind"]).contains(&"bin".into()))
            .filter_map(|target| Some(target["name"].as_str()?.to_owned()))
            .collect()
    };
    Ok((
        programs(&|package| defaults.contains(&package["id"])),
        programs(&|package| package["name"] == "host-sim"),
    ))
}

#[cfg(test)]
mod tests {
    use super::{commands_in, exists};

    #[test]
    fn commands_are_found() {
        let text =
            "cargo is a tool\n```sh\n$ cargo xtask test # all\ncargo run -- \\\n  map\n```\n";
        let expected = [
            (3, "cargo xtask test".to_owned()),
            (4, "cargo run -- map".to_owned()),
        ];
        assert_eq!(commands_in(text), expected);
    }

    #[test]
    fn commands_that_do_not_exist_are_found() {
        exists("cargo xtask test --list").unwrap();
        exists("cargo xtask --help").unwrap();
        exists("cargo xtask tset").unwrap_err();
        exists("cargo xtask test --lsit").unwrap_err();
        exists("cargo no-such-command").unwrap_err();
        exists("cargo run -- explore fixtures/maps/nowhere").unwrap_err();
    }
}
