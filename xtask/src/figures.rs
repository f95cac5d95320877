//! Figures in the documents are what their commands say.
//!
//! `fixtures/figures.txt` ties them together. A number stands in its document alone, and
//! is read there.

mod list;
mod read;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::Range;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};

use crate::documents;
use crate::host;
use crate::shell::{cargo, command, root};
use list::{Entry, Figure};
use read::Correction;

/// Which figures, and what to do about wrong ones.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// The dear ones too, which take hours.
    #[arg(long)]
    all: bool,
    /// Only these, by their names in fixtures/figures.txt; may be given several times.
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Corrects the documents.
    #[arg(long)]
    refresh: bool,
    /// Folder of the maps that are not part of this project; without it, figures that need
    /// them are left out.
    #[arg(long, value_name = "DIR")]
    maps: Option<std::path::PathBuf>,
}

/// The check: the cheap figures.
pub(crate) fn check() -> Result<String> {
    hold(&Options {
        all: false,
        only: Vec::new(),
        refresh: false,
        maps: None,
    })
}

/// Holds the documents against what the commands say; returns a remark.
pub(crate) fn hold(options: &Options) -> Result<String> {
    let entries = list::parse(&fs::read_to_string(root().join("fixtures/figures.txt"))?)?;
    if let Some(unknown) =
        { options.only.iter() }.find(|name| !entries.iter().any(|entry| entry.name == **name))
    {
        let names: Vec<&str> = entries.iter().map(|entry| &*entry.name).collect();
        bail!(
            "--only: no figure {unknown}; there are {}",
            names.join(", ")
        );
    }
    let mut documents = Documents::read(&entries)?;
    documents.all_are_listed(&entries)?;
    let (mut held, mut wrong) = (0, 0);
    for entry in entries.iter().filter(|entry| options.wants(entry)) {
        let begin = Instant::now();
        let measured = options
            .run(entry)
            .with_context(|| format!("[{}]", entry.name))?;
        println!("{:7.1} s  {}", begin.elapsed().as_secs_f64(), entry.name);
        for figure in &entry.figures {
            held += 1;
            let corrections = documents.corrections(figure, &measured);
            for (told, right) in corrections.with_context(|| format!("[{}]", entry.name))? {
                wrong += 1;
                println!("{told} says the command");
                documents.correct(figure, right);
            }
        }
        if options.refresh {
            documents.write()?;
        }
    }
    if wrong > 0 && !options.refresh {
        bail!(
            "{wrong} numbers are not what their commands say; `cargo xtask figures-hold \
             --refresh` with the same options corrects the documents"
        );
    }
    Ok(format!("{held} of {} figures", count(&entries)))
}

fn count(entries: &[Entry]) -> usize {
    let measured = entries.iter().filter(|entry| entry.command.is_some());
    measured.map(|entry| entry.figures.len()).sum()
}

impl Options {
    fn wants(&self, entry: &Entry) -> bool {
        let is_chosen = match &self.only[..] {
            [] => self.all || entry.is_cheap,
            only => only.contains(&entry.name),
        };
        if is_chosen && entry.needs_maps() && self.maps.is_none() {
            println!("left out, for want of --maps: {}", entry.name);
            return false;
        }
        is_chosen && entry.command.is_some()
    }

    /// What the command of an entry says.
    fn run(&self, entry: &Entry) -> Result<String> {
        let line = entry.command.as_ref().context("nothing measures it")?;
        let words: Vec<&str> = line.split_whitespace().collect();
        // What it leaves behind lands in a folder of its own.
        let folder = host::built().join("figures").join(&entry.name);
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        fs::create_dir_all(&folder)?;
        let maps = self.maps.as_deref().map(fs::canonicalize).transpose()?;
        let word = |word: &&str| match (word.strip_prefix("MAPS/"), &maps) {
            (Some(map), Some(maps)) => maps.join(map).into_os_string(),
            _ if word.starts_with("fixtures/") => root().join(word).into_os_string(),
            _ => word.into(),
        };
        let command = match &words[..] {
            // What the checks build has the features of host-sim alone.
            ["cargo", "run", ..] if !line.contains("--features planner-core/") => {
                let program = documents::program(&words[1..])?.context("it is not host-sim's")?;
                let own = words.iter().skip_while(|word| **word != "--").skip(1);
                command(program).args(own.map(word)).dir(&folder)
            }
            // As the checks build it.
            ["cargo", "test", rest @ ..] => host::test().args(rest),
            ["cargo", rest @ ..] => cargo([]).args(rest),
            _ => bail!("`{line}` does not begin with cargo"),
        };
        let output = command.output()?;
        if !output.success() {
            bail!("`{line}` failed\n{}\n{}", output.stdout, output.stderr);
        }
        Ok(match &entry.file {
            Some(file) => {
                let file = match file.starts_with("fixtures/") {
                    true => root().join(file),
                    false => folder.join(file),
                };
                fs::read_to_string(&file).with_context(|| file.display().to_string())?
            }
            None => output.stdout,
        })
    }
}

