//! What calls take at worst: the image `worst` runs them in places made for that.

use std::collections::BTreeMap;

use anyhow::{Context, Result, anyhow, bail};

use crate::{budget, firmware, install, shell};

/// Sides of the maps, in cells, and numbers of other robots, that the image tries.
const SIDES: [u32; 3] = [32, 64, 128];
const OTHERS: [u32; 3] = [0, 9, 15];

/// Beams of the scans that it tries.
const BEAMS: [u32; 3] = [4, 16, 64];

/// Sensors, sizes and bodies that the planner among voxels is tried with.
const VOXEL_SETUPS: [&str; 9] = [
    "",
    "_18_levels",
    "_camera",
    "_downward",
    "_lidar",
    "_range_12",
    "_clearance_2",
    "_clearance_3",
    "_errs",
];

/// The worst calls keep to the budget, whatever the map's size and the number of robots.
pub(crate) fn keeps_to_the_budget() -> Result<String> {
    install::qemu()?;
    let output = firmware::build_and_count("worst")?;
    if !output.success() {
        bail!(
            "the image ended with {:?}\n{}",
            output.status,
            output.stderr
        );
    }
    let figures = Figures::read(&output.stdout)?;
    let measured = figures.measured()?;
    let measured: Vec<(&str, u64)> = measured.iter().map(|(name, it)| (&**name, *it)).collect();
    let within = budget::Budget::read(shell::root())
        .and_then(|budget| budget.check("worst_", &measured))
        .map_err(|error| anyhow!(error))?;
    figures.print();
    for line in &within {
        println!("{line}");
    }
    let tick = figures.explorer("tick")?;
    Ok(format!(
        "a tick of the explorer takes at most {tick} instructions"
    ))
}

/// The largest figure of each name.
struct Figures(BTreeMap<String, u64>);

impl Figures {
    fn read(report: &str) -> Result<Self> {
        let mut figures = BTreeMap::new();
        for (name, value) in report.lines().filter_map(|line| line.split_once(": ")) {
            if let Some(name) = name.strip_prefix("worst_") {
                let value: u64 = value.parse().with_context(|| name.to_owned())?;
                let largest = figures.entry(name.to_owned()).or_default();
                *largest = value.max(*largest);
            }
        }
        Ok(Self(figures))
    }

    fn figure(&self, name: &str) -> Result<u64> {
        let figure = self.0.get(name).copied();
        figure.with_context(|| format!("the image does not report {name}"))
    }

    fn of_explorer(&self, side: u32, others: u32, what: &str) -> Result<u64> {
        self.figure(&format!("explorer_{side}_others_{others}_{what}"))
    }

    /// The most over all maps and numbers of robots.
    fn explorer(&self, what: &str) -> Result<u64> {
        let mut most = 0;
        for (side, others) in pairs() {
            most = most.max(self.of_explorer(side, others, what)?);
        }
        Ok(most)
    }

    /// How much larger the largest figure is than the least, in thousandths.
    fn growth(figures: &[u64]) -> u64 {
        let (least, most) = (figures.iter().min(), figures.iter().max());
        match (least, most) {
            (Some(&least), Some(&most)) if least > 0 => ((most - least) * 1000).div_ceil(least),
            _ => 0,
        }
    }

    /// By the names of `fixtures/budget.txt`.
    fn measured(&self) -> Result<Vec<(String, u64)>> {
        let mut measured = Vec::new();
        let mut stack = 0;
        for call in ["observe", "tick", "transmit", "receive"] {
            measured.push((
                format!("worst_explorer_{call}_instructions"),
                self.explorer(call)?,
            ));
            stack = stack.max(self.explorer(&format!("{call}_stack"))?);
        }
        measured.push(("worst_explorer_stack_bytes".into(), stack));
        let mut by_side = 0;
        // On the smallest map a whole search takes less than a slice.
        for others in OTHERS {
            let ticks = [64, 128].map(|side| self.of_explorer(side, others, "tick"));
            let ticks = ticks.into_iter().collect::<Result<Vec<_>>>()?;
            by_side = by_side.max(Self::growth(&ticks));
        }
        measured.push(("worst_explorer_growth_by_map_permille".into(), by_side));
        let ticks = [0, 9].map(|others| self.of_explorer(128, others, "tick"));
        let ticks = ticks.into_iter().collect::<Result<Vec<_>>>()?;
        let by_robots = Self::growth(&ticks);
        measured.push(("worst_explorer_growth_by_robots_permille".into(), by_robots));
        for beams in BEAMS {
            measured.push((
                format!("worst_sighting_{beams}_beams_instructions"),
                self.figure(&format!("sighting_{beams}_beams"))?,
            ));
        }
        measured.push((
            "worst_cao_step_instructions".into(),
            self.figure("cao_step")?,
        ));
        let mut stack = 0;
        for setup in VOXEL_SETUPS {
            let calls: &[&str] = match setup {
                "" => &["observe", "tick", "transmit", "receive"],
                "_errs" => &["observe"],
                _ => &["tick"],
            };
            for call in calls {
                let name = format!("voxel_survey{setup}_{call}");
                let measure = format!("worst_{name}_instructions");
                measured.push((measure, self.figure(&name)?));
                stack = stack.max(self.figure(&format!("{name}_stack"))?);
            }
        }
        measured.push(("worst_voxel_survey_stack_bytes".into(), stack));
        let (work, bound) = (self.explorer("work")?, self.explorer("work_bound")?);
        if work > bound {
            bail!("a tick of the explorer counts {work} of work; Config::work_bound says {bound}");
        }
        Ok(measured)
    }

    fn print(&self) {
        println!("map, robots    largest tick: instructions    work of its bound");
        for (side, others) in pairs() {
            let figure = |what| self.of_explorer(side, others, what).unwrap_or_default();
            println!(
                "{side:>3}²   {:>2} {:>36} {:>10} of {}",
                others + 1,
                figure("tick"),
                figure("work"),
                figure("work_bound")
            );
        }
    }
}

fn pairs() -> impl Iterator<Item = (u32, u32)> {
    SIDES
        .into_iter()
        .flat_map(|side| OTHERS.map(|others| (side, others)))
}
