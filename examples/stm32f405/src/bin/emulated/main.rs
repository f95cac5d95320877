//! The same robot in a room that is only pretended: its sensors and wheels are played,
//! its planner and main loop are those of `main.rs`. Runs in QEMU, and logs to the
//! host, where `cargo xtask test --only example` reads what it says.
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
mod room;
#[cfg(target_os = "none")]
#[path = "../../wheels.rs"]
mod wheels;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("This is an image for an emulated chip: `cargo xtask test --only example`.");
}

/// The planner's whole memory.
#[cfg(target_os = "none")]
static EXPLORER: static_cell::ConstStaticCell<robot::Robot> =
    static_cell::ConstStaticCell::new(robot::Robot::vacant());

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use defmt_semihosting as _;
    use panic_probe as _;
    use stm32f4xx_hal as _; // the table of its interrupts

    let room = room::Room::new();
    let wheels = wheels::Wheels {
        left: room.motor(),
        right: room.motor(),
        left_back: room.reverse(room::Side::Left),
        right_back: room.reverse(room::Side::Right),
        delay: room.time(),
    };
    let rangers = rangers::Rangers::new(room.bus());
    robot::run(EXPLORER.take(), radio::Silence, rangers, wheels)
}

/// The robot has stopped: the emulation ends.
#[cfg(target_os = "none")]
fn rest() -> ! {
    use cortex_m_semihosting::debug::{EXIT_SUCCESS, exit};

    loop {
        exit(EXIT_SUCCESS);
    }
}
