//! The lab's window without a screen: widgets are found and used by their names, and
//! reviewed pictures of the screen are compared. `UPDATE_SNAPSHOTS=1` writes them anew;
//! look at them before you commit them.

mod painter;

use egui::{Key, Theme, vec2};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, SnapshotOptions};
use host_sim::run::{heights, voxels as among_voxels};
use host_sim::scenario::heights::{Planner, Scenario};
use host_sim::scenario::voxels;
use host_sim::terrain::TerrainSource;
use lab::App;
use lab::playback::{Export, Playback};
use lab::survey::Rival;
use painter::Painter;

fn harness(address: &str, width: f32, height: f32, theme: Theme) -> Harness<'static, App> {
    let mut app = App::from_address(address);
    app.playing = false;
    Harness::builder()
        .with_size(vec2(width, height))
        .with_theme(theme)
        .with_max_steps(50)
        .renderer(Painter::default())
        .build_ui_state(|ui, app: &mut App| app.ui(ui), app)
}

fn play(harness: &mut Harness<'static, App>, ticks: u32) {
    for _ in 0..ticks {
        harness.state_mut().tick();
    }
    harness.run();
}

fn compare(harness: &mut Harness<'static, App>, name: &str) {
    let picture = harness.render().unwrap();
    // Fonts are laid out with floats: an edge may fall the other way elsewhere.
    let options = SnapshotOptions::new().threshold(2.0).max_failed_pixels(400);
    egui_kittest::image_snapshot_options(&picture, name, &options);
}

#[test]
fn laptop_in_the_light() {
    let mut harness = harness("", 1280.0, 800.0, Theme::Light);
    harness.state_mut().layers.trail = 10_000;
    play(&mut harness, 300);
    compare(&mut harness, "laptop-light");
}

#[test]
fn laptop_in_the_dark_with_a_robot_selected() {
    let mut harness = harness(
        "map=generate:cave:64x48:4&robots=5&loss=0.3&delay=2",
        1280.0,
        800.0,
        Theme::Dark,
    );
    harness.state_mut().selected = Some(1);
    harness.state_mut().layers.owners = true;
    harness.state_mut().layers.radio = true;
    play(&mut harness, 120);
    compare(&mut harness, "laptop-dark");
}

#[test]
fn a_misled_robot_with_its_votes() {
    let address = "map=generate:rooms:48x36:4&robots=2&preset=rangers&false-walls=0.05\
                   &false-frees=0.02&people=2";
    let mut harness = harness(address, 1280.0, 800.0, Theme::Light);
    harness.state_mut().selected = Some(0);
    harness.state_mut().layers.votes = true;
    play(&mut harness, 150);
    compare(&mut harness, "misled");
}

#[test]
fn a_crowd_on_a_large_map() {
    let address = "map=generate:rooms:256x256:1&robots=100&start=random";
    let mut harness = harness(address, 1280.0, 800.0, Theme::Light);
    play(&mut harness, 100);
    compare(&mut harness, "crowd");
}

#[test]
fn phone() {
    let mut harness = harness("map=circle&robots=2", 390.0, 780.0, Theme::Light);
    play(&mut harness, 25);
    compare(&mut harness, "phone");
    harness.get_by_label("Setup").click();
    harness.run();
    compare(&mut harness, "phone-setup");
}

#[test]
fn hills_from_above() {
    let mut harness = harness("", 1280.0, 800.0, Theme::Dark);
    // No step but those that are asked for.
    harness.state_mut().speed = 0.0;
    harness.get_by_label("3-D survey").click();
    harness.run_steps(2);
    harness.state_mut().playing = false;
    harness.state_mut().speed = 60.0;
    let shown = harness.state().shown_tick();
    play(&mut harness, 60 - shown);
    compare(&mut harness, "survey");
}

#[test]
fn a_survey_on_a_phone() {
    let mut harness = harness("terrain=urban:3&size=40", 390.0, 780.0, Theme::Light);
    play(&mut harness, 40);
    compare(&mut harness, "phone-survey");
}

#[test]
fn a_town_of_voxels_is_chosen_looked_into_and_shared() {
    let address = "terrain=urban:1&size=40&robots=3";
    let mut harness = harness(address, 1280.0, 800.0, Theme::Light);
    harness.run();
    harness.get_by_label("town with rooms").click();
    harness.step();
    harness.state_mut().playing = false;
    let shown = harness.state().shown_tick();
    play(&mut harness, 150 - shown);
    harness.state_mut().survey_layers.levels = 12;
    harness.run();
    compare(&mut harness, "town");
    let setup = harness.state().survey().unwrap().setup.clone();
    assert!(setup.is_of_voxels());
    assert_eq!(copied(&mut harness, "Copy command"), setup.command());
    let address = "#terrain=town:1&size=40&robots=3";
    assert_eq!(copied(&mut harness, "Copy address"), address);
}

