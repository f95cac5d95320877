//! The page in a real browser. `cargo xtask test --only lab-web` builds it, installs the
//! browser and runs this.

mod browser;
mod site;

use std::path::Path;
use std::process::Command;

use browser::{Browser, serve};
use host_sim::chip::{Machine, Swarm};
use host_sim::run::{self, Options, heights, voxels};
use lab::playback::{Export, Playback};
use lab::setup::Setup;
use lab::survey::{SurveyScene, SurveySetup};
use serde_json::Value;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn page() -> String {
    let dist = root().join("dist");
    assert!(
        dist.join("lab.js").is_file(),
        "there is no page; `cargo xtask lab-web` builds it"
    );
    serve(dist)
}

/// The digest of a scenario as `host-sim explore` prints it.
fn on_host(address: &str) -> String {
    let scenario = Setup::from_address(address).unwrap().scenario().unwrap();
    let options = Options {
        trace: true,
        ..Options::default()
    };
    let (_, trace) = run::run(&scenario, options).unwrap();
    trace.unwrap().digest()
}

/// Runs a command that the lab offers for copying, and returns the digest that it
/// prints.
fn by_command(command: &str) -> String {
    let program = std::env::var_os("HOST_SIM");
    let program = program.expect("`cargo xtask test --only lab-web` names the simulator");
    let words = command.strip_prefix("cargo run --release -- ").unwrap();
    let out = tempfile::tempdir().unwrap();
    let output = Command::new(program)
        .current_dir(root())
        .args(words.split(' '))
        .args(["--json", "--out"])
        .arg(out.path().join("run"))
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    let summary: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{command}: {error}: {message}"));
    summary["trace_digest"].as_str().unwrap().to_owned()
}

/// The digest that the page tells when it has played an address to its end.
fn on_page(browser: &Browser, page: &str, address: &str) -> String {
    browser.open(&format!("{page}#{address}"));
    browser.wait("state", |state| {
        state == "complete" || state == "incomplete"
    });
    browser.data("digest")
}

#[test]
#[ignore = "needs the page, a browser and QEMU: cargo xtask test --only lab-web"]
fn one_scenario_has_one_digest_by_command_in_the_browser_and_on_chips() {
    let (page, browser) = (page(), Browser::start(1280, 800));
    for address in [
        "map=ward&robots=3&loss=0.3&delay=2&seed=5",
        "map=circle&planner=local-frontiers&robots=2&medium=ideal",
    ] {
        let command = Setup::from_address(address).unwrap().command();
        let here = by_command(&command);
        let chips = by_command(&command.replace(" explore ", " firmware "));
        assert_eq!(on_page(&browser, &page, address), here, "{address}");
        assert_eq!(chips, here, "{address}");
    }
    let address = "terrain=urban:3&size=40&robots=3&loss=0.2&seed=4";
    let setup = SurveySetup::from_address(address).unwrap();
    let here = by_command(&setup.command());
    let machine = Machine::Netduinoplus2;
    let swarm = Swarm::new(machine, root().join(machine.image()));
    let terrain = setup.terrain.load(setup.size).unwrap();
    let chips = heights::run_on(&swarm, &terrain, &setup.scenario()).unwrap();
    swarm.finish().unwrap();
    assert_eq!(on_page(&browser, &page, address), here, "{address}");
    assert_eq!(chips.digest(), here, "{address}");
    let address = "terrain=town:2&size=24&robots=3&range=6&loss=0.2&seed=4";
    let setup = SurveySetup::from_address(address).unwrap();
    let here = by_command(&setup.command());
    let image = root().join(machine.image()).with_file_name("voxels");
    let swarm = Swarm::new(machine, image);
    let town = setup.terrain.scene(setup.size).unwrap();
    let chips = voxels::run_on(&swarm, &town, &setup.voxel_scenario()).unwrap();
    swarm.finish().unwrap();
    assert_eq!(on_page(&browser, &page, address), here, "{address}");
    assert_eq!(chips.digest(), here, "{address}");
    for address in [
        "terrain=urban:3&size=40&robots=3&wind=0.2&come-home",
        "terrain=town:2&size=24&robots=3&clearance=2&range=6&sensor=camera&fov=100x60",
        "terrain=town:2&size=24&planner=greedy&clearance=0&range=6&wind=0.2",
        "terrain=town:2&size=24&range=6&false-walls=0.01&false-frees=0.01&preset=rangers",
    ] {
        let setup = SurveySetup::from_address(address).unwrap();
        let here = by_command(&setup.command());
        assert_eq!(on_page(&browser, &page, address), here, "{address}");
    }
    assert_eq!(browser.console(), [""; 0]);
}

