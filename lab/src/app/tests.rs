use host_sim::scene::Sensor;
use planner_core::Direction;

use super::*;
use crate::playback::Export;
use crate::view::Deed;
use crate::watch::Obstruction;

fn app() -> App {
    let mut app = App::from_address("map=generate:rooms:24x24:2&robots=2");
    app.playing = false;
    app
}

/// Lets it run to the tick that it was sent to.
fn arrive(app: &mut App) {
    while app.target.is_some() {
        app.advance(0.0);
    }
}

fn finish(app: &mut App) {
    while app.tick() {}
}

#[test]
fn a_robot_killed_on_screen_is_killed_by_the_command() {
    let mut app = app();
    for _ in 0..20 {
        app.tick();
    }
    app.apply(Deed::Killed(1));
    assert!(app.setup.command().ends_with("--robots 2 --kill 1@20"));
    arrive(&mut app);
    assert_eq!(app.shown_tick(), 20);
    finish(&mut app);
    let outcome = app.runs[0].watch.outcome().unwrap();
    assert!(!outcome.robots[1].alive && outcome.is_complete());
}

#[test]
fn a_robot_added_on_the_way_arrives_then() {
    let mut app = app();
    for _ in 0..15 {
        app.tick();
    }
    let cell = app.starts()[0];
    app.apply(Deed::Placed(cell));
    finish(&mut app);
    let own = app.runs[0].watch.records().iter().find(|it| it.robot == 2);
    assert_eq!(own.unwrap().tick, 15);
    assert_eq!(app.report().state, "complete");
}

#[test]
fn a_robot_that_stopped_is_told_to_go_on_by_the_command_too() {
    let mut app = app();
    finish(&mut app);
    let (end, digest) = (app.last_tick(), app.report().digest);
    app.go_on(Some(1));
    let line = format!("--robots 2 --resume 1@{end}");
    assert!(
        app.setup.command().ends_with(&line),
        "{}",
        app.setup.command()
    );
    arrive(&mut app);
    app.playing = false;
    assert_eq!(app.shown_tick(), end);
    finish(&mut app);
    assert!(app.last_tick() > end);
    assert_eq!(app.report().state, "complete");
    assert_ne!(app.report().digest, digest);
    app.go_on(None);
    let resumes = &app.setup.conditions.faults.resumes;
    assert_eq!(resumes.len(), 3, "{resumes:?}");
}

#[test]
fn a_trace_with_faults_of_senses_is_replayed_and_run_again() {
    let address = "map=generate:rooms:24x24:2&robots=2&close=3,3@0-40&blind=0,5\
                   &sensor-fails=1@30&pose-lost=0@8-12&people=3&doors=2&false-walls=0.01\
                   &see-robots=";
    let mut app = App::from_address(address);
    for _ in 0..60 {
        app.tick();
    }
    let bytes = crate::export::trace(&app.runs[0].watch.trace()).unwrap();
    let mut other = App::new(Setup::default());
    other.open("trace.csv", &bytes);
    let conditions = |app: &App| app.setup.conditions.clone();
    assert_eq!(conditions(&other).faults, conditions(&app).faults);
    assert_eq!(conditions(&other).trouble, conditions(&app).trouble);
    other.show(50);
    app.show(50);
    let seen = |app: &App| {
        let watch = &app.runs[0].watch;
        (watch.seen_cells(), watch.obstructions().to_vec())
    };
    assert_eq!(seen(&other), seen(&app));
    assert_eq!(seen(&app).1.len(), 5);
    let watch = &mut other.runs[0].watch;
    watch.catch_up(|| true);
    assert_eq!(watch.differs(), None);
    assert!(watch.state().is_some());
}

