//! `fixtures/figures.txt`: what is measured, how, and where it is told.

use anyhow::{Context, Result, bail, ensure};

/// A command, and the figures that it makes.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Entry {
    pub(super) name: String,
    /// Whether the command takes less than 20 s; the check runs only these.
    pub(super) is_cheap: bool,
    /// None: the figures are definitions, nothing measures them.
    pub(super) command: Option<String>,
    /// Read in place of what the command prints.
    pub(super) file: Option<String>,
    pub(super) figures: Vec<Figure>,
}

/// One figure, or one table.
#[derive(Debug, PartialEq)]
pub(super) struct Figure {
    pub(super) document: String,
    /// What stands in the document, with `{}` for each number, or the head of a table.
    pub(super) told: String,
    /// The same of the command.
    pub(super) measured: String,
    pub(super) tolerance: Tolerance,
}

/// How far a number may be from what is measured: the larger of both.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tolerance {
    /// Of the first number beside it, itself among them.
    pub(super) share: f64,
    pub(super) absolute: f64,
}

impl Entry {
    /// Whether it runs in maps that are not part of this project.
    pub(super) fn needs_maps(&self) -> bool {
        let command = self.command.iter();
        command
            .flat_map(|it| it.split(' '))
            .any(|word| word.starts_with("MAPS/"))
    }
}

/// All entries.
pub(super) fn parse(text: &str) -> Result<Vec<Entry>> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut tolerance = Tolerance::default();
    for (line, number) in text.lines().map(str::trim).zip(1..) {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if let Some(head) = line.strip_prefix('[') {
            entries.push(begin(head).with_context(|| at(number, line))?);
            tolerance = Tolerance::default();
            continue;
        }
        let entry = entries.last_mut();
        let entry = entry.with_context(|| at(number, line) + ": a `[name]` comes first")?;
        add(line, entry, &mut tolerance).with_context(|| at(number, line))?;
    }
    for entry in &entries {
        let is_whole = |figure: &Figure| figure.measured.is_empty() == entry.command.is_none();
        ensure!(
            entry.figures.iter().all(is_whole),
            "[{}]: each figure of a command has a line with `=`, and no other has",
            entry.name
        );
    }
    Ok(entries)
}

fn at(number: i32, line: &str) -> String {
    format!("fixtures/figures.txt, line {number}: `{line}`")
}

fn begin(head: &str) -> Result<Entry> {
    let (name, kind) = head.split_once(']').context("a `]` is missing")?;
    Ok(Entry {
        name: name.to_owned(),
        is_cheap: match kind.trim() {
            "cheap" => true,
            "dear" | "given" => false,
            _ => bail!("cheap, dear or given is missing behind the name"),
        },
        ..Entry::default()
    })
}

fn add(line: &str, entry: &mut Entry, tolerance: &mut Tolerance) -> Result<()> {
    let (mark, rest) = line.split_once(' ').context("a word is missing")?;
    let rest = rest.trim();
    match mark {
        "$" => entry.command = Some(rest.to_owned()),
        "<" => entry.file = Some(rest.to_owned()),
        "±" => *tolerance = read_tolerance(rest)?,
        "=" => {
            let figure = entry.figures.last_mut();
            let figure = figure.context("there is no figure above")?;
            figure.measured = rest.to_owned();
        }
        _ => {
            let document = mark.strip_suffix(':');
            let document = document.context("expected `$`, `<`, `±`, `=` or `document:`")?;
            entry.figures.push(Figure {
                document: document.to_owned(),
                told: rest.to_owned(),
                measured: String::new(),
                tolerance: *tolerance,
            });
        }
    }
    Ok(())
}

/// `5 %`, `0.01`, or both with a comma between.
fn read_tolerance(text: &str) -> Result<Tolerance> {
    let mut tolerance = Tolerance::default();
    for part in text.split(',').map(str::trim) {
        match part.strip_suffix('%') {
            Some(share) => tolerance.share = share.trim().parse::<f64>()? / 100.0,
            None => tolerance.absolute = part.parse()?,
        }
    }
    Ok(tolerance)
}

#[cfg(test)]
mod tests {
    use super::{Entry, Figure, Tolerance, parse};

    #[test]
    fn entries_are_read() {
        let text = "# why\n[office] cheap\n$ cargo run\n± 2 %, 0.5\nREADME.md: {} ticks\n= after {}\n\n\
                    [bytes] given\ndocs/a.md: | offset |\n";
        let figure = |document: &str, told: &str, measured: &str, tolerance| Figure {
            document: document.into(),
            told: told.into(),
            measured: measured.into(),
            tolerance,
        };
        let tolerance = Tolerance {
            share: 0.02,
            absolute: 0.5,
        };
        let office = Entry {
            name: "office".into(),
            is_cheap: true,
            command: Some("cargo run".into()),
            file: None,
            figures: vec![figure("README.md", "{} ticks", "after {}", tolerance)],
        };
        let bytes = Entry {
            name: "bytes".into(),
            figures: vec![figure("docs/a.md", "| offset |", "", Tolerance::default())],
            ..Entry::default()
        };
        assert_eq!(parse(text).unwrap(), [office, bytes]);
    }

    #[test]
    fn a_bad_line_is_named() {
        for (text, why) in [
            ("README.md: {}", "`[name]` comes first"),
            ("[a] cheep", "cheap, dear or given"),
            ("[a] cheap\n$ cargo run\nREADME.md: {}", "a line with `=`"),
            ("[a] cheap\n= {}", "no figure above"),
            ("[a] cheap\nREADME.md {}", "expected"),
        ] {
            let error = format!("{:#}", parse(text).unwrap_err());
            assert!(error.contains(why), "{error}");
        }
    }
}
