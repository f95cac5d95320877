use std::collections::HashSet;
use std::path::Path;

use planner_core::Extent;

use super::figures::{Drawn, Effort, figures, measure, page};
use super::*;
use crate::planners::PlannerKind::{Closest, Explorer, MinPos};
use crate::scenario::{MediumKind, Preset, Trouble};
use crate::world::{Family, ReadOptions, Recipe, World, paper};

fn plan() -> Plan {
    let sites = [Family::Cave, Family::Rooms, Family::Open]
        .map(|family| Site::Generated(Recipe::new(family, Extent::new(16, 16), 7)));
    Plan {
        sites: sites.into(),
        planners: vec![Explorer, Closest, MinPos],
        robots: vec![1, 3],
        place: Place::Random,
        starts: 2,
        medium: MediumKind::Ideal,
        syncs: vec![1, 20],
        losses: vec![0.0, 0.5],
        trouble: Trouble::default(),
        preset: Preset::default(),
        ranges: vec![3],
        seed: 4,
    }
}

fn run_into(out: &Path, shard: Shard) {
    let order = Order::of(&plan());
    let journal = Journal::open(out, shard).unwrap();
    let done = Journal::read_all(out).unwrap();
    let done: HashSet<usize> = done.iter().filter_map(|row| order.place(row)).collect();
    let is_done = |world, run| done.contains(&(world * order.runs_a_world() + run));
    execute(&plan(), shard, &is_done, &|row, _| journal.add(&row)).unwrap();
}

/// All rows in a folder, in an order that does not hang on threads.
fn rows_in(out: &Path) -> Vec<Row> {
    Order::of(&plan()).sort(Journal::read_all(out).unwrap())
}

#[test]
fn shards_and_an_interrupted_run_give_the_rows_of_one_run() {
    let whole = tempfile::tempdir().unwrap();
    run_into(whole.path(), Shard::ALL);
    let rows = rows_in(whole.path());
    assert_eq!(rows.len(), plan().runs());

    let shared = tempfile::tempdir().unwrap();
    for shard in ["1/3", "2/3", "3/3"] {
        run_into(shared.path(), shard.parse().unwrap());
    }
    assert_eq!(rows_in(shared.path()), rows);

    let cut = tempfile::tempdir().unwrap();
    let part = "parts/1-of-1.csv";
    let text = std::fs::read_to_string(whole.path().join(part)).unwrap();
    std::fs::create_dir(cut.path().join("parts")).unwrap();
    std::fs::write(cut.path().join(part), &text[..text.len() / 2]).unwrap();
    run_into(cut.path(), Shard::ALL);
    assert_eq!(rows_in(cut.path()), rows);
}

#[test]
fn every_world_is_of_one_shard_and_shards_have_as_many_of_each_family() {
    let seeds = 1..=10;
    let sites = seeds.flat_map(|seed| {
        Family::ALL.map(|family| Site::Generated(Recipe::new(family, Extent::new(16, 16), seed)))
    });
    let plan = Plan {
        sites: sites.collect(),
        ..plan()
    };
    for count in [1, 2, 3, 8, 16, 100] {
        let mut all = Vec::new();
        for index in 1..=count {
            let shard: Shard = format!("{index}/{count}").parse().unwrap();
            let worlds = shard.of(&plan);
            for family in Family::ALL {
                let name = family.to_string();
                let of = |&&site: &&usize| plan.sites[site].family() == name;
                let found = worlds.iter().filter(of).count();
                assert!((10 / count..=10_usize.div_ceil(count)).contains(&found));
            }
            all.extend(worlds);
        }
        all.sort_unstable();
        assert_eq!(all, (0..80).collect::<Vec<_>>());
    }
}

fn settings() -> Settings {
    Settings {
        maps: Vec::new(),
        families: vec![Family::Cave, Family::Rooms, Family::Open],
        worlds: 4,
        size: (16, 16),
        planners: vec![Explorer, Closest, MinPos],
        reference: MinPos,
        robots: vec![3, 1],
        place: Place::Random,
        starts: 2,
        medium: MediumKind::Ideal,
        sync: vec![1, 20],
        loss: vec![0.0],
        range: vec![3],
        trouble: Trouble::default(),
        preset: Preset::default(),
        seed: 4,
        metric: Metric::Stopped,
        summary_only: true,
        program: String::new(),
    }
}

