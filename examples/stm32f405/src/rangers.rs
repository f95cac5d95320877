//! Four TFmini-S distance sensors on one I²C bus.

use core::f32::consts::FRAC_PI_2;

use embedded_hal::i2c::I2c;
use planner_core::sight::Beam;

/// Side of a cell in millimetres. All robots of a fleet use the same.
pub(crate) const CELL_MM: u16 = 250;

/// How far a sensor sees indoors, in cells.
pub(crate) const MAX_RANGE: f32 = 5.0;

/// The addresses that the sensors were given: ahead, right, back, left.
const ADDRESSES: [u8; 4] = [0x10, 0x11, 0x12, 0x13];

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
        let mut bearing = -FRAC_PI_2;
        ADDRESSES.map(|address| {
            bearing += FRAC_PI_2;
            let range = self.measure(address).unwrap_or_else(|error| {
                defmt::warn!("sensor {=u8:#x}: {}", address, defmt::Debug2Format(&error));
                f32::NAN
            });
            Beam { bearing, range }
        })
    }

    /// A distance in cells; infinite where nothing reflects.
    fn measure(&mut self, address: u8) -> Result<f32, B::Error> {
        let mut answer = [0; 9];
        self.bus.write_read(address, &GET_DISTANCE, &mut answer)?;
        let [_, _, low, high, ..] = answer;
        Ok(match u16::from_le_bytes([low, high]) {
            0 => f32::INFINITY,
            centimetres => f32::from(centimetres) * 10.0 / f32::from(CELL_MM),
        })
    }
}
