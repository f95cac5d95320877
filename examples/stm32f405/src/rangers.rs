//! Four TFmini-S distance sensors on one I²C bus.

use embedded_hal::i2c::I2c;
use planner_core::sight::{Beam, Bearing, RangeSensor};

/// Side of a cell in millimetres. All robots of a fleet use the same.
pub(crate) const CELL_MM: u16 = 250;

/// What the sensors can do. Of their 12 metres the map is filled as far as 5 cells: a
/// wall beyond is "nothing within reach". They err by 60 mm and the robot is where it
/// believes to be: 60 mm / 250 mm.
pub(crate) const SENSOR: RangeSensor = RangeSensor {
    max_range: 5.0,
    tolerance: 0.24,
};

/// The addresses that the sensors were given, and where they look.
const MOUNTED: [(u8, Bearing); 4] = [
    (0x10, Bearing::AHEAD),
    (0x11, Bearing::RIGHT),
    (0x12, Bearing::BACK),
    (0x13, Bearing::LEFT),
];

/// Asks for a distance in centimetres [TFmini-S manual, §7.4].
const GET_DISTANCE: [u8; 5] = [0x5a, 0x05, 0x00, 0x01, 0x60];

/// The four sensors.
pub(crate) struct Rangers<B> {
    bus: B,
}

impl<B: I2c> Rangers<B> {
    pub(crate) fn new(bus: B) -> Self {
        Self { bus }
    }

    /// One beam for each sensor. A sensor that does not answer has measured
    /// nothing: the planner leaves such a beam out.
    pub(crate) fn scan(&mut self) -> [Beam; 4] {
        MOUNTED.map(|(address, bearing)| Beam {
            bearing,
            range: self.range(address),
        })
    }

    /// Distances ahead and behind, in cells; not a number, if there is no measurement.
    pub(crate) fn along(&mut self) -> (f32, f32) {
        let [(ahead, _), _, (behind, _), _] = MOUNTED;
        (self.range(ahead), self.range(behind))
    }

    fn range(&mut self, address: u8) -> f32 {
        self.measure(address).unwrap_or_else(|error| {
            defmt::warn!("sensor {=u8:#x}: {}", address, defmt::Debug2Format(&error));
            f32::NAN
        })
    }

    /// A distance in cells. Not a number, if there is no measurement: below 0 the sensor
    /// tells of a weak signal (-1), a saturated one (-2) or too much light (-4)
    /// [TFmini-S manual, table 8]. A black wall gives a weak signal too, so that is not
    /// "nothing within reach".
    fn measure(&mut self, address: u8) -> Result<f32, B::Error> {
        let mut answer = [0; 9];
        self.bus.write_read(address, &GET_DISTANCE, &mut answer)?;
        let [_, _, low, high, ..] = answer;
        Ok(match i16::from_le_bytes([low, high]) {
            ..=0 => f32::NAN,
            centimetres => f32::from(centimetres) * 10.0 / f32::from(CELL_MM),
        })
    }
}
