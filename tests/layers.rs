//! Which module may import which: ARCHITECTURE.md's rule, read from the sources.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The modules of planner-core, ground first. A module imports those of the lines above
/// its own: so the planners, in the last one, do not know each other.
const PLANNER_CORE: &[&[&str]] = &[
    &["cell", "list", "logging", "math", "zeroed"],
    &["point", "rng", "robot", "tile"],
    &["cao", "role", "sight", "surface"],
    &["map", "volume"],
    &["radio"],
    &["planner", "survey"],
    &[
        "coordinated_survey",
        "explorer",
        "fcao",
        "local_frontiers",
        "voxel_survey",
    ],
];

/// A module, as the names from the root of its crate.
type Module = Vec<String>;

/// What each module of a crate imports from its own crate. Tests are left out.
struct Imports(BTreeMap<Module, BTreeSet<Module>>);

impl Imports {
    fn of(package: &str) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join(package)
            .join("src");
        let mut files = Vec::new();
        collect(&root, &mut files);
        let sources: BTreeMap<Module, String> = files
            .iter()
            .map(|file| {
                let module = module_of(file.strip_prefix(&root).unwrap());
                (module, code_of(&fs::read_to_string(file).unwrap()))
            })
            .collect();
        let of = |(module, source): (&Module, &String)| {
            let known = |path: &Module| {
                let mut path = path.clone();
                while !path.is_empty() && !sources.contains_key(&path) {
                    path.pop();
                }
                path
            };
            let imported = paths_of(source, module).iter().map(known).collect();
            (module.clone(), imported)
        };
        Self(sources.iter().map(of).collect())
    }

    /// What the parts of a folder import of each other; the root is the folder without
    /// a name.
    fn within(&self, folder: &[String]) -> BTreeMap<&str, BTreeSet<&str>> {
        let part = |module: &'_ Module| -> Option<usize> {
            (module.starts_with(folder) && module.len() > folder.len()).then_some(folder.len())
        };
        let mut parts: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for (module, imported) in &self.0 {
            let Some(at) = part(module) else { continue };
            let entry = parts.entry(&module[at]).or_default();
            let others = imported.iter().filter(|other| part(other).is_some());
            entry.extend(
                others
                    .map(|other| other[at].as_str())
                    .filter(|name| *name != module[at]),
            );
        }
        parts
    }

    /// The circles among the parts of a folder, each as a way round.
    fn circles_in(&self, folder: &[String]) -> Vec<String> {
        let parts = self.within(folder);
        let circles = parts.keys().filter_map(|part| circle_from(part, &parts));
        circles
            .map(|circle| format!("{}: {}", folder.join("::"), circle.join(" → ")))
            .collect()
    }

    /// The circles of modules, but for those of a folder and its own files.
    fn circles(&self) -> Vec<String> {
        let folders: BTreeSet<&[String]> = self
            .0
            .keys()
            .flat_map(|module| (0..module.len()).map(|end| &module[..end]))
            .collect();
        folders
            .iter()
            .flat_map(|folder| self.circles_in(folder))
            .collect()
    }
}

/// The shortest way from a part back to it.
fn circle_from<'a>(
    start: &'a str,
    parts: &BTreeMap<&'a str, BTreeSet<&'a str>>,
) -> Option<Vec<&'a str>> {
    let mut ways = std::collections::VecDeque::from([vec![start]]);
    let mut seen = BTreeSet::new();
    while let Some(way) = ways.pop_front() {
        for &next in parts.get(way.last()?)? {
            let longer = [way.as_slice(), &[next]].concat();
            if next == start {
                return Some(longer);
            }
            if seen.insert(next) {
                ways.push_back(longer);
            }
        }
    }
    None
}

/// The Rust files of a folder, without those of tests.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.file_stem().and_then(|stem| stem.to_str()) {
            Some("tests" | "lib" | "main") => {}
            _ if path.is_dir() => collect(&path, files),
            _ if path.extension().is_some_and(|end| end == "rs") => files.push(path),
            _ => {}
        }
    }
}