#[test]
fn worlds_added_up_by_shards_give_the_tables_of_all_rows() {
    let settings = settings();
    let plan = settings.plan([]);
    let rows = std::sync::Mutex::new(Vec::new());
    let shards = tempfile::tempdir().unwrap();
    for shard in ["1/3", "2/3", "3/3"] {
        let shard: Shard = shard.parse().unwrap();
        // Ended early once, before the second half of its worlds.
        for worlds in [shard.of(&plan).len() / 2, usize::MAX] {
            let tally = Tally::open(shards.path(), shard, &settings).unwrap();
            let counted = tally.counted().worlds;
            let late: Vec<usize> = shard.of(&plan).into_iter().skip(worlds).collect();
            let is_done = |world, _| counted.contains(&world) || late.contains(&world);
            execute(&plan, shard, &is_done, &|row, _| {
                rows.lock().unwrap().push(row.clone());
                tally.add(row)
            })
            .unwrap();
            tally.write().unwrap();
        }
    }
    let order = settings.order();
    let rows = order.sort(rows.into_inner().unwrap());
    assert_eq!(rows.len(), order.runs());
    let mut counted = Counted::default();
    counted.read_all(shards.path()).unwrap();
    assert_eq!(counted.worlds.len(), 12);
    let summed = counted.totals.comparisons(&settings.axes());
    let compared = compare(&rows, MinPos, Metric::Stopped);
    assert_eq!(summed, compared);
    let again = counted.read_all(shards.path());
    assert!(matches!(again, Err(JournalError::Twice { .. })));

    // Whole numbers say what floating ones do.
    for comparison in compared {
        let of = |row: &&Row| {
            row.planner == comparison.planner
                && row.sync == comparison.conditions.sync
                && comparison
                    .family
                    .as_ref()
                    .is_none_or(|family| row.family == *family)
                && comparison.robots.is_none_or(|robots| row.robots == robots)
        };
        let ticks = rows.iter().filter(of).filter_map(|row| {
            Some((
                row.world.as_str(),
                row.metric(Metric::Stopped)?.max(1).into(),
            ))
        });
        let (own, plain) = (comparison.ticks.unwrap(), geometric_mean(ticks).unwrap());
        for (own, plain) in [
            (own.mean, plain.mean),
            (own.low, plain.low),
            (own.high, plain.high),
        ] {
            assert!((own / plain - 1.0).abs() < 1e-6, "{own} {plain}");
        }
        let sum = |of_row: fn(&Row) -> u64| rows.iter().filter(of).map(of_row).sum::<u64>() as f64;
        let waiting = sum(|row| row.waited_ticks) / sum(|row| row.robot_ticks);
        assert_eq!(comparison.waiting, Some(waiting));
    }
}

#[test]
fn a_folder_belongs_to_one_plan() {
    let out = tempfile::tempdir().unwrap();
    settings().claim(out.path()).unwrap();
    settings().claim(out.path()).unwrap();
    assert_eq!(Settings::read(out.path()).unwrap(), settings());
    let refusal = |change: fn(&mut Settings)| {
        let mut other = settings();
        change(&mut other);
        other.claim(out.path()).unwrap_err().to_string()
    };
    let seed = refusal(|settings| settings.seed = 5);
    assert!(seed.contains("--seed is 4 there and 5 here"), "{seed}");
    let robots = refusal(|settings| settings.robots = vec![3]);
    assert!(
        robots.contains("--robots is [3,1] there and [3] here"),
        "{robots}"
    );
    let trouble = refusal(|settings| settings.trouble.false_walls = 0.5);
    assert!(
        trouble.contains("--false-walls is 0.0 there and 0.5"),
        "{trouble}"
    );

    let old = tempfile::tempdir().unwrap();
    std::fs::create_dir(old.path().join("parts")).unwrap();
    let unknown = settings().claim(old.path());
    assert!(matches!(unknown, Err(PlanError::Missing { .. })));
    assert!(matches!(
        Settings::read(old.path()),
        Err(PlanError::Missing { .. })
    ));
}

#[test]
fn statistics_are_those_of_a_calculation_by_hand() {
    // Logarithms 0, ln 2, 2 ln 2: mean ln 2, standard deviation ln 2, and
    // t(2; 0.975) = 4.30265.
    let half = 4.30265 * 2f64.ln() / 3f64.sqrt();
    let one = geometric_mean([("a", 1.0), ("a", 2.0), ("a", 4.0)]).unwrap();
    assert!((one.mean - 2.0).abs() < 1e-9);
    assert!((one.high.ln() - one.mean.ln() - half).abs() < 1e-4);
    assert!((one.mean.ln() - one.low.ln() - half).abs() < 1e-4);

    // Each world twice says no more than each world once.
    let once = mean([("a", 1.0), ("b", 2.0), ("c", 4.0)]).unwrap();
    let twice = [
        ("a", 1.0),
        ("b", 2.0),
        ("c", 4.0),
        ("a", 1.0),
        ("b", 2.0),
        ("c", 4.0),
    ];
    let twice = mean(twice).unwrap();
    assert!((once.high - twice.high).abs() < 1e-9);

    assert_eq!(mean::<u32>([]), None);
    assert_eq!(mean([("a", 3.0)]).unwrap().high, f64::INFINITY);
}

