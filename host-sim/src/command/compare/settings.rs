//! The options that say what is run.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use host_sim::experiments::{GivenMap, Metric, Place, Settings, this_program};
use host_sim::planners::PlannerKind;
use host_sim::scenario::{MediumKind, Preset, Trouble, TroubleArgs, parse_share};
use host_sim::world::{Family, ReadOptions, Scale, World, WorldError};
use planner_core::Extent;

use super::Failure;
use crate::command::generate::parse_size;
use crate::command::tell_notes;

/// What a plan file keeps; a merge takes it from there.
#[derive(Args)]
#[group(conflicts_with = "merge")]
pub(super) struct SettingsArgs {
    /// Maps to run in, besides those of --families.
    maps: Vec<PathBuf>,
    /// Planners to compare.
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "explorer,minpos"
    )]
    planners: Vec<PlannerKind>,
    /// Numbers of robots, 1 to 255 each.
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1,3,5,8,10", value_parser = clap::value_parser!(u8).range(1..))]
    robots: Vec<u8>,
    /// How robots are placed.
    #[arg(long, value_name = "HOW", default_value = "random")]
    place: Place,
    /// Placings in each world.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    starts: u32,
    /// What carries messages.
    #[arg(long, value_name = "KIND", default_value = "ideal")]
    medium: MediumKind,
    /// Ticks between two exchanges of maps; 0: never.
    #[arg(long, value_name = "D,…", value_delimiter = ',', default_value = "1")]
    sync: Vec<u32>,
    /// Shares of messages lost, 0 to 1.
    #[arg(long, value_name = "P,…", value_delimiter = ',', default_value = "0", value_parser = parse_share)]
    loss: Vec<f64>,
    /// Sensor ranges in cells, 1 to 31.
    #[arg(long, value_name = "R,…", value_delimiter = ',', default_value = "5", value_parser = clap::value_parser!(u8).range(1..=31))]
    range: Vec<u8>,
    /// Families of worlds to generate.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = families())]
    families: Vec<Families>,
    /// Worlds of each family.
    #[arg(long, value_name = "N", default_value_t = 20)]
    worlds: u64,
    /// Size of generated worlds in cells.
    #[arg(long, value_name = "WxH", default_value = "64x64", value_parser = parse_size)]
    size: Extent,
    /// First seed of the worlds, and seed of placings and losses.
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Keep no row: the tables alone, in little memory however many runs there are.
    #[arg(long)]
    summary_only: bool,
    /// Images: N×N pixels are one cell.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pixels_per_cell: Option<u32>,
    /// What the explorer takes its sensors for.
    #[arg(long, value_name = "NAME", default_value = "truthful")]
    preset: Preset,
}

/// One value of `--families`.
#[derive(Clone)]
struct Families(Vec<Family>);

/// The names, which help and errors list.
fn families() -> impl TypedValueParser<Value = Families> {
    let all = PossibleValue::new("all").help("All of them");
    let each = Family::ALL.iter().filter_map(ValueEnum::to_possible_value);
    PossibleValuesParser::new(each.chain([all])).try_map(|name| match name.as_str() {
        "all" => Ok(Families(Family::ALL.to_vec())),
        name => Family::from_str(name, false).map(|family| Families(vec![family])),
    })
}

impl SettingsArgs {
    /// The settings, and the maps that they name.
    pub(super) fn read(
        &self,
        reference: PlannerKind,
        metric: Metric,
        trouble: TroubleArgs,
    ) -> Result<(Settings, Vec<Arc<World>>), Failure> {
        let maps = self.maps.iter().map(|path| self.read_map(path));
        let maps: Vec<Arc<World>> = maps.collect::<Result<_, _>>()?;
        let families = self.families.iter().flat_map(|families| &families.0);
        let families = once_each(families.copied());
        let mut names: HashSet<String> = HashSet::new();
        for map in &maps {
            if !names.insert(map.name().into()) {
                return Err(format!(
                    "two worlds are called {}: tables could not tell them apart; rename one",
                    map.name()
                )
                .into());
            }
        }
        let settings = Settings {
            maps: maps.iter().map(|map| GivenMap::of(map)).collect(),
            families,
            worlds: self.worlds,
            size: (self.size.width, self.size.height),
            planners: once_each(self.planners.iter().copied().chain([reference])),
            reference,
            robots: once_each(self.robots.iter().copied()),
            place: self.place,
            starts: self.starts,
            medium: self.medium,
            sync: once_each(self.sync.iter().copied()),
            loss: once_each(self.loss.iter().copied()),
            range: once_each(self.range.iter().copied()),
            trouble: trouble.over(Trouble::default()),
            preset: self.preset,
            seed: self.seed,
            metric,
            summary_only: self.summary_only,
            program: this_program()?,
        };
        let plan = settings.plan(maps.iter().cloned());
        if plan.sites.is_empty() {
            return Err("nothing to run in: name maps, or --families".into());
        }
        let generated = &plan.sites[maps.len()..];
        if let Some(twice) = generated.iter().find(|site| names.contains(&site.name())) {
            return Err(format!(
                "two worlds are called {}: tables could not tell them apart; rename the map",
                twice.name()
            )
            .into());
        }
        Ok((settings, maps))
    }

    fn read_map(&self, path: &Path) -> Result<Arc<World>, WorldError> {
        let options = ReadOptions {
            scale: self.pixels_per_cell.map_or(Scale::Pixel, Scale::Pixels),
            ..ReadOptions::default()
        };
        let world = World::read(path, &options)?;
        tell_notes(path, &world);
        Ok(Arc::new(world))
    }
}

/// What was said twice is done once.
fn once_each<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut each = Vec::new();
    for value in values {
        if !each.contains(&value) {
            each.push(value);
        }
    }
    each
}