/// The field of the selected drone's camera is drawn as it is turned; on a phone, those of
/// all.
#[test]
fn cameras_in_a_town_of_voxels() {
    let address = "terrain=town:1&size=40&robots=3&sensor=camera";
    let mut laptop = harness(address, 1280.0, 800.0, Theme::Dark);
    laptop.state_mut().selected = Some(1);
    laptop.state_mut().survey_layers.levels = 12;
    play(&mut laptop, 150);
    compare(&mut laptop, "camera");
    laptop.get_by_label("turned to the");
    assert_eq!(copied(&mut laptop, "Copy address"), format!("#{address}"));
    let mut phone = harness(address, 390.0, 780.0, Theme::Light);
    play(&mut phone, 150);
    compare(&mut phone, "phone-camera");
}

/// What the menus cannot set is shown as it was flown.
#[test]
fn a_trace_beyond_the_menus_is_not_flown_anew() {
    let mut scenario = Scenario::new(Planner::ClosestFrontier, 40, 0);
    scenario.limits.ceiling = 80.0;
    scenario.limits.range = 9.5;
    let terrain = TerrainSource::Urban(3).load(30).unwrap();
    let trace = heights::run(&terrain, &scenario).unwrap();
    let mut scene = TerrainSource::Town(1).scene(16).unwrap();
    scene = scene.named("elsewhere");
    let town = among_voxels::run(&scene, &voxels::Scenario::new(2, 0)).unwrap();
    let (mut file, mut other) = (Vec::new(), Vec::new());
    trace.write(&mut file).unwrap();
    town.write(&mut other).unwrap();
    for (file, digest) in [(file, trace.digest()), (other, town.digest())] {
        let mut harness = harness("map=circle", 1280.0, 900.0, Theme::Light);
        harness.state_mut().open("trace.csv", &file);
        harness.state_mut().playing = false;
        harness.run();
        let report = harness.state().report();
        assert_eq!((report.error.as_str(), report.digest), ("", digest));
        assert!(harness.state().survey().unwrap().is_replay());
    }
}

#[test]
fn traces_of_surveys_are_dropped_played_and_scrubbed() {
    for address in [
        "terrain=urban:3&size=24&robots=2",
        "terrain=town:2&size=24&range=6",
    ] {
        let mut flown = App::from_address(address);
        while flown.tick() {}
        let survey = flown.survey().unwrap();
        let (_, file) = survey.export(Export::Trace).unwrap();
        let steps = survey.ticks();
        let mut harness = harness("map=circle", 1280.0, 900.0, Theme::Light);
        harness.state_mut().open("trace.csv", &file);
        assert_eq!(harness.state().report().error, "");
        harness.state_mut().playing = false;
        harness.run();
        let state = harness.state();
        assert_eq!((state.shown_tick(), state.last_tick()), (0, steps));
        harness.get_by_label(&format!("trace digest {}", flown.report().digest));
        harness.get_by_label("Tick").click();
        harness.run();
        assert_eq!(harness.state().shown_tick(), 1);
        harness.key_press(Key::End);
        harness.run();
        assert_eq!(harness.state().shown_tick(), steps);
        harness.get_by_label_contains(": complete");
        assert_eq!(copied(&mut harness, "Copy address"), format!("#{address}"));
        harness.get_by_label("Restart").click();
        harness.step();
        let state = harness.state();
        assert!(state.playing && state.survey().unwrap().is_replay());
    }
}

/// Clicks a button, and returns what it has put on the clipboard.
fn copied(harness: &mut Harness<'static, App>, button: &str) -> String {
    // What the last click has changed moves the buttons.
    harness.run();
    harness.get_by_label(button).scroll_to_me();
    harness.run();
    harness.get_by_label(button).click();
    for _ in 0..4 {
        harness.step();
        for command in &harness.output().platform_output.commands {
            if let egui::OutputCommand::CopyText(text) = command {
                return text.clone();
            }
        }
    }
    panic!("{button} copies nothing");
}

#[test]
fn a_survey_comes_by_address_is_gone_back_through_and_shared() {
    let address = "terrain=urban:3&size=24&robots=2";
    let mut harness = harness(address, 1280.0, 800.0, Theme::Light);
    play(&mut harness, 12);
    for (key, shown) in [
        (Key::ArrowLeft, 11),
        (Key::Home, 0),
        (Key::ArrowRight, 1),
        (Key::End, 12),
    ] {
        harness.key_press(key);
        harness.run();
        let state = harness.state();
        assert_eq!((state.shown_tick(), state.last_tick()), (shown, 12));
    }
    let setup = harness.state().survey().unwrap().setup.clone();
    assert_eq!(copied(&mut harness, "Copy command"), setup.command());
    assert_eq!(copied(&mut harness, "Copy address"), format!("#{address}"));
    while harness.state_mut().tick() {}
    harness.run();
    let report = harness.state().report();
    assert_eq!(report.state, "complete");
    harness.get_by_label(&format!("trace digest {}", report.digest));
}

