//! Every test and check that ARCHITECTURE.md names exists.

use std::fs;
use std::path::Path;

/// Adds the text of every Rust source below a folder, but for what was built.
fn add_sources(folder: &Path, text: &mut String) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && !path.is_symlink() && name != "target" && !name.starts_with('.') {
            add_sources(&path, text);
        } else if name.ends_with(".rs") {
            text.push_str(&fs::read_to_string(&path).unwrap());
        }
    }
}

#[test]
fn what_keeps_an_invariant_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    let table = page.split("| kept by |").nth(1).expect("there is a table");
    let cells = table.lines().filter_map(|line| line.split(" | ").nth(1));
    let names = cells.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    let names: Vec<&str> = names.collect();
    assert!(names.len() > 20, "{names:?}");
    let mut sources = String::new();
    add_sources(root, &mut sources);
    for name in names {
        let is_test = sources.contains(&format!("fn {name}("));
        let is_check = sources.contains(&format!("        name: \"{name}\",\n"));
        assert!(is_test || is_check, "there is no test or check {name}");
    }
}
