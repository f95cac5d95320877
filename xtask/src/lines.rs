//! How much code there is.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use crate::shell::{self, command};

/// Prints the lines of code of every package below a folder, and of all: as rustfmt
/// sets them, without comments, blank lines and tests.
pub(crate) fn print(folder: &Path) -> Result<()> {
    let folder = shell::root().join(folder);
    let mut lines = BTreeMap::new();
    count(&folder, "", &mut lines)?;
    for (package, lines) in &lines {
        println!("{lines:>7} {package}");
    }
    println!("{:>7} in all", lines.values().sum::<usize>());
    Ok(())
}

/// Adds the lines of a folder, which belong to `package` unless it is one itself.
fn count(folder: &Path, package: &str, lines: &mut BTreeMap<String, usize>) -> Result<()> {
    let name = match folder.join("Cargo.toml").is_file() {
        true => folder
            .strip_prefix(shell::root())
            .unwrap_or(folder)
            .display()
            .to_string(),
        false => package.to_owned(),
    };
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry?;
        let (path, file) = (entry.path(), entry.file_name());
        match file.to_str() {
            Some("target" | "tests" | "tests.rs" | "dist") => {}
            Some(hidden) if hidden.starts_with('.') => {}
            Some(_) if entry.file_type()?.is_dir() => count(&path, &name, lines)?,
            Some(source) if source.ends_with(".rs") => {
                *lines.entry(name.clone()).or_default() += of_file(&path)?;
            }
            _ => {}
        }
    }
    Ok(())
}

fn of_file(path: &Path) -> Result<usize> {
    let formatted = command("rustfmt")
        .args([
            "--edition=2024",
            "--emit=stdout",
            "--quiet",
            "--config=skip_children=true",
        ])
        .arg(path)
        .output()?;
    of_source(&formatted.stdout).with_context(|| path.display().to_string())
}

fn of_source(source: &str) -> Result<usize> {
    let tokens: TokenStream = source.parse().map_err(|error| anyhow!("{error}"))?;
    let mut lines = BTreeSet::new();
    mark(tokens, &mut lines);
    Ok(lines.len())
}

/// Marks the lines that hold code, by their tokens.
fn mark(tokens: TokenStream, lines: &mut BTreeSet<usize>) {
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let is =
            |token: &TokenTree, mark| matches!(token, TokenTree::Punct(it) if it.as_char() == mark);
        let attribute = if is(&token, '#') {
            tokens.next_if(|next| is(next, '!'));
            tokens.peek().map_or_else(String::new, inside)
        } else {
            String::new()
        };
        // A comment that documents what follows.
        if attribute.starts_with("doc =") {
            tokens.next();
            continue;
        }
        if attribute == "cfg (test)" || attribute.starts_with("cfg (all (test") {
            tokens.next();
            // Other attributes, then the item, to its semicolon or its last brace.
            let ends = |token: &TokenTree| match token {
                TokenTree::Punct(mark) => mark.as_char() == ';',
                TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
                _ => false,
            };
            tokens.find(ends);
            continue;
        }
        match token {
            TokenTree::Group(group) => of_group(&group, lines),
            token => {
                let span = token.span();
                lines.extend(span.start().line..=span.end().line);
            }
        }
    }
}

/// What stands in brackets.
fn inside(token: &TokenTree) -> String {
    match token {
        TokenTree::Group(group) => group.stream().to_string(),
        _ => String::new(),
    }
}

fn of_group(group: &Group, lines: &mut BTreeSet<usize>) {
    lines.insert(group.span_open().start().line);
    mark(group.stream(), lines);
    lines.insert(group.span_close().end().line);
}

#[cfg(test)]
mod tests {
    #[test]
    fn only_code_counts() {
        let source = r#"//! A module.

/// A function, with
/// two lines of words.
fn one() -> &'static str {
    // Nothing.
    "two
lines"
}

#[cfg(test)]
#[expect(unused)]
mod tests {
    fn nothing() {}
}

/* of
no use */
const A: u8 = 1;
"#;
        assert_eq!(super::of_source(source).unwrap(), 5);
    }
}
