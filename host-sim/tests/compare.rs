//! The command `compare`, in pieces and as a whole.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;

const SWEEP: &str = "compare --families cave,rooms --worlds 3 --size 16x16 --robots 1,2 --quiet";

fn compare(folder: &Path, words: &str) -> Assert {
    let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    command.current_dir(folder).args(words.split(' ')).assert()
}

fn tables(folder: &Path) -> [Vec<u8>; 2] {
    ["table.md", "table.csv"].map(|name| fs::read(folder.join(name)).unwrap())
}

fn refusal(assert: Assert) -> String {
    let output = assert.code(2).get_output().stderr.clone();
    String::from_utf8(output).unwrap()
}

#[test]
fn shards_merged_are_the_whole_byte_for_byte() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    compare(folder.path(), &format!("{SWEEP} --out whole")).success();
    let rows = fs::read(at("whole/runs.csv")).unwrap();
    assert_eq!(rows.split(|&byte| byte == b'\n').count(), 2 + 6 * 2 * 2);

    // In one folder.
    for shard in ["1/3", "3/3"] {
        compare(
            folder.path(),
            &format!("{SWEEP} --out shared --shard {shard}"),
        )
        .success();
    }
    assert!(!at("shared/table.md").exists());
    let early = compare(folder.path(), "compare --merge shared").code(1);
    let early = String::from_utf8_lossy(&early.get_output().stderr).into_owned();
    assert!(early.contains("8 runs are missing"), "{early}");
    // A task that was killed, with half a line written, and is started again.
    compare(folder.path(), &format!("{SWEEP} --out shared --shard 2/3")).success();
    let part = at("shared/parts/2-of-3.csv");
    let text = fs::read_to_string(&part).unwrap();
    fs::write(&part, &text[..text.len() / 2]).unwrap();
    compare(folder.path(), &format!("{SWEEP} --out shared --shard 2/3")).success();
    compare(folder.path(), "compare --merge shared").success();
    assert_eq!(fs::read(at("shared/runs.csv")).unwrap(), rows);
    assert_eq!(tables(&at("shared")), tables(&at("whole")));

    // In folders of their own, of which one has fewer shards.
    for (out, shard) in [("own1", "1/2"), ("own2", "4/4"), ("own3", "2/4")] {
        compare(
            folder.path(),
            &format!("{SWEEP} --out {out} --shard {shard}"),
        )
        .success();
    }
    compare(folder.path(), "compare --merge own1 own2 own3 --out all").success();
    assert_eq!(fs::read(at("all/runs.csv")).unwrap(), rows);
    assert_eq!(tables(&at("all")), tables(&at("whole")));

    // Without rows.
    for shard in ["1/2", "2/2"] {
        let words = format!("{SWEEP} --summary-only --out summary --shard {shard}");
        compare(folder.path(), &words).success();
        compare(folder.path(), &words).success();
    }
    compare(folder.path(), "compare --merge summary").success();
    assert_eq!(tables(&at("summary")), tables(&at("whole")));
    assert!(!at("summary/runs.csv").exists());
    let ended = fs::read(at("summary/parts/1-of-2.json")).unwrap();
    fs::write(at("summary/parts/5-of-9.json"), ended).unwrap();
    let twice = refusal(compare(folder.path(), "compare --merge summary"));
    assert!(twice.contains("another part holds too"), "{twice}");
}

#[test]
fn tables_are_made_anew_by_another_metric_and_not_from_other_settings() {
    let folder = tempfile::tempdir().unwrap();
    compare(folder.path(), &format!("{SWEEP} --out a --metric 90")).success();
    compare(folder.path(), &format!("{SWEEP} --out b")).success();
    assert_ne!(
        tables(&folder.path().join("a")),
        tables(&folder.path().join("b"))
    );
    compare(folder.path(), "compare --merge a --metric seen").success();
    assert_eq!(
        tables(&folder.path().join("a")),
        tables(&folder.path().join("b"))
    );

    for resume in ["", " --resume"] {
        let seed = refusal(compare(
            folder.path(),
            &format!("{SWEEP} --out b --seed 2{resume}"),
        ));
        assert!(
            seed.contains("plan.json: --seed is 1 there and 2 here"),
            "{seed}"
        );
    }
    compare(
        folder.path(),
        "compare --families cave --worlds 1 --size 9x9 --out c",
    )
    .success();
    let other = refusal(compare(folder.path(), "compare --merge b c"));
    assert!(
        other.contains("c/plan.json: --families is [\"cave\"] there"),
        "{other}"
    );
    let nothing = refusal(compare(folder.path(), "compare --merge none"));
    assert!(nothing.contains("none/plan.json is missing"), "{nothing}");
    let absent = refusal(compare(
        folder.path(),
        "compare --merge b --reference greedy",
    ));
    assert!(
        absent.contains("--reference greedy: the plan has no runs"),
        "{absent}"
    );
    for option in [
        "--seed 3",
        "--resume",
        "--people 3",
        "--metric 90 --worlds 2",
    ] {
        let both = refusal(compare(
            folder.path(),
            &format!("compare --merge b {option}"),
        ));
        assert!(both.contains("cannot be used with"), "{both}");
    }
}

/// The names of columns that the tables below a heading of docs/formats.md begin with.
fn documented(heading: &str) -> Vec<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/formats.md");
    let text = fs::read_to_string(path).unwrap();
    let section = text
        .split("\n## ")
        .find(|section| section.starts_with(heading));
    let lines = section
        .unwrap()
        .lines()
        .filter(|line| line.starts_with("| `"));
    let cells = lines.map(|line| line.split('|').nth(1).unwrap());
    let names = cells.flat_map(|cell| cell.split(','));
    names
        .map(|name| name.trim().trim_matches('`').into())
        .collect()
}

#[test]
fn every_column_is_documented_in_its_place() {
    let folder = tempfile::tempdir().unwrap();
    compare(
        folder.path(),
        "compare --families cave --worlds 1 --size 9x9 --out a",
    )
    .success();
    for (name, heading) in [("runs.csv", "Runs\n"), ("table.csv", "Comparisons\n")] {
        let text = fs::read_to_string(folder.path().join("a").join(name)).unwrap();
        let columns: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        assert_eq!(documented(heading), columns);
    }
}
