//! A robot to start from: the planner in the main loop of an STM32F405.
//!
//! Four distance sensors look ahead, right, back and left; two wheels drive. To
//! make it your robot, change the wiring here, `rangers` for another sensor and
//! `wheels` for other motors: both need nothing but traits of `embedded-hal`.
//! `docs/porting.md` tells more.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod radio;
#[cfg(target_os = "none")]
mod rangers;
#[cfg(target_os = "none")]
mod robot;
#[cfg(target_os = "none")]
mod wheels;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("This is an image for the chip; flash it with `probe-rs run --chip STM32F405RG`.");
}

/// The planner's whole memory.
#[cfg(target_os = "none")]
static EXPLORER: static_cell::ConstStaticCell<robot::Robot> =
    static_cell::ConstStaticCell::new(robot::Robot::vacant());

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use defmt_rtt as _;
    use panic_probe as _;
    use stm32f4xx_hal::i2c::I2c;
    use stm32f4xx_hal::pac;
    use stm32f4xx_hal::prelude::*;

    let (Some(chip), Some(core)) = (pac::Peripherals::take(), cortex_m::Peripherals::take()) else {
        defmt::unreachable!("nobody has taken them before");
    };
    let clocks = chip
        .RCC
        .constrain()
        .cfgr
        .use_hse(8.MHz())
        .sysclk(168.MHz())
        .freeze();
    let (port_a, port_b) = (chip.GPIOA.split(), chip.GPIOB.split());
    let bus = I2c::new(chip.I2C1, (port_b.pb8, port_b.pb9), 400.kHz(), &clocks);
    let (_, (left, right, ..)) = chip.TIM3.pwm_hz(20.kHz(), &clocks);
    let (mut left, mut right) = (left.with(port_a.pa6), right.with(port_a.pa7));
    left.enable();
    right.enable();
    let wheels = wheels::Wheels {
        left,
        right,
        left_back: port_b.pb0.into_push_pull_output(),
        right_back: port_b.pb1.into_push_pull_output(),
        delay: core.SYST.delay(&clocks),
    };
    let rangers = rangers::Rangers::new(bus);
    robot::run(EXPLORER.take(), radio::Silence, rangers, wheels)
}

/// The robot has stopped, for good.
#[cfg(target_os = "none")]
fn rest() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}