#[test]
fn a_drone_killed_on_screen_is_killed_by_the_command() {
    for address in [
        "terrain=urban:3&size=24&robots=2",
        "terrain=town:2&size=24&robots=2",
    ] {
        let mut app = App::from_address(address);
        app.playing = false;
        for _ in 0..6 {
            app.tick();
        }
        app.apply(Deed::Selected(Some(1)));
        app.apply(Deed::Killed(1));
        assert_eq!(app.address(), format!("{address}&kill=1@6"));
        arrive(&mut app);
        assert_eq!((app.shown_tick(), app.playing), (6, false));
        let drone = app.surveys[0].drone(1);
        assert!(!drone.is_alive, "{drone:?}");
        finish(&mut app);
        assert_eq!(app.report().state, "complete", "{address}");
        let ticks = app.last_tick();
        app.go_on(None);
        arrive(&mut app);
        assert!(app.playing && app.shown_tick() == ticks);
        assert!(
            app.address()
                .ends_with(&format!("&resume=0@{ticks}&resume=1@{ticks}"))
        );
    }
}

#[test]
fn a_cell_is_shut_and_opened_on_the_way() {
    let mut app = app();
    let cell = app.starts()[0].step(Direction::East);
    let obstructions = |app: &mut App| {
        arrive(app);
        app.tick();
        app.runs[0].watch.obstructions().to_vec()
    };
    for _ in 0..15 {
        app.tick();
    }
    assert_eq!(obstructions(&mut app), []);
    app.apply(Deed::Shut(cell));
    assert_eq!(obstructions(&mut app), [Obstruction::Shut(cell)]);
    app.apply(Deed::Shut(cell));
    assert_eq!(obstructions(&mut app), []);
    let spans = &app.setup.conditions.faults.shut;
    let told: Vec<String> = spans.iter().map(ToString::to_string).collect();
    assert_eq!(told, [format!("{cell}@16-17")]);
}

#[test]
fn walls_are_drawn_and_erased() {
    let mut app = app();
    let cell = app.runs[0]
        .watch
        .scenario()
        .world
        .free_cells()
        .next()
        .unwrap();
    app.tool = Tool::Wall;
    app.apply(Deed::Painted(cell));
    assert!(!app.runs[0].watch.scenario().world.is_free(cell));
    app.tool = Tool::Erase;
    app.apply(Deed::Painted(cell));
    assert!(app.runs[0].watch.scenario().world.is_free(cell));
    app.tool = Tool::Wall;
    let start = app.starts()[0];
    app.apply(Deed::Painted(start));
    assert!(app.report().error.contains("a robot starts at"));
}

#[test]
fn two_planners_go_in_step() {
    let mut app = app();
    app.rival = Some(PlannerKind::MinPos);
    app.set(app.setup.clone());
    for _ in 0..30 {
        app.tick();
    }
    let shown: Vec<_> = app.runs.iter().map(|run| run.watch.shown()).collect();
    assert_eq!(shown, [30, 30]);
    finish(&mut app);
    assert_eq!(app.report().state, "complete");
}

#[test]
fn surveys_go_in_step_and_what_befalls_one_befalls_both() {
    let address = "terrain=town:2&size=24&robots=2";
    let mut app = App::from_address(address);
    app.playing = false;
    let alone = {
        let mut app = App::from_address(address);
        finish(&mut app);
        app.report().digest
    };
    app.survey_rival = Some(Rival::Sensor(Sensor::Downward));
    let setup = app.surveys[0].setup.clone();
    assert!(app.fly(setup));
    for _ in 0..8 {
        app.tick();
    }
    let shown = |app: &App| -> Vec<u32> {
        let players = app.players().into_iter();
        players.map(|player| player.shown()).collect()
    };
    assert_eq!(shown(&app), [8, 8]);
    let mut both = App::from_address(address);
    both.survey_rival = app.survey_rival;
    both.fly(app.surveys[0].setup.clone());
    finish(&mut both);
    assert_eq!(both.report().state, "complete");
    // That there is another changes nothing of the first.
    assert_eq!(both.report().digest, alone);
    app.kill(1);
    arrive(&mut app);
    assert_eq!(shown(&app), [8, 8]);
    let lives = app.surveys.iter().map(|survey| survey.drone(1).is_alive);
    assert_eq!(lives.collect::<Vec<_>>(), [false, false]);
    // An address, or a trace, comes alone.
    app.load(address);
    assert_eq!((app.surveys.len(), app.survey_rival), (1, None));
}

