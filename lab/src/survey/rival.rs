//! What a second survey beside the first has otherwise.

use std::fmt;

use clap::ValueEnum;
use host_sim::scenario::{heights, voxels};
use host_sim::scene::Sensor;

use super::SurveySetup;

/// A planner or a sensor that is compared with the first, over the same terrain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rival {
    /// A planner over heights.
    OverHeights(heights::Planner),
    /// A planner among voxels.
    AmongVoxels(voxels::Planner),
    /// A sensor, with the same planner.
    Sensor(Sensor),
}

impl fmt::Display for Rival {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OverHeights(planner) => planner.fmt(f),
            Self::AmongVoxels(planner) => planner.fmt(f),
            Self::Sensor(sensor) => sensor.fmt(f),
        }
    }
}

impl SurveySetup {
    /// All that it can be compared with.
    pub fn rivals(&self) -> Vec<Rival> {
        fn all<T: ValueEnum + Copy + 'static>(
            rival: fn(T) -> Rival,
        ) -> impl Iterator<Item = Rival> {
            T::value_variants().iter().copied().map(rival)
        }
        let mut rivals = Vec::new();
        match (self.is_drawn(), self.is_of_voxels()) {
            (false, _) => {}
            (true, true) => rivals.extend(all(Rival::AmongVoxels)),
            (true, false) => rivals.extend(all(Rival::OverHeights)),
        }
        if self.is_drawn() && self.has_sensors() {
            rivals.extend(all(Rival::Sensor));
        }
        rivals
    }

    /// The same, with what the rival has.
    #[must_use]
    pub fn with(&self, rival: Rival) -> Self {
        let mut other = self.clone();
        match rival {
            Rival::OverHeights(planner) => other.planner = planner,
            Rival::AmongVoxels(planner) => other.voxel_planner = planner,
            Rival::Sensor(sensor) => other.sensor = sensor,
        }
        other.tidied()
    }

    /// What tells it from others over the same terrain: the planner, and the sensor if it
    /// does not show all round.
    pub fn title(&self) -> String {
        let planner = match self.is_of_voxels() {
            true => self.voxel_planner.to_string(),
            false => self.planner.to_string(),
        };
        match self.sensor {
            Sensor::AllRound => planner,
            sensor => format!("{planner}, {sensor}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use host_sim::terrain::TerrainSource;

    use super::super::setup::tests::{compared, filmed, unusual};
    use super::*;

    /// Whatever it can be compared with can be flown, by a command of its own.
    #[test]
    fn rivals_can_be_flown_and_have_titles() {
        for setup in [unusual(), filmed(), compared()] {
            let mut titles = Vec::new();
            for rival in setup.rivals() {
                let other = setup.with(rival);
                assert_eq!(
                    SurveySetup::from_address(&other.address()),
                    Ok(other.clone())
                );
                assert!(
                    super::super::SurveyScene::new(other.clone()).is_ok(),
                    "{rival}"
                );
                assert_eq!(other.terrain, setup.terrain);
                titles.push(other.title());
            }
            assert!(titles.contains(&setup.title()), "{titles:?}");
        }
        assert_eq!(filmed().title(), "voxel-survey, camera");
        let rival = Rival::AmongVoxels(voxels::Planner::Greedy);
        assert_eq!(filmed().with(rival).title(), "greedy");
        assert!(!compared().rivals().contains(&Rival::Sensor(Sensor::Lidar)));
        let elsewhere = SurveySetup {
            terrain: TerrainSource::File("elsewhere".into()),
            ..unusual()
        };
        assert_eq!(elsewhere.rivals(), []);
    }
}
