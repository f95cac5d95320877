//! Eight scenarios to start from.

/// A scenario with a sentence on what there is to see.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// Its name.
    pub name: &'static str,
    /// What there is to see.
    pub what: &'static str,
    /// The scenario, as the part of the page's address behind `#`, and for
    /// `lab --scenario`.
    pub address: &'static str,
}

/// All of them.
pub const EXAMPLES: [Example; 8] = [
    Example {
        name: "An office",
        what: "Three robots share the rooms among them, each deciding alone.",
        address: "map=office",
    },
    Example {
        name: "A door that shuts",
        what: "From tick 20 to 100 the only way to the hall below is shut; the robots look \
               elsewhere, and come back.",
        address: "map=ward&robots=2&shut=10,18@20-100&shut=11,18@20-100",
    },
    Example {
        name: "Noisy rangers",
        what: "Three of a hundred free cells look like walls. The robots weigh their looks, and \
               take walls back; the layer \"votes\" shows it.",
        address: "map=generate:rooms:48x36:4&robots=2&preset=rangers&false-walls=0.03",
    },
    Example {
        name: "A forger",
        what: "Somebody sends forged frames, and the robots have no key: they stop early, and \
               say that part of the map was heard.",
        address: "map=ward&robots=2&forge=2:any",
    },
    Example {
        name: "Bodies in narrow rooms",
        what: "Discs of three cells keep off walls and off each other; narrow doors are not \
               theirs.",
        address: "map=office&clearance=1",
    },
    Example {
        name: "Battery",
        what: "Energy for 300 steps: each robot turns back in time, and stops at home. \"Let all \
               robots go on\" gives as much again.",
        address: "map=office&energy=300",
    },
    Example {
        name: "A hundred robots",
        what: "They start together in a large building, spread out, and join their maps by radio.",
        address: "map=generate:rooms:256x256:1&robots=100&start=random",
    },
    Example {
        name: "Drones in a town",
        what: "Through rooms and under bridges, voxel by voxel. The slider \"levels\" looks \
               inside.",
        address: "terrain=town:1&size=40&robots=3",
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::App;

    /// How each one ends; of the hundred robots the first ticks.
    #[test]
    fn examples_show_what_they_say() {
        for (example, ends) in EXAMPLES.iter().zip([
            "complete",
            "complete",
            "complete",
            "incomplete",
            "complete",
            "incomplete",
            "running",
            "complete",
        ]) {
            let mut app = App::from_address(example.address);
            assert_eq!(app.report().error, "", "{}", example.name);
            assert_eq!(app.address(), example.address);
            let ticks = if ends == "running" { 5 } else { u32::MAX };
            while app.shown_tick() < ticks && app.tick() {}
            assert_eq!(app.report().state, ends, "{}", example.name);
        }
    }
}
