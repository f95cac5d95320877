//! Which figures there are, and the runs that each one is drawn from.

use std::sync::Arc;

use crate::experiments::{Place, Plan, Site};
use crate::planners::PlannerKind::{
    self, Bmilrv, Closest, Explorer, Greedy, LocalFrontiers, LocalFrontiersSecondChance, MinPos,
};
use crate::scenario::{MediumKind, Preset, Trouble};
use crate::world::{World, paper};

/// Seed of the labyrinths in `fixtures/maps`, and of all figures.
const SEED: u64 = 1;

/// A figure: what it shows, and its runs.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Short name: that of its files.
    pub id: &'static str,
    /// What is shown.
    pub title: String,
    /// Where it is from, and how it is to be read.
    pub caption: String,
    /// How it is drawn.
    pub layout: Layout,
    /// Its runs.
    pub plan: Plan,
}

/// How a figure is drawn from its runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Bars: ticks by map.
    Maps,
    /// Ticks by number of robots, a panel for each map.
    Robots,
    /// Ticks by ticks between exchanges, a panel for each map.
    Syncs,
    /// Share of cells seen over time, a panel for each map.
    Coverage,
}

/// How many runs figures are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Enough to see that the command works.
    Quick,
    /// Enough for confidence intervals.
    Full,
}

/// All figures; the last one with the hospital of the slides if that is given.
pub fn figures(effort: Effort, hospital: Option<Arc<World>>) -> Vec<Figure> {
    let local = [LocalFrontiers, LocalFrontiersSecondChance];
    let frontiers = [MinPos, LocalFrontiers, LocalFrontiersSecondChance, Explorer];
    let base = |sites: Vec<Site>, planners: &[PlannerKind], place| Plan {
        sites,
        planners: planners.to_vec(),
        robots: vec![3],
        place,
        starts: effort.pick(2, 20),
        medium: MediumKind::Ideal,
        syncs: vec![1],
        losses: vec![0.0],
        trouble: Trouble::default(),
        preset: Preset::default(),
        ranges: vec![5],
        seed: SEED,
    };
    let [labyrinth1, labyrinth2, circle, blocks] = paper_maps();
    let all = || {
        vec![
            labyrinth1.clone(),
            labyrinth2.clone(),
            circle.clone(),
            blocks.clone(),
        ]
    };
    let mut slides = vec![Site::Given(Arc::new(paper::maze(SEED)))];
    slides.extend(hospital.map(Site::Given));
    vec![
        Figure {
            id: "fig6",
            title: "Duration of the exploration by approach, 3 robots".into(),
            caption: "[Gauville2019, figure 6], with the second chance and the complete explorer added.".into(),
            layout: Layout::Maps,
            plan: base(all(), &[Bmilrv, MinPos, local[0], local[1], Explorer], Place::Map),
        },
        Figure {
            id: "fig7",
            title: "Cells seen over time, 3 robots".into(),
            caption: "[Gauville2019, figure 7], with the complete explorer added. Bands: 95 % confidence.".into(),
            layout: Layout::Coverage,
            plan: base(
                vec![labyrinth1.clone(), labyrinth2.clone()],
                &[MinPos, LocalFrontiers, Explorer],
                Place::Map,
            ),
        },
        Figure {
            id: "fig8",
            title: "Duration of the exploration by number of robots".into(),
            caption: "[Gauville2019, figure 8], with the second chance and the complete explorer added.".into(),
            layout: Layout::Robots,
            plan: Plan {
                robots: effort.pick(vec![1, 3], vec![1, 2, 3, 5, 8, 10]),
                ..base(all(), &frontiers, Place::Map)
            },
        },
        Figure {
            id: "fig9",
            title: "Duration of the exploration by ticks between exchanges, 3 robots".into(),
            caption: "[Gauville2019, figure 9], with MinPos and the complete explorer added.".into(),
            layout: Layout::Syncs,
            plan: Plan {
                syncs: effort.pick(vec![1, 50], vec![1, 2, 5, 10, 20, 50, 100, 200]),
                ..base(all(), &frontiers, Place::Map)
            },
        },
        Figure {
            id: "fig10",
            title: "Cells seen over time, 10 robots from the centre".into(),
            caption: "[Gauville2019, figure 10], with the complete explorer added. Bands: 95 % confidence.".into(),
            layout: Layout::Coverage,
            plan: Plan {
                robots: vec![10],
                ..base(vec![labyrinth1.clone()], &frontiers, Place::Center)
            },
        },
        Figure {
            id: "fig11",
            title: "Duration of the exploration from the centre".into(),
            caption: "[Gauville2019, figure 11], with the complete explorer added.".into(),
            layout: Layout::Robots,
            plan: Plan {
                robots: vec![3, 5, 8],
                ..base(all(), &frontiers, Place::Center)
            },
        },
        Figure {
            id: "spread",
            title: "Duration of the exploration from starts far apart".into(),
            caption: "As figure 8, but the first robot anywhere, and each further one as far as possible \
                      from those before."
                .into(),
            layout: Layout::Robots,
            plan: Plan {
                robots: effort.pick(vec![1, 3], vec![1, 2, 3, 5, 8, 10]),
                ..base(all(), &frontiers, Place::Spread)
            },
        },
        Figure {
            id: "minpos",
            title: "MinPos against simpler rules".into(),
            caption: "[Bautin2011, results on the maze and on the hospital environment], \
                      with the complete explorer added. The slides' maze is a picture only; \
                      this one is in its spirit."
                .into(),
            layout: Layout::Robots,
            plan: Plan {
                robots: effort.pick(vec![1, 3], vec![1, 2, 3, 5, 8, 10]),
                starts: effort.pick(2, 10),
                ..base(slides, &[Closest, Greedy, MinPos, Explorer], Place::Random)
            },
        },
    ]
}

/// The four maps in the spirit of [Gauville2019, figure 4], as in `fixtures/maps`.
fn paper_maps() -> [Site; 4] {
    [
        paper::labyrinth1(SEED),
        paper::labyrinth2(SEED),
        paper::circle(),
        paper::blocks(),
    ]
    .map(|world| Site::Given(Arc::new(world)))
}

impl Effort {
    fn pick<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

impl Figure {
    /// The command that does the same runs and compares them in tables.
    pub fn command(&self) -> String {
        let plan = &self.plan;
        let maps = plan
            .sites
            .iter()
            .map(|site| format!("fixtures/maps/{}.txt", site.name()));
        format!(
            "host-sim compare {} --planners {} --robots {} --place {} --starts {} --sync {} --seed {}",
            maps.collect::<Vec<_>>().join(" "),
            list(&plan.planners),
            list(&plan.robots),
            plan.place,
            plan.starts,
            list(&plan.syncs),
            plan.seed,
        )
    }
}

fn list<T: ToString>(items: &[T]) -> String {
    let items: Vec<String> = items.iter().map(T::to_string).collect();
    items.join(",")
}
