//! What is cited has an entry in docs/bibliography.md, and every entry is cited.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The files of a folder that may cite, but those that were built.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            if name != "target" && !name.starts_with('.') {
                collect(&path, files);
            }
        } else if name.ends_with(".rs") || name.ends_with(".md") {
            files.push(path);
        }
    }
}

/// Whether a word is an author and a year: `Gauville2019`.
fn is_key(word: &str) -> bool {
    let author = word.trim_end_matches(|letter: char| letter.is_ascii_digit());
    word.len() == author.len() + 4
        && author.len() >= 3
        && author.chars().all(char::is_alphabetic)
        && author.starts_with(char::is_uppercase)
}

/// The keys in brackets: `[Andries2015; Gauville2019 §2.2]`.
fn keys_in(text: &str) -> impl Iterator<Item = &str> {
    let brackets = text.split('[').skip(1);
    let cited = brackets.filter_map(|rest| rest.split_once(']').map(|(cited, _)| cited));
    let words = cited.flat_map(|cited| cited.split([';', ' ', ',', '\\', '\n']));
    words.filter(|word| is_key(word))
}

#[test]
fn what_is_cited_has_an_entry_and_every_entry_is_cited() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let list = root.join("docs/bibliography.md");
    let text = fs::read_to_string(&list).unwrap();
    let rows = text.lines().filter_map(|line| line.strip_prefix("| "));
    let entries = rows.filter_map(|row| row.split_once(" | "));
    let entries: BTreeMap<_, _> = entries.filter(|(key, _)| is_key(key)).collect();
    assert!(entries.len() > 10, "{entries:?}");
    for (key, entry) in &entries {
        let year = &key[key.len() - 4..];
        assert!(entry.contains(year), "{key} is of another year: {entry}");
    }
    let keys: Vec<_> = entries.keys().collect();
    assert!(keys.is_sorted());
    assert_eq!(
        entries.len(),
        text.matches("\n| ").count() - 1,
        "twice, or no key"
    );

    let mut files = Vec::new();
    collect(root, &mut files);
    let mut cited = BTreeSet::new();
    for file in files.iter().filter(|file| **file != list) {
        let text = fs::read_to_string(file).unwrap();
        for key in keys_in(&text) {
            let file = file.strip_prefix(root).unwrap().display();
            assert!(entries.contains_key(key), "{file}: [{key}] has no entry");
            cited.insert(key.to_owned());
        }
    }
    let idle: Vec<_> = keys
        .into_iter()
        .filter(|key| !cited.contains(**key))
        .collect();
    assert!(idle.is_empty(), "nobody cites {idle:?}");
}
