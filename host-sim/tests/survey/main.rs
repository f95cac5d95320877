//! What a survey owes, over random terrains, fleets and faults.

mod bodies;
mod heights;
mod visible;
mod voxels;

use host_sim::scene::octree::OcTree;

/// Runs OctoMap's own tools on a file that the fleet has written: they read it, count
/// as many nodes, and find as many occupied cubes.
fn check_with_octomap(tree: &OcTree, name: &str) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    tree.write(std::fs::File::create(&path).unwrap()).unwrap();
    let run = |tool: &str, arguments: &[&std::path::Path]| {
        let done = std::process::Command::new(tool).args(arguments).output();
        let done = done.unwrap_or_else(|error| {
            panic!("{tool}: {error}; install it: apt-get install octomap-tools, or cargo xtask test --only octomap")
        });
        assert!(done.status.success(), "{tool}: {done:?}");
    };
    run("bt2vrml", &[&path]);
    let vrml = std::fs::read_to_string(path.with_extension("bt.wrl")).unwrap();
    let occupied = tree.cubes().iter().filter(|cube| cube.occupied).count();
    assert_eq!(vrml.matches("Box {").count(), occupied);
    let other = path.with_extension("ot");
    run("convert_octree", &[&path, &other]);
    let read = std::fs::read(&other).unwrap();
    let size = format!("\nsize {}\n", tree.nodes());
    assert!(
        read.windows(size.len())
            .any(|bytes| bytes == size.as_bytes())
    );
}

#[test]
fn octomap_reads_any_tree() {
    let mut tree = OcTree::new(0.5);
    for i in 0..2000 {
        tree.insert([i % 23, i / 23 % 19, (i * i) % 11], i % 3 != 0);
    }
    check_with_octomap(&tree, "any.bt");
}
