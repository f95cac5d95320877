//! A room, and what the robot's hardware would do in it.

use core::cell::Cell;
use core::convert::Infallible;

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::{self, ErrorKind, I2c, NoAcknowledgeSource, Operation};
use embedded_hal::pwm::SetDutyCycle;
use embedded_hal::{digital, pwm};
use planner_core::Direction;

use crate::rangers::CELL_MM;

/// The robot starts on the cell marked 1, looking east. `%` is glass: sensors see through
/// it, and wheels push against it.
const WALLS: [&[u8]; 9] = [
    b"############",
    b"#.....#....#",
    b"#.....#....#",
    b"#..1..#....#",
    b"#.......%..#",
    b"#.....#....#",
    b"####.#######",
    b"#..........#",
    b"############",
];

/// The first sensor that is asked for the second time does not answer, the next one has
/// too weak a signal.
const SILENT_AT: u32 = 4;
const WEAK_AT: u32 = 5;

/// Where the robot is, and what its motors do.
pub(crate) struct Room {
    at: Cell<(usize, usize)>,
    heading: Cell<u8>,
    left_back: Cell<bool>,
    right_back: Cell<bool>,
    duty: Cell<u16>,
    asked: Cell<u32>,
}

/// A side of the robot.
pub(crate) enum Side {
    Left,
    Right,
}

impl Room {
    pub(crate) const fn new() -> Self {
        Self {
            at: Cell::new((3, 3)),
            heading: Cell::new(0),
            left_back: Cell::new(false),
            right_back: Cell::new(false),
            duty: Cell::new(0),
            asked: Cell::new(0),
        }
    }

    pub(crate) const fn bus(&self) -> Bus<'_> {
        Bus(self)
    }

    pub(crate) const fn motor(&self) -> Motor<'_> {
        Motor(&self.duty)
    }

    pub(crate) const fn reverse(&self, side: Side) -> Reverse<'_> {
        Reverse(match side {
            Side::Left => &self.left_back,
            Side::Right => &self.right_back,
        })
    }

    pub(crate) const fn time(&self) -> Time<'_> {
        Time(self)
    }

    /// Turns clockwise.
    fn turn(&self, quarters: u8) {
        self.heading.set((self.heading.get() + quarters) & 3);
    }

    /// The cell beside `at`, unless it is a wall.
    fn beside(at: (usize, usize), heading: u8) -> Option<(usize, usize)> {
        let (dx, dy) = Direction::from_index(heading & 3).delta();
        let x = at.0.checked_add_signed(dx.into())?;
        let y = at.1.checked_add_signed(dy.into())?;
        let wall = WALLS.get(y)?.get(x)?;
        (*wall != b'#').then_some((x, y))
    }

    /// Centimetres from the robot to the wall.
    fn distance(&self, bearing: u8) -> i16 {
        let (mut at, mut millimetres) = (self.at.get(), CELL_MM / 2);
        while let Some(next) = Self::beside(at, self.heading.get() + bearing) {
            at = next;
            millimetres += CELL_MM;
        }
        (millimetres / 10) as i16
    }
}

/// Four TFmini-S on one bus.
pub(crate) struct Bus<'a>(&'a Room);

impl i2c::ErrorType for Bus<'_> {
    type Error = ErrorKind;
}

impl I2c for Bus<'_> {
    fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        let asked = self.0.asked.get();
        self.0.asked.set(asked + 1);
        if asked == SILENT_AT {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        let distance = match asked {
            WEAK_AT => -1,
            _ => self.0.distance(address & 3),
        };
        let [low, high] = distance.to_le_bytes();
        for operation in operations {
            if let Operation::Read(answer) = operation {
                let whole = [0x59, 0x59, low, high, 0, 0, 0, 0, 0];
                for (place, byte) in answer.iter_mut().zip(whole) {
                    *place = byte;
                }
            }
        }
        Ok(())
    }
}

/// A motor; both always get the same power.
pub(crate) struct Motor<'a>(&'a Cell<u16>);

impl pwm::ErrorType for Motor<'_> {
    type Error = Infallible;
}

impl SetDutyCycle for Motor<'_> {
    fn max_duty_cycle(&self) -> u16 {
        100
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.set(duty);
        Ok(())
    }
}

/// The pin that reverses a motor.
pub(crate) struct Reverse<'a>(&'a Cell<bool>);

impl digital::ErrorType for Reverse<'_> {
    type Error = Infallible;
}

impl digital::OutputPin for Reverse<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.set(true);
        Ok(())
    }
}

/// What passes while the motors turn.
pub(crate) struct Time<'a>(&'a Room);

impl DelayNs for Time<'_> {
    fn delay_ns(&mut self, _: u32) {}

    fn delay_ms(&mut self, ms: u32) {
        let room = self.0;
        if room.duty.get() == 0 {
            return;
        }
        let quarters = (ms / crate::wheels::TURN_MS) as u8;
        match (room.left_back.get(), room.right_back.get()) {
            (false, true) => room.turn(quarters),
            (true, false) => room.turn(4 - quarters),
            _ => match Room::beside(room.at.get(), room.heading.get()) {
                Some((x, y)) if WALLS[y][x] == b'%' => {}
                Some(next) => room.at.set(next),
                None => defmt::panic!("drives into a wall"),
            },
        }
    }
}
