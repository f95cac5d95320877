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

fn run_into(out: &Path, shard: Shard, resume: bool) {
    let journal = Journal::open(out, shard, resume).unwrap();
    let done = Journal::read_all(out).unwrap();
    let done: HashSet<Key> = done.iter().map(Row::key).collect();
    execute(&plan(), shard, &done, &|row, _| journal.add(&row)).unwrap();
}

/// All rows in a folder, in an order that does not hang on threads.
fn rows_in(out: &Path) -> Vec<Row> {
    let mut rows = Journal::read_all(out).unwrap();
    let keys: Vec<Key> = plan().keys().collect();
    rows.sort_by_key(|row| keys.iter().position(|key| *key == row.key()));
    rows
}

#[test]
fn shards_and_an_interrupted_run_give_the_rows_of_one_run() {
    let whole = tempfile::tempdir().unwrap();
    run_into(whole.path(), Shard::ALL, false);
    let rows = rows_in(whole.path());
    assert_eq!(rows.len(), plan().runs());

    let shared = tempfile::tempdir().unwrap();
    for shard in ["1/3", "2/3", "3/3"] {
        run_into(shared.path(), shard.parse().unwrap(), false);
    }
    assert_eq!(rows_in(shared.path()), rows);

    let cut = tempfile::tempdir().unwrap();
    let part = "parts/1-of-1.csv";
    let text = std::fs::read_to_string(whole.path().join(part)).unwrap();
    std::fs::create_dir(cut.path().join("parts")).unwrap();
    std::fs::write(cut.path().join(part), &text[..text.len() / 2]).unwrap();
    run_into(cut.path(), Shard::ALL, true);
    assert_eq!(rows_in(cut.path()), rows);
}

#[test]
fn a_folder_with_runs_is_not_overwritten() {
    let out = tempfile::tempdir().unwrap();
    run_into(out.path(), "1/30".parse().unwrap(), false);
    let again = Journal::open(out.path(), "1/30".parse().unwrap(), false);
    assert!(matches!(again, Err(JournalError::Exists { .. })));
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
    run_into(out.path(), Shard::ALL, false);
    let mut rows = rows_in(out.path());
    // Twice the ticks of the reference, but for one run that is not complete.
    for number in 0..rows.len() {
        let reference = rows[number].key().with_planner(MinPos);
        let reference = rows.iter().find(|row| row.key() == reference).unwrap();
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
        assert!((comparison.ratio.unwrap().mean - 2.0).abs() < 1e-9);
        assert_eq!(comparison.pairs, comparison.runs - comparison.incomplete);
    }
    let incomplete: usize = comparisons.iter().filter(all).map(|of| of.incomplete).sum();
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
    run_into(out.path(), "1/9".parse().unwrap(), false);
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
    for id in ["fig6", "fig7", "fig8", "fig9", "fig10", "fig11", "minpos"] {
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