#[test]
fn bad_files_are_refused_with_a_sentence_and_change_nothing() {
    let mut app = app();
    let before = app.setup.clone();
    for (name, bytes) in [
        ("ragged.txt", &b"...\n..\n"[..]),
        ("full.txt", b"###\n###\n"),
        ("picture.png", b"no picture"),
        ("map.doc", b"..."),
        ("run.csv", b"{\"format\":1}"),
        ("trace.csv", b"tick,robot,x,y,z,work\n0,0,1,1,1,7\n"),
    ] {
        app.open(name, bytes);
        let error = app.report().error;
        assert!(error.starts_with(name), "{error}");
        assert_eq!(app.setup, before);
    }
}

#[test]
fn a_trace_that_cannot_be_read_says_what_to_do() {
    let mut app = app();
    app.open(
        "run.csv",
        b"{\"format\":\"host-sim trace\",\"version\":1,\"digest\":\"\",\"records\":0}",
    );
    let error = app.report().error;
    assert!(
        error.contains("version 1") && error.contains("run the"),
        "{error}"
    );
    app.open(
        "run.csv",
        b"{\"format\":\"logbook\",\"version\":1,\"digest\":\"\",\"records\":0}",
    );
    let error = app.report().error;
    assert!(
        error.contains("logbook") && error.contains("open a trace"),
        "{error}"
    );
    app.open("coverage.csv", b"tick,seen_cells\n");
    assert!(app.report().error.contains("open the trace.csv"));
    app.open(
        "summary.json",
        b"{\n  \"complete\": true,\n  \"trace_digest\": \"00\"\n}\n",
    );
    assert!(app.report().error.contains("open the trace.csv"));
}

#[test]
fn a_saved_survey_is_replayed_and_flown_again() {
    for address in [
        "terrain=urban:3&size=24&robots=2",
        "terrain=town:2&size=24&range=6",
    ] {
        let mut app = App::from_address(address);
        finish(&mut app);
        let digest = app.report().digest;
        let bytes = app.surveys[0].export(Export::Trace).unwrap().1;
        let mut other = App::new(Setup::default());
        other.open("trace.csv", &bytes);
        let replayed = other.report();
        assert_eq!((&*replayed.digest, replayed.state), (&*digest, "complete"));
        assert_eq!(other.address(), address);
        assert!(other.playing && other.shown_tick() == 0);
        finish(&mut other);
        assert_eq!(other.shown_tick(), other.last_tick());
        assert_eq!(other.last_tick(), app.last_tick());
        // A place that is only in the trace is shown, and cannot be flown anew.
        let elsewhere = String::from_utf8(bytes).unwrap();
        let elsewhere = elsewhere.replacen("\"name\":\"", "\"name\":\"old-", 1);
        other.open("trace.csv", elsewhere.as_bytes());
        let survey = &other.surveys[0];
        assert!(survey.is_replay() && !survey.is_repeatable());
        other.fly(survey.setup.clone());
        assert!(other.report().error.contains("only in the trace"));
        assert!(other.surveys[0].is_replay());
    }
}

#[test]
fn a_saved_trace_is_replayed() {
    let mut app = app();
    finish(&mut app);
    let digest = app.report().digest;
    let bytes = crate::export::trace(&app.runs[0].watch.trace()).unwrap();
    let mut other = App::new(Setup::default());
    other.open("trace.csv", &bytes);
    assert!(other.runs[0].watch.is_replay());
    assert_eq!(other.report().digest, digest);
    assert_eq!(other.report().state, "complete");
}