/// The documents by name, and how they would be right.
struct Documents(BTreeMap<String, Document>);

struct Document {
    text: String,
    corrections: Vec<Correction>,
}

impl Documents {
    fn read(entries: &[Entry]) -> Result<Self> {
        let listed = entries.iter().flat_map(|entry| &entry.figures);
        let mut names: BTreeSet<String> = listed.map(|it| it.document.clone()).collect();
        for page in fs::read_dir(root().join("docs"))? {
            let page = page?.file_name().to_string_lossy().into_owned();
            names.extend(page.ends_with(".md").then(|| format!("docs/{page}")));
        }
        let mut documents = BTreeMap::new();
        for name in names {
            let text = fs::read_to_string(root().join(&name)).with_context(|| name.clone())?;
            let document = Document {
                text,
                corrections: Vec::new(),
            };
            documents.insert(name, document);
        }
        Ok(Self(documents))
    }

    fn document(&self, name: &str) -> Result<&Document> {
        self.0
            .get(name)
            .with_context(|| format!("{name} was not read"))
    }

    /// Whether figures stand where the list says so, with the command that makes them, and
    /// whether every row with numbers of every table is listed.
    fn all_are_listed(&self, entries: &[Entry]) -> Result<()> {
        let mut problems = Vec::new();
        let mut listed: BTreeMap<&str, Vec<Range<usize>>> = BTreeMap::new();
        for entry in entries {
            for Figure { document, told, .. } in &entry.figures {
                let text = &self.document(document)?.text;
                let found = match entry.command.is_none() && read::is_head(told) {
                    true => read::rows(told, text),
                    false => read::find(told, text).map(|found| {
                        let places = found.into_iter().map(|found| found.place);
                        places.collect::<Vec<_>>()
                    }),
                };
                match found {
                    Ok(places) => listed.entry(document).or_default().extend(places),
                    Err(error) => problems.push(format!("[{}] {document}: {error}", entry.name)),
                }
            }
            let shows = |figure: &Figure, command: &str| -> Result<bool> {
                let text = &self.document(&figure.document)?.text;
                Ok(documents::commands_in(text)
                    .iter()
                    .any(|(_, it)| it == command))
            };
            if let Some(command) = entry.command.as_ref().filter(|_| !entry.needs_maps()) {
                let mut is_shown = false;
                for figure in &entry.figures {
                    is_shown |= shows(figure, command)?;
                }
                if !is_shown {
                    problems.push(format!(
                        "[{}]: no document of it shows `{command}`",
                        entry.name
                    ));
                }
            }
        }
        for (name, document) in &self.0 {
            let listed = listed.get(&**name).map_or(&[][..], Vec::as_slice);
            let is_listed = |row: &Range<usize>| {
                listed
                    .iter()
                    .any(|it| row.start < it.end && it.start < row.end)
            };
            for table in read::tables(&document.text) {
                for row in table.figures(&document.text, name == "README.md") {
                    if !is_listed(&row) {
                        let text = document.text[row].trim();
                        problems.push(format!("{name}: nothing in the list measures `{text}`"));
                    }
                }
            }
        }
        match problems.is_empty() {
            true => Ok(()),
            false => Err(anyhow!("fixtures/figures.txt:\n{}", problems.join("\n"))),
        }
    }

    /// What is wrong of a figure, in words, and what is right.
    fn corrections(&self, figure: &Figure, measured: &str) -> Result<Vec<(String, Correction)>> {
        let text = &self.document(&figure.document)?.text;
        let told = read::find(&figure.told, text)?;
        let found = read::find(&figure.measured, measured)
            .with_context(|| format!("what the command says:\n{measured}"))?;
        let corrections = read::compare(&told, &found, figure.tolerance)?;
        let in_words = |(place, right): Correction| {
            let line = 1 + text[..place.start].matches('\n').count();
            let said = &text[place.clone()];
            let name = { told.iter() }
                .find(|it| it.place.start <= place.start && place.end <= it.place.end)
                .map_or("", |it| &it.name);
            let right = read::as_before(said, &right);
            let words = format!(
                "{}:{line}: {name}: {said} stands there, {right}",
                figure.document
            );
            (words, (place, right))
        };
        Ok(corrections.into_iter().map(in_words).collect())
    }

    fn correct(&mut self, figure: &Figure, correction: Correction) {
        if let Some(document) = self.0.get_mut(&figure.document) {
            document.corrections.push(correction);
        }
    }

    /// Writes what was corrected. Places count in what stood there before.
    fn write(&self) -> Result<()> {
        for (name, document) in &self.0 {
            let mut corrections = document.corrections.clone();
            corrections.sort_by_key(|(place, _)| std::cmp::Reverse(place.start));
            corrections.dedup();
            let mut text = document.text.clone();
            for (place, right) in corrections {
                text.replace_range(place, &right);
            }
            if text != document.text {
                fs::write(root().join(name), text)?;
            }
        }
        Ok(())
    }
}
