//! The book: the documents as they lie in the project, in the order of docs/SUMMARY.md.
//!
//! mdBook wants all chapters in one folder of their own, so they are laid out in one, by
//! their paths from the top; with them goes every file that they link to. So their links
//! lead to the same places here and on a code host.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result, bail};
use pulldown_cmark::{Event, Options, Parser, Tag};

use crate::shell::{command, root};
use crate::{host, install};

const SUMMARY: &str = "docs/SUMMARY.md";

/// Builds the book into a folder; returns the number of its chapters.
pub(super) fn build(to: &Path) -> Result<usize> {
    let book = host::built().join("book");
    if book.exists() {
        fs::remove_dir_all(&book)?;
    }
    let chapters = lay_out(root(), &book.join("src"))?;
    for file in ["book.toml", "theme/header.hbs", "theme/site.css"] {
        put(&root().join("docs").join(file), &book.join(file))?;
    }
    let mdbook = install::mdbook()?;
    command(mdbook)
        .arg("build")
        .arg(&book)
        .arg("--dest-dir")
        .arg(to)
        .run()?;
    Ok(chapters)
}

/// Puts the chapters below `top`, and what they link to, into the folder `to`.
///
/// # Errors
/// A link to what does not exist, with its document and line.
fn lay_out(top: &Path, to: &Path) -> Result<usize> {
    let mut summary = fs::read_to_string(top.join(SUMMARY))?;
    let mut chapters = BTreeMap::new();
    for link in links_in(&summary) {
        let path = link.file(top, Path::new(SUMMARY))?;
        let old = format!("]({})", link.to);
        summary = summary.replace(&old, &format!("]({})", page(&path).display()));
        chapters.insert(path, link.text);
    }
    fs::create_dir_all(to)?;
    fs::write(to.join("SUMMARY.md"), summary)?;

    let mut beside = BTreeSet::new();
    for (path, title) in &chapters {
        let mut text = fs::read_to_string(top.join(path))?;
        let links = match is_markdown(path) {
            true => links_in(&text),
            false => {
                let kind = path.extension().unwrap_or_default().display();
                text = format!("# {title}\n\n```{kind}\n{text}```\n");
                Vec::new()
            }
        };
        for link in links {
            let file = link.file(top, path)?;
            if is_markdown(&file) && !chapters.contains_key(&file) {
                bail!(
                    "{}:{}: {} is no chapter; add it to {SUMMARY}",
                    path.display(),
                    link.line,
                    file.display()
                );
            }
            let old = format!("]({})", link.to);
            text = text.replace(&old, &old.replace("README.md", "index.md"));
            beside.insert(file);
        }
        let page = to.join(page(path));
        fs::create_dir_all(page.parent().context("it lies in a folder")?)?;
        fs::write(page, text)?;
    }
    for file in beside.iter().filter(|file| !is_markdown(file)) {
        put(&top.join(file), &to.join(file))?;
    }
    Ok(chapters.len())
}

/// Where a chapter lies in the book: what is no Markdown is a page that shows it, and a
/// README is the index of its folder.
fn page(path: &Path) -> PathBuf {
    match (is_markdown(path), path.ends_with("README.md")) {
        (false, _) => format!("{}.md", path.display()).into(),
        (true, true) => path.with_file_name("index.md"),
        (true, false) => path.to_path_buf(),
    }
}

fn is_markdown(path: &Path) -> bool {
    path.extension().is_some_and(|it| it == "md")
}

/// Copies a file, into a folder that need not be there yet.
fn put(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to.parent().context("a file lies in a folder")?)?;
    fs::copy(from, to).with_context(|| format!("cannot copy {}", from.display()))?;
    Ok(())
}

/// A link to a file.
struct Link {
    line: usize,
    text: String,
    to: String,
}

impl Link {
    /// What a link in `document` leads to, from the top.
    fn file(&self, top: &Path, document: &Path) -> Result<PathBuf> {
        let to = self.to.split('#').next().unwrap_or_default();
        let mut path = document.parent().unwrap_or(Path::new("")).to_path_buf();
        for part in Path::new(to).components() {
            match part {
                Component::ParentDir => {
                    path.pop();
                }
                part => path.push(part),
            }
        }
        if !top.join(&path).is_file() {
            bail!(
                "{}:{}: there is no file {}",
                document.display(),
                self.line,
                self.to
            );
        }
        Ok(path)
    }
}

/// The links and pictures of a document that lead to files.
fn links_in(text: &str) -> Vec<Link> {
    let mut links: Vec<Link> = Vec::new();
    for (event, place) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
        match event {
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                links.push(Link {
                    line: 1 + text[..place.start].matches('\n').count(),
                    text: String::new(),
                    to: dest_url.to_string(),
                });
            }
            Event::Text(word) => {
                if let Some(link) = links.last_mut().filter(|link| link.text.is_empty()) {
                    link.text = word.to_string();
                }
            }
            _ => {}
        }
    }
    links.retain(|link| !link.to.contains(':') && !link.to.starts_with('#'));
    links
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use super::lay_out;

    /// A project with one chapter beside its summary.
    fn project(name: &str, chapter: &str) -> PathBuf {
        let top = std::env::temp_dir().join(format!("book-{name}-{}", std::process::id()));
        fs::create_dir_all(top.join("docs")).unwrap();
        let summary = "[One](../ONE.md)\n\n- [Data](../data.txt)\n- [It](README.md)\n";
        fs::write(top.join("docs/SUMMARY.md"), summary).unwrap();
        fs::write(top.join("docs/README.md"), "# It\n").unwrap();
        fs::write(top.join("ONE.md"), chapter).unwrap();
        fs::write(top.join("data.txt"), "a\n").unwrap();
        top
    }

    fn read(path: &Path) -> String {
        fs::read_to_string(path).unwrap()
    }

    #[test]
    fn chapters_and_what_they_link_to_are_laid_out() {
        let text = "# One\n\nSee [the data](data.txt), [it](docs/README.md#it).\n";
        let top = project("whole", text);
        let to = top.join("out");
        assert_eq!(lay_out(&top, &to).unwrap(), 3);
        let summary = "[One](ONE.md)\n\n- [Data](data.txt.md)\n- [It](docs/index.md)\n";
        assert_eq!(read(&to.join("SUMMARY.md")), summary);
        assert_eq!(read(&to.join("data.txt")), "a\n");
        let page = "# Data\n\n```txt\na\n```\n";
        assert_eq!(read(&to.join("data.txt.md")), page);
        assert_eq!(read(&to.join("docs/index.md")), "# It\n");
        let one = read(&to.join("ONE.md"));
        assert!(one.contains("[it](docs/index.md#it)"), "{one}");
        fs::remove_dir_all(top).unwrap();
    }

    #[test]
    fn a_dead_link_is_named() {
        let top = project("dead", "# One\n\nSee [it](nowhere.txt).\n");
        let error = lay_out(&top, &top.join("out")).unwrap_err();
        assert_eq!(error.to_string(), "ONE.md:3: there is no file nowhere.txt");
        fs::remove_dir_all(top).unwrap();
    }
}