#[test]
#[ignore = "needs the page and a browser: cargo xtask test --only lab-web"]
fn dropped_traces_of_surveys_are_played_or_refused_with_a_sentence() {
    let (page, browser) = (page(), Browser::start(1280, 800));
    browser.open(&page);
    browser.wait("state", |state| state == "running");
    browser.drop_file("trace.csv", b"tick,robot,x,y,z,work\n0,0,2,2,2,9\n");
    let error = browser.wait("error", |error| !error.is_empty());
    assert!(error.contains("open the trace.csv"), "{error}");
    for (address, map) in [
        ("terrain=urban:3&size=24&robots=2", "urban-3"),
        ("terrain=town:2&size=24&robots=2&range=6", "town-2"),
    ] {
        let mut flown = SurveyScene::new(SurveySetup::from_address(address).unwrap()).unwrap();
        while flown.tick() {}
        browser.drop_file("trace.csv", &flown.export(Export::Trace).unwrap().1);
        browser.wait("map", |name| name == map);
        browser.wait("state", |state| state == "complete");
        assert_eq!(Some(browser.data("digest")), flown.digest(), "{address}");
        assert_eq!(browser.data("ticks"), flown.ticks().to_string());
        assert_eq!(browser.data("error"), "");
    }
    assert_eq!(browser.console(), [""; 0]);
}

#[test]
#[ignore = "needs the page and a browser: cargo xtask test --only lab-web"]
fn the_page_explores_as_the_host_does() {
    let (page, browser) = (page(), Browser::start(1280, 800));

    // The default scenario plays by itself, to its end.
    browser.open(&page);
    browser.wait("state", |state| state == "running" || state == "complete");
    browser.wait("state", |state| state == "complete");
    assert_eq!(browser.data("digest"), on_host(""));

    // An address is the scenario; the same digest here and there.
    for address in [
        "map=generate:rooms:40x30:5&robots=4&start=corner&loss=0.3&seed=3&kill=2@25",
        "map=circle&planner=minpos&medium=ideal&robots=2&solid",
        "map=generate:cave:70x50:2&planner=local-frontiers&robots=3&radio-range=12",
    ] {
        assert_eq!(
            on_page(&browser, &page, address),
            on_host(address),
            "{address}"
        );
    }
    assert_eq!(browser.console(), [""; 0]);
}

#[test]
#[ignore = "needs the page and a browser: cargo xtask test --only lab-web"]
fn dropped_maps_are_explored_or_refused_with_a_sentence() {
    let (page, browser) = (page(), Browser::start(1280, 800));
    browser.open(&page);
    browser.wait("state", |state| state == "running");

    browser.drop_file("bad.txt", b"....\n..\n");
    let error = browser.wait("error", |error| !error.is_empty());
    assert!(
        error.starts_with("bad.txt") && error.contains("equally long"),
        "{error}"
    );
    assert_eq!(browser.data("map"), "office");

    browser.drop_file(
        "tiny.txt",
        b"##########\n#1.......#\n#.##.###.#\n#........#\n##########\n",
    );
    browser.wait("map", |map| map == "tiny");
    browser.wait("state", |state| state == "complete");
    assert_eq!(browser.data("error"), "");
    assert_eq!(browser.console(), [""; 0]);
}

#[test]
#[ignore = "needs the page and a browser: cargo xtask test --only lab-web"]
fn a_bad_address_says_so() {
    let (page, browser) = (page(), Browser::start(400, 800));
    for address in ["robots=many", "terrain=urban:1&robots=many"] {
        browser.open(&format!("{page}#{address}"));
        let error = browser.wait("error", |error| !error.is_empty());
        assert!(error.contains("robots=many"), "{error}");
    }
    assert_eq!(browser.console(), [""; 0]);
}

/// 100 robots on 256×256 cells: frames a second in the browser, one tick in each. A
/// picture of the page is left in `target/`.
#[test]
#[ignore = "a measurement: cargo test -p lab --test page -- --ignored --nocapture crowd"]
fn crowd() {
    let (page, browser) = (page(), Browser::start(1280, 800));
    browser.open(&format!(
        "{page}#map=generate:rooms:256x256:1&robots=100&start=random"
    ));
    let mut rates = Vec::new();
    browser.wait("state", |state| state == "running");
    for _ in 0..10 {
        std::thread::sleep(std::time::Duration::from_secs(2));
        rates.push(format!(
            "{} at tick {}",
            browser.data("frames-per-second"),
            browser.data("ticks")
        ));
    }
    println!("frames a second: {}", rates.join(", "));
}

/// Pictures of the page, for whoever wants to look at them, in `target/`.
#[test]
#[ignore = "for the eye: cargo test -p lab --test page -- --ignored pictures"]
fn pictures() {
    let page = page();
    let folder = root().join("target");
    for (name, width, height) in [("laptop", 1280, 800), ("phone", 400, 800)] {
        let browser = Browser::start(width, height);
        browser.open(&page);
        browser.wait("ticks", |ticks| {
            ticks.parse().is_ok_and(|ticks: u32| ticks > 250)
        });
        let file = folder.join(format!("page-{name}.png"));
        std::fs::write(file, browser.picture()).unwrap();
    }
}
