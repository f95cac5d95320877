//! Commands that the documents show must exist.

use std::fs;
use std::path::PathBuf;
use std::sync::OnceLock;

use anyhow::{Context, Result, anyhow, bail};
use clap::Parser as _;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use serde_json::Value;

use crate::host;
use crate::shell::{self, cargo};

/// Checks every `cargo` command in the documents: options of `cargo xtask`, subcommands
/// and options of the simulator, packages, tests and features, files of fixtures/.
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
    for name in [
        "docs",
        "planner-core",
        "host-sim",
        "firmware",
        "xtask",
        "examples/crazyflie",
        "examples/embassy",
    ] {
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

/// The `cargo` commands of code blocks and of code in text and tables, with their line
/// numbers.
pub(crate) fn commands_in(text: &str) -> Vec<(usize, String)> {
    let mut commands: Vec<(usize, String)> = Vec::new();
    let mut in_block = false;
    for (event, place) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
        let line = 1 + text[..place.start].matches('\n').count();
        match event {
            Event::Start(Tag::CodeBlock(_)) => in_block = true,
            Event::End(TagEnd::CodeBlock) => in_block = false,
            Event::Text(code) if in_block => {
                for (code, line) in code.lines().zip(line..) {
                    match commands.last_mut() {
                        Some((_, begun)) if begun.ends_with('\\') => {
                            begun.pop();
                            begun.push_str(code);
                        }
                        _ => commands.push((line, code.to_owned())),
                    }
                }
            }
            Event::Code(code) => commands.push((line, code.to_string())),
            _ => {}
        }
    }
    commands.retain_mut(|(_, command)| {
        let end = command.find(" #").unwrap_or(command.len());
        let words = command[..end].split_whitespace();
        // Before a command may stand a prompt and the environment.
        let words = words.skip_while(|word| *word == "$" || word.contains('='));
        *command = words.collect::<Vec<_>>().join(" ");
        command.starts_with("cargo ")
    });
    commands
}

fn exists(command: &str) -> Result<()> {
    // What is left out.
    let words = command.split_whitespace().skip(1).filter(|&it| it != "…");
    let words: Vec<&str> = words.collect();
    for word in words.iter().filter(|word| word.starts_with("fixtures/")) {
        if !shell::root().join(word).exists() {
            bail!("{word} does not exist");
        }
    }
    match words[..] {
        ["xtask"] => Ok(()),
        ["xtask", ..] => crate::Cli::try_parse_from(&words)
            .map(drop)
            .or_else(is_help),
        ["run", ..] => simulator_takes(&words),
        [word, ..] if !word.starts_with(['-', '+']) => {
            let known = cargo(["--list"]).output()?.stdout;
            let mut known = known
                .lines()
                .filter_map(|line| line.split_whitespace().next());
            if !known.any(|known| known == word) {
                bail!("Cargo has no command {word}");
            }
            Workspace::read()?.has(&words)
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
    let Some(program) = program(cargo_words)? else {
        return Ok(());
    };
    let help = shell::command(program)
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

/// The program that `cargo run …` runs, or nothing for another than the simulator's. An
/// optimised one would say the same; this one is built for the tests anyway.
pub(crate) fn program(cargo_words: &[&str]) -> Result<Option<PathBuf>> {
    let workspace = Workspace::read()?;
    workspace.has(cargo_words)?;
    let value = |option: &str| {
        let place = cargo_words.iter().position(|&word| word == option)?;
        cargo_words.get(place + 1).copied()
    };
    if value("-p").is_some_and(|package| package != "host-sim") {
        return Ok(None);
    }
    let programs = match value("-p") {
        None => workspace.programs(&|package| workspace.defaults.contains(&package["id"])),
        Some(_) => workspace.programs(&|package| package["name"] == "host-sim"),
    };
    if programs != ["host-sim"] {
        bail!("`cargo run` could run any of {programs:?}");
    }
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    if FOLDER.get().is_none() {
        let _ = FOLDER.set(host::build_simulator()?);
    }
    let folder = FOLDER.get().context("it was just set")?;
    Ok(Some(match value("--example") {
        Some(example) => folder.join("examples").join(example),
        None => folder.join("host-sim"),
    }))
}

/// What Cargo knows of the packages.
struct Workspace {
    packages: Vec<Value>,
    defaults: Vec<Value>,
}

impl Workspace {
    fn read() -> Result<Self> {
        let metadata = cargo(["metadata", "--no-deps", "--format-version=1"]).output()?;
        let metadata: Value = serde_json::from_slice(&metadata.bytes)?;
        Ok(Self {
            packages: list(&metadata["packages"]),
            defaults: list(&metadata["workspace_default_members"]),
        })
    }

    /// Whether there are the packages, targets and features that a command names before
    /// a `--`.
    fn has(&self, words: &[&str]) -> Result<()> {
        let mut words = words.iter().take_while(|&&word| word != "--");
        while let Some(&option) = words.next() {
            let target = option.trim_start_matches("--");
            let is_there = |name: &str| match option {
                "-p" => self.packages.iter().any(|package| package["name"] == name),
                "--features" => {
                    let name = name.rsplit('/').next().unwrap_or(name);
                    self.packages
                        .iter()
                        .any(|it| !it["features"][name].is_null())
                }
                _ => self
                    .targets(&|_| true)
                    .iter()
                    .any(|it| it["name"] == name && list(&it["kind"]).contains(&target.into())),
            };
            if matches!(
                option,
                "-p" | "--features" | "--test" | "--example" | "--bin"
            ) {
                let name = words.next().context("an option without a value")?;
                if !is_there(name) {
                    bail!("there is no {option} {name}");
                }
            }
        }
        Ok(())
    }

    fn targets(&self, is_meant: &dyn Fn(&Value) -> bool) -> Vec<Value> {
        let packages = self.packages.iter().filter(|package| is_meant(package));
        packages
            .flat_map(|package| list(&package["targets"]))
            .collect()
    }

    fn programs(&self, is_meant: &dyn Fn(&Value) -> bool) -> Vec<String> {
        let targets = self.targets(is_meant);
        let programs = targets
            .iter()
            .filter(|it| list(&it["kind"]).contains(&"bin".into()));
        programs
            .filter_map(|it| Some(it["name"].as_str()?.to_owned()))
            .collect()
    }
}

fn list(of: &Value) -> Vec<Value> {
    of.as_array().cloned().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{commands_in, exists};

    #[test]
    fn commands_are_found() {
        let text = "\
cargo is a tool, `cargo
doc` a command

| what | command |
|---|---|
| all | `A=1 cargo xtask test` |

```sh
$ cargo xtask test # all
cargo run -- \\
  map
```
";
        let expected = [
            (1, "cargo doc"),
            (6, "cargo xtask test"),
            (9, "cargo xtask test"),
            (10, "cargo run -- map"),
        ]
        .map(|(line, command)| (line, command.to_owned()));
        assert_eq!(commands_in(text), expected);
    }

    #[test]
    fn commands_that_do_not_exist_are_found() {
        exists("cargo xtask test --list").unwrap();
        exists("cargo xtask --help").unwrap();
        exists("cargo xtask tset").unwrap_err();
        exists("cargo xtask test --lsit").unwrap_err();
        exists("cargo no-such-command").unwrap_err();
        exists("cargo test -p xtask --test budget").unwrap();
        exists("cargo test --test budgie").unwrap_err();
        exists("cargo build --features parquet").unwrap();
        exists("cargo build --features parakeet").unwrap_err();
        exists("cargo run -- explore fixtures/maps/nowhere").unwrap_err();
    }
}