fn module_of(file: &Path) -> Module {
    let names = file.with_extension("");
    let names = names.iter().map(|name| name.to_str().unwrap().to_owned());
    names.filter(|name| name != "mod").collect()
}

/// The source without comments, texts and tests.
fn code_of(source: &str) -> String {
    let lines = source.lines().map(|line| line.split("//").next().unwrap());
    let code = lines.collect::<Vec<_>>().join("\n");
    code.split("#[cfg(test)]\nmod tests {")
        .next()
        .unwrap()
        .to_owned()
}

/// The modules and items that `crate::…` and `super::…` name in the source of a module.
fn paths_of(source: &str, module: &Module) -> Vec<Module> {
    let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut paths = Vec::new();
    for (at, _) in source.match_indices("::") {
        let before = source[..at].trim_end_matches(is_name);
        let first = &source[before.len()..at];
        let base: &[String] = match first {
            _ if before.ends_with("::") => continue,
            "crate" => &[],
            "super" => &module[..module.len().saturating_sub(1)],
            _ => continue,
        };
        tree(&source[at + 2..], base.to_vec(), &mut paths);
    }
    paths
}

/// Reads a path, or several in braces, that begin behind `base`; returns what is behind.
fn tree<'a>(source: &'a str, base: Module, paths: &mut Vec<Module>) -> &'a str {
    let source = source.trim_start();
    if let Some(mut rest) = source.strip_prefix('{') {
        loop {
            rest = tree(rest, base.clone(), paths).trim_start();
            rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
            if rest.is_empty() || rest.starts_with('}') {
                return rest.get(1..).unwrap_or("");
            }
        }
    }
    let end = source.find(|letter: char| !letter.is_alphanumeric() && letter != '_');
    let (name, rest) = source.split_at(end.unwrap_or(source.len()));
    let mut path = base;
    match name {
        "super" => drop(path.pop()),
        "self" | "" => {}
        _ => path.push(name.to_owned()),
    }
    match rest.strip_prefix("::") {
        Some(deeper) => tree(deeper, path, paths),
        None => {
            paths.push(path);
            // Behind `name as other`, or an item that no module's path goes on from.
            let end = rest
                .find([',', '}', ';', '(', '{', ')'])
                .unwrap_or(rest.len());
            &rest[end..]
        }
    }
}

#[test]
fn modules_of_the_core_import_those_beneath_them() {
    let imports = Imports::of("planner-core");
    let mut parts = imports.within(&[]);
    let mut beneath = BTreeSet::new();
    for layer in PLANNER_CORE {
        for module in *layer {
            let imported = parts
                .remove(module)
                .unwrap_or_else(|| panic!("no module {module}"));
            let above: Vec<_> = imported.difference(&beneath).collect();
            assert!(
                above.is_empty(),
                "{module} imports {above:?}, which stand not beneath it"
            );
        }
        beneath.extend(layer.iter().copied());
    }
    assert!(parts.is_empty(), "in no layer: {:?}", parts.keys());
}

#[test]
fn modules_do_not_go_round_in_circles() {
    let core = Imports::of("planner-core").circles();
    let simulator = Imports::of("host-sim").circles_in(&[]);
    let circles = [core, simulator].concat();
    assert!(circles.is_empty(), "circles:\n{}", circles.join("\n"));
}

/// The reader itself: braces within braces, paths in code, comments, tests.
#[test]
fn paths_are_found_wherever_they_stand() {
    let source = "use crate::a::{B, c::{D, self}};\n// crate::no\nuse super::e;\n\
        fn f() { crate::g::h(super::super::i); }\n#[cfg(test)]\nmod tests {\n use crate::j; }";
    let module = ["x", "y"].map(str::to_owned).to_vec();
    let found: BTreeSet<String> = paths_of(&code_of(source), &module)
        .iter()
        .map(|path| path.join("::"))
        .collect();
    let expected = ["a::B", "a::c::D", "a::c", "x::e", "g::h", "i"];
    assert_eq!(found, expected.map(str::to_owned).into());
}
