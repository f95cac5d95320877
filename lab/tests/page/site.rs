//! The site that `cargo xtask site` builds, wide and narrow.

use serde_json::json;

use crate::browser::{Browser, serve};
use crate::root;

/// Pages of every kind: with pictures, tables, code, and what is no Markdown.
const PAGES: [&str; 7] = [
    "index.html",
    "book/index.html",
    "book/docs/porting.html",
    "book/docs/budgets.html",
    "book/docs/formats.html",
    "book/c-api/include/planner.h.html",
    "api/planner_core/index.html",
];

#[test]
#[ignore = "needs the site and a browser: cargo xtask test --only site"]
fn the_site_fits_the_screen_and_has_no_complaints() {
    let folder = root().join("site");
    assert!(
        folder.join("book/index.html").is_file(),
        "there is no site; `cargo xtask site` builds it"
    );
    let site = serve(folder);
    let pictures = root().join("target/site");
    std::fs::create_dir_all(&pictures).unwrap();
    let browser = Browser::start(1280, 800);
    for width in [1280, 390] {
        browser.set_screen(width, 800);
        for page in PAGES {
            browser.open(&format!("{site}{page}"));
            let name = page.replace('/', "-").replace(".html", "");
            let file = pictures.join(format!("{name}-{width}.png"));
            std::fs::write(file, browser.picture()).unwrap();
            let content = browser.run("return document.documentElement.scrollWidth", json!([]));
            assert!(
                content.as_u64().unwrap() <= u64::from(width),
                "{page} is {content} wide on a screen of {width}"
            );
        }
    }
    assert_eq!(browser.console(), [""; 0]);
}