#[test]
fn an_exploration_is_shared() {
    let address = "map=circle&robots=2&delay=1";
    let mut harness = harness(address, 1280.0, 1000.0, Theme::Light);
    harness.run();
    let setup = harness.state().setup.clone();
    assert_eq!(copied(&mut harness, "Copy command"), setup.command());
    assert_eq!(copied(&mut harness, "Copy address"), format!("#{address}"));
}

#[test]
fn two_planners_side_by_side() {
    let mut harness = harness("map=labyrinth1&robots=3", 1280.0, 800.0, Theme::Light);
    let setup = harness.state().setup.clone();
    harness.state_mut().rival = Some(host_sim::planners::PlannerKind::LocalFrontiers);
    harness.state_mut().set(setup);
    play(&mut harness, 200);
    compare(&mut harness, "side-by-side");
}

/// Two sensors in one town, and two planners over one terrain, go in step: one plot has both
/// curves, and the wheel and the pointer turn both.
#[test]
fn surveys_side_by_side() {
    let address = "terrain=town:1&size=40&robots=3";
    let mut laptop = harness(address, 1280.0, 800.0, Theme::Light);
    laptop.state_mut().survey_layers.levels = 12;
    laptop.run();
    choose(&mut laptop, "compare with", "camera");
    let shown = laptop.state().shown_tick();
    play(&mut laptop, 100 - shown);
    compare(&mut laptop, "surveys-side-by-side");
    let titles = |app: &App| -> Vec<String> {
        let players = app.players().into_iter();
        players.map(|player| player.title()).collect()
    };
    let expected = ["voxel-survey", "voxel-survey, camera"];
    assert_eq!(titles(laptop.state()), expected);
    assert_eq!(copied(&mut laptop, "Copy address"), format!("#{address}"));
    laptop.run();
    // Over hills there is no camera to compare with.
    laptop.get_by_label("hills").click();
    laptop.step();
    assert_eq!(titles(laptop.state()), ["coordinated-survey"]);
    laptop.run_steps(2);
    choose(&mut laptop, "compare with", "greedy");
    assert_eq!(titles(laptop.state()), ["coordinated-survey", "greedy"]);
    choose(&mut laptop, "compare with", "nothing");
    assert_eq!(titles(laptop.state()), ["coordinated-survey"]);

    let address = "terrain=urban:3&size=40";
    let mut phone = harness(address, 390.0, 780.0, Theme::Dark);
    let setup = phone.state().survey().unwrap().setup.clone();
    let greedy = host_sim::scenario::heights::Planner::Greedy;
    phone.state_mut().survey_rival = Some(Rival::OverHeights(greedy));
    phone.state_mut().fly(setup);
    phone.state_mut().playing = false;
    play(&mut phone, 40);
    compare(&mut phone, "phone-side-by-side");
}

/// Chooses from a menu, and pauses what begins anew.
fn choose(harness: &mut Harness<'static, App>, menu: &str, item: &str) {
    harness.get_by_label(menu).click();
    harness.run_steps(3);
    harness.get_by_label(item).click();
    harness.step();
    harness.state_mut().playing = false;
    harness.run_steps(3);
}

#[test]
fn examples_are_chosen_and_keys_are_told() {
    let mut harness = harness("map=circle", 1280.0, 800.0, Theme::Light);
    harness.run();
    harness.get_by_label("Keys").click();
    harness.run();
    harness.get_by_label("play or pause");
    harness.key_press(Key::Escape);
    harness.run();
    harness.get_by_label("Examples").click();
    harness.run();
    compare(&mut harness, "examples");
    harness.get_by_label("Battery").click();
    harness.step();
    let state = harness.state();
    assert_eq!(state.address(), "map=office&energy=300");
    assert!(state.notice.as_ref().is_some_and(|notice| !notice.is_error));
}

#[test]
fn keys_play_and_step() {
    let mut harness = harness("map=circle", 1280.0, 800.0, Theme::Light);
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.key_press(Key::ArrowRight);
    harness.run();
    assert_eq!(harness.state().shown_tick(), 2);
    harness.key_press(Key::ArrowLeft);
    harness.run();
    assert_eq!(
        (harness.state().shown_tick(), harness.state().last_tick()),
        (1, 2)
    );
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert!(harness.state().playing);
    assert!(harness.state().last_tick() > 2);
}

#[test]
fn buttons_have_names_and_do_what_they_say() {
    let mut harness = harness("map=circle", 1280.0, 800.0, Theme::Light);
    harness.run();
    harness.get_by_label("Tick").click();
    harness.run();
    assert_eq!(harness.state().shown_tick(), 1);
    harness.get_by_label("draw walls").click();
    harness.run();
    assert_eq!(harness.state().tool, lab::view::Tool::Wall);
    harness.get_by_label("Play").click();
    harness.run_steps(2);
    assert!(harness.state().playing);
}
