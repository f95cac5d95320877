//! Links between the pages of the site, and to places within them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Result, bail};

/// Folders whose own links are looked at by what makes them.
const OTHERS: [&str; 2] = ["api", "lab"];

/// Checks every link of the site's pages that stays within the site; returns how many there
/// are.
///
/// # Errors
/// All that lead nowhere.
pub(super) fn check(site: &Path) -> Result<usize> {
    let mut pages = Vec::new();
    find_pages(site, Path::new(""), &mut pages)?;
    let mut places: BTreeMap<PathBuf, BTreeSet<String>> = BTreeMap::new();
    let mut links = Vec::new();
    for page in pages {
        let text = fs::read_to_string(site.join(&page))?;
        let (here, away): (Vec<_>, Vec<_>) = attributes(&text)
            .into_iter()
            .partition(|(name, _)| matches!(*name, "id" | "name"));
        links.extend(away.into_iter().map(|(_, link)| (page.clone(), link)));
        places.insert(page, here.into_iter().map(|(_, place)| place).collect());
    }
    links.retain(|(_, link)| !link.contains(':'));
    let dead: Vec<String> = links
        .iter()
        .filter(|(page, link)| !leads_somewhere(site, &places, page, link))
        .map(|(page, link)| format!("{}: {link}", page.display()))
        .collect();
    if !dead.is_empty() {
        bail!("links lead nowhere:\n{}", dead.join("\n"));
    }
    Ok(links.len())
}

fn find_pages(site: &Path, folder: &Path, pages: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(site.join(folder))? {
        let entry = entry?;
        let path = folder.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            if !OTHERS.iter().any(|other| path == Path::new(other)) {
                find_pages(site, &path, pages)?;
            }
        } else if path.extension().is_some_and(|it| it == "html") {
            pages.push(path);
        }
    }
    pages.sort();
    Ok(())
}

fn leads_somewhere(
    site: &Path,
    places: &BTreeMap<PathBuf, BTreeSet<String>>,
    page: &Path,
    link: &str,
) -> bool {
    let (file, place) = link.split_once('#').unwrap_or((link, ""));
    let mut path = page.to_path_buf();
    if !file.is_empty() {
        path.pop();
        for part in Path::new(file).components() {
            match part {
                // Above the site is nothing.
                Component::ParentDir if !path.pop() => return false,
                Component::ParentDir => {}
                part => path.push(part),
            }
        }
    }
    let is_there = site.join(&path).is_file();
    // In pages of others, places are not looked for.
    let has_place = places.get(&path).is_none_or(|it| it.contains(place));
    is_there && (place.is_empty() || has_place)
}

/// The attributes of a page that name places or lead to them.
fn attributes(html: &str) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    // Scripts hold no links, but much that looks like some.
    for part in html.split("<script").enumerate().map(|(number, part)| {
        let end = part.find("</script>").filter(|_| number > 0);
        &part[end.unwrap_or(0)..]
    }) {
        for name in ["id", "name", "href", "src"] {
            let begin = format!(" {name}=\"");
            let pieces = part.split(begin.as_str()).skip(1);
            let values = pieces.filter_map(|piece| piece.split('"').next());
            found.extend(values.map(|value| (name, value.replace("&amp;", "&"))));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::{attributes, check};

    #[test]
    fn links_are_found_outside_of_scripts() {
        let html = r#"<p id="here"><a class="x" href="a&amp;b.html#c">x</a><script src="s.js">'<a href="no">'</script><img src="p.png">"#;
        let expected = [("id", "here"), ("href", "a&b.html#c"), ("src", "p.png")];
        assert_eq!(
            attributes(html),
            expected.map(|(name, value)| (name, value.to_owned()))
        );
    }

    #[test]
    fn dead_links_and_places_are_named() {
        let site = std::env::temp_dir().join(format!("links-{}", std::process::id()));
        fs::create_dir_all(site.join("in")).unwrap();
        let index =
            r##"<a href="in/a.html#x">1</a> <a href="https://b.c/">2</a> <a href="#y">3</a>"##;
        fs::write(site.join("index.html"), index).unwrap();
        let inner = r#"<p id="x"></p> <a href="../index.html">1</a> <a href="b.html">2</a>"#;
        fs::write(site.join("in/a.html"), inner).unwrap();
        let error = check(&site).unwrap_err().to_string();
        fs::remove_dir_all(&site).unwrap();
        assert_eq!(
            error,
            "links lead nowhere:\nin/a.html: b.html\nindex.html: #y"
        );
    }
}