#[test]
fn pairs_are_of_the_same_run_and_leave_out_what_is_not_complete() {
    let out = tempfile::tempdir().unwrap();
    run_into(out.path(), Shard::ALL);
    let mut rows = rows_in(out.path());
    // Twice the ticks of the reference, but for one run that is not complete.
    for number in 0..rows.len() {
        let reference = rows[number].key().with_planner(MinPos);
        let is_reference = |row: &&Row| row.key() == reference && row.world == rows[number].world;
        let reference = rows.iter().find(is_reference).unwrap();
        let ticks = reference.ticks_to_seen.map(|ticks| 2 * ticks.max(1));
        if rows[number].planner == Explorer {
            rows[number].ticks_to_seen = ticks;
        }
    }
    let spoilt = rows.iter_mut().find(|row| row.planner == Explorer).unwrap();
    spoilt.complete = false;
    let (robots, sync) = (spoilt.robots, spoilt.sync);
    let comparisons = compare(&rows, MinPos, Metric::Seen);
    let all =
        |of: &&Comparison| of.planner == Explorer && of.family.is_none() && of.robots.is_none();
    for comparison in comparisons.iter().filter(all) {
        assert!((comparison.ratio.unwrap().mean - 2.0).abs() < 1e-8);
        assert_eq!(comparison.pairs, comparison.runs - comparison.incomplete);
    }
    let incomplete: u64 = comparisons.iter().filter(all).map(|of| of.incomplete).sum();
    assert_eq!(incomplete, 1);
    let there = comparisons.iter().find(|of| of.incomplete == 1).unwrap();
    assert_eq!(there.conditions.sync, sync);
    assert!(there.robots.is_none_or(|of| of == robots));
    let table = markdown(&comparisons, MinPos, Metric::Seen);
    assert!(table.contains("2.000 ±0.000"), "{table}");
    assert!(comparisons_csv(&comparisons, Metric::Seen).lines().count() == comparisons.len() + 1);
}

#[cfg(feature = "parquet")]
#[test]
fn a_parquet_file_has_the_columns_and_rows_of_the_csv() {
    use ::parquet::file::reader::{FileReader, SerializedFileReader};
    let out = tempfile::tempdir().unwrap();
    run_into(out.path(), "1/3".parse().unwrap());
    let rows = rows_in(out.path());
    let path = out.path().join("runs.parquet");
    write_parquet(&rows, std::fs::File::create(&path).unwrap()).unwrap();
    let file = SerializedFileReader::new(std::fs::File::open(&path).unwrap()).unwrap();
    let metadata = file.metadata().file_metadata();
    assert_eq!(metadata.num_rows() as usize, rows.len());
    let names: Vec<&str> = metadata
        .schema_descr()
        .columns()
        .iter()
        .map(|column| column.name())
        .collect();
    let csv = to_csv(&rows, true);
    assert_eq!(names.join(","), csv.lines().next().unwrap());
    let first = file.get_row_iter(None).unwrap().next().unwrap().unwrap();
    let planner = first
        .get_column_iter()
        .find(|(name, _)| *name == "planner")
        .unwrap();
    assert_eq!(
        planner.1.to_string(),
        format!("{:?}", rows[0].planner.to_string())
    );
}

#[test]
fn every_figure_can_be_drawn() {
    let mut measured = Vec::new();
    for mut figure in figures(Effort::Quick, None) {
        figure.plan.starts = 1;
        figure
            .plan
            .planners
            .retain(|&planner| planner == Explorer || planner == MinPos);
        let done = measure(figure, &|| ()).unwrap();
        let drawn = Drawn::from(&done);
        assert!(drawn.chart.svg().unwrap().contains("ticks"));
        drawn.chart.write_png(std::io::sink()).unwrap();
        measured.push(drawn);
    }
    let page = page(&measured, &[]);
    for id in [
        "fig6", "fig7", "fig8", "fig9", "fig10", "fig11", "spread", "minpos",
    ] {
        assert!(page.contains(&format!("<img src=\"{id}.svg\"")));
    }
}

#[test]
fn the_maps_of_the_figures_are_those_in_the_fixtures() {
    let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/maps");
    for world in [
        paper::labyrinth1(1),
        paper::labyrinth2(1),
        paper::circle(),
        paper::blocks(),
        paper::maze(1),
    ] {
        let path = maps.join(format!("{}.txt", world.name()));
        if std::env::var_os("UPDATE_FIXTURES").is_some() {
            world.write(&path, 1).unwrap();
        }
        let fixture = World::read(&path, &ReadOptions::default()).unwrap();
        assert_eq!(fixture.to_text(), world.to_text(), "{}", path.display());
        assert_eq!(fixture.starts(), world.starts());
    }
}
