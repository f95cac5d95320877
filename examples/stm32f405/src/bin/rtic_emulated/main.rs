//! The application of RTIC in the room of `emulated`. Its modem is played: the interrupt of
//! the timer brings, byte by byte, the frames of a second robot that has seen the other end of
//! the room. `cargo xtask test --only example` reads what it logs.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../../radio.rs"]
mod radio;
#[cfg(target_os = "none")]
#[path = "../../rangers.rs"]
mod rangers;
#[cfg(target_os = "none")]
#[path = "../../robot.rs"]
mod robot;
#[cfg(target_os = "none")]
#[path = "../emulated/room.rs"]
mod room;
#[cfg(target_os = "none")]
#[path = "../../wheels.rs"]
mod wheels;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("This is an image for an emulated chip: `cargo xtask test --only example`.");
}

#[cfg(target_os = "none")]
#[rtic::app(device = stm32f4xx_hal::pac)]
mod app {
    use core::convert::Infallible;

    use cortex_m::peripheral::syst::SystClkSource;
    use defmt_semihosting as _;
    use embedded_hal_nb::serial::{ErrorType, Write};
    use panic_probe as _;
    use planner_core::radio::MAX_LEN;
    use planner_core::sight::look;
    use planner_core::{Cell, Planner, RobotId};

    use crate::radio::{Frames, Modem, Receiver, encode};
    use crate::rangers::Rangers;
    use crate::robot::{self, EXTENT, Robot, START};
    use crate::room::{Room, Side};
    use crate::wheels::Wheels;

    /// So many cycles between two frames of the other robot.
    const PERIOD: u32 = 1_000_000;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        explorer: &'static mut Robot,
        other: &'static mut Robot,
        modem: Option<Modem<Air>>,
        receiver: Receiver,
    }

    #[init(local = [
        planner: Robot = Robot::vacant(),
        stranger: Robot = Robot::vacant(),
        frames: Frames = Frames::new(),
    ])]
    fn init(context: init::Context) -> (Shared, Local) {
        let mut clock = context.core.SYST;
        clock.set_clock_source(SystClkSource::Core);
        clock.set_reload(PERIOD);
        clock.clear_current();
        clock.enable_counter();
        clock.enable_interrupt();
        let other = context.local.stranger;
        let place = Cell::new(START.x + 5, START.y);
        if let Err(error) = other.reset(robot::config(), RobotId(1), EXTENT, place) {
            defmt::panic!("{}", error);
        }
        // The room in the east, with its door.
        let is_wall = |cell: Cell| cell.x <= START.x + 3 && cell.y != START.y + 1;
        other.observe(&look(place, 2, is_wall));
        let (producer, frames) = context.local.frames.split();
        let local = Local {
            explorer: context.local.planner,
            other,
            modem: Some(Modem {
                frames,
                sender: Air,
            }),
            receiver: Receiver::new(producer),
        };
        (Shared {}, local)
    }

    #[idle(local = [explorer, modem])]
    fn idle(context: idle::Context) -> ! {
        let Some(modem) = context.local.modem.take() else {
            defmt::unreachable!("idle begins once");
        };
        let room = Room::new();
        let wheels = Wheels {
            left: room.motor(),
            right: room.motor(),
            left_back: room.reverse(Side::Left),
            right_back: room.reverse(Side::Right),
            delay: room.time(),
        };
        robot::run(
            context.local.explorer,
            modem,
            Rangers::new(room.bus()),
            wheels,
        )
    }

    #[task(binds = SysTick, local = [other, receiver], priority = 2)]
    fn listen(context: listen::Context) {
        let mut buffer = [0; MAX_LEN];
        context.local.other.tick();
        while let Some(length) = context.local.other.transmit(&mut buffer) {
            let frame = buffer.get(..length).unwrap_or(&[]);
            for &byte in encode(frame).iter().chain(&[0]) {
                context.local.receiver.take(byte);
            }
        }
    }

    /// Nobody hears what is sent.
    pub struct Air;

    impl ErrorType for Air {
        type Error = Infallible;
    }

    impl Write<u8> for Air {
        fn write(&mut self, _: u8) -> nb::Result<(), Infallible> {
            Ok(())
        }

        fn flush(&mut self) -> nb::Result<(), Infallible> {
            Ok(())
        }
    }
}

/// The robot has stopped: the emulation ends.
#[cfg(target_os = "none")]
fn rest() -> ! {
    use cortex_m_semihosting::debug::{EXIT_SUCCESS, exit};

    loop {
        exit(EXIT_SUCCESS);
    }
}
