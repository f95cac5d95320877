//! `generate`.

use super::*;

#[test]
fn generate_writes_what_explore_reads() {
    let folder = folder();
    let arguments = ["generate", "cave", "--size", "big", "-o", "cave.png"];
    assert_bad_input(folder.path(), &arguments, &["--size", "WIDTHxHEIGHT"]);
    for (family, file) in [
        ("perfect-maze", "maze.txt"),
        ("open", "open.pgm"),
        ("rooms", "r.map"),
    ] {
        let arguments = [
            "generate", family, "--size", "25x21", "--seed", "4", "-o", file,
        ];
        host_sim(folder.path(), &arguments).assert().success();
        host_sim(folder.path(), &["explore", file, "--robots", "1"])
            .assert()
            .success();
    }
}
