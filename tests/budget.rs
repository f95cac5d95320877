//! The sizes of whole planners against `fixtures/budget.txt`.

#[allow(dead_code, unreachable_pub)]
#[path = "../xtask/src/budget.rs"]
mod file;

use std::path::Path;

use planner_core::coordinated_survey::CoordinatedSurvey;
use planner_core::explorer::Explorer;
use planner_core::fcao::Fcao;
use planner_core::local_frontiers::LocalFrontiers;
use planner_core::voxel_survey::VoxelSurvey;

#[test]
fn planners_fit_their_budget() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let budget = file::Budget::read(root).unwrap_or_else(|error| panic!("{error}"));
    let measured = [
        ("explorer_32x32_bytes", size_of::<Explorer<4, 4>>()),
        ("explorer_64x64_bytes", size_of::<Explorer<8, 8>>()),
        ("explorer_128x128_bytes", size_of::<Explorer<16, 16>>()),
        (
            "local_frontiers_64x64_bytes",
            size_of::<LocalFrontiers<8, 8>>(),
        ),
        ("fcao_104x104_bytes", size_of::<Fcao<13, 13>>()),
        (
            "coordinated_survey_104x104_bytes",
            size_of::<CoordinatedSurvey<13, 13>>(),
        ),
        (
            "voxel_survey_40x40x16_bytes",
            size_of::<VoxelSurvey<5, 5, 16>>(),
        ),
        (
            "voxel_survey_64x64x24_bytes",
            size_of::<VoxelSurvey<8, 8, 24>>(),
        ),
    ];
    for planner in [
        "explorer_",
        "local_frontiers_",
        "fcao_",
        "coordinated_survey_",
        "voxel_survey_",
    ] {
        let of_it = measured
            .iter()
            .filter(|(name, _)| name.starts_with(planner));
        let of_it: Vec<_> = of_it.map(|&(name, size)| (name, size as u64)).collect();
        match budget.check(planner, &of_it) {
            Ok(within) => println!("{}", within.join("\n")),
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn the_page_tells_every_limit() {
    const CYCLES_IN_A_MILLISECOND: f64 = 168e3;
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let budget = file::Budget::read(root).unwrap_or_else(|error| panic!("{error}"));
    let page = std::fs::read_to_string(root.join("docs/budgets.md")).unwrap();
    let told: Vec<&str> = page.lines().filter(|it| it.starts_with("| `")).collect();
    let limits = budget.0.iter().map(|(name, limit)| {
        let time = match name.ends_with("_instructions") {
            true => format!(" {:.2} |", *limit as f64 / CYCLES_IN_A_MILLISECOND),
            false => String::new(),
        };
        format!("| `{name}` | {} |{time}", with_commas(*limit))
    });
    assert_eq!(told, limits.collect::<Vec<_>>(), "docs/budgets.md");
}

/// A number with a comma before each three digits.
fn with_commas(number: u64) -> String {
    match number {
        0..1000 => number.to_string(),
        _ => format!("{},{:03}", with_commas(number / 1000), number % 1000),
    }
}
