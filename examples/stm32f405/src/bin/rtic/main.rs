//! The robot of `main.rs` as an application of RTIC, with a modem on USART2 (PA2 sends,
//! PA3 receives).
//!
//! Two priorities: `idle` is the main loop, which owns the planner and takes its time, above
//! all while the wheels turn; `listen` is the interrupt of the modem, which goes before it and
//! puts frames into a queue. The planner is a local resource of `idle`, so that nobody else
//! can call it.
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
#[path = "../../wheels.rs"]
mod wheels;

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("This is an image for the chip; flash it with `probe-rs run --chip STM32F405RG`.");
}

#[cfg(target_os = "none")]
#[rtic::app(device = stm32f4xx_hal::pac)]
mod app {
    use defmt_rtt as _;
    use panic_probe as _;
    use stm32f4xx_hal::gpio::{Output, PB0, PB1};
    use stm32f4xx_hal::i2c::I2c;
    use stm32f4xx_hal::pac::{I2C1, TIM3, USART2};
    use stm32f4xx_hal::prelude::*;
    use stm32f4xx_hal::serial::{Rx, Tx};
    use stm32f4xx_hal::timer::{PwmChannel, SysDelay};

    use crate::radio::{Frames, Modem, Receiver};
    use crate::rangers::Rangers;
    use crate::robot::{self, Robot};
    use crate::wheels::Wheels;

    type Motors =
        Wheels<PwmChannel<TIM3, 0>, PwmChannel<TIM3, 1>, PB0<Output>, PB1<Output>, SysDelay>;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        explorer: &'static mut Robot,
        modem: Option<Modem<Tx<USART2>>>,
        rangers: Option<Rangers<I2c<I2C1>>>,
        motors: Option<Motors>,
        bytes: Rx<USART2>,
        receiver: Receiver,
    }

    #[init(local = [planner: Robot = Robot::vacant(), frames: Frames = Frames::new()])]
    fn init(context: init::Context) -> (Shared, Local) {
        let (chip, core) = (context.device, context.core);
        let clocks = chip
            .RCC
            .constrain()
            .cfgr
            .use_hse(8.MHz())
            .sysclk(168.MHz())
            .freeze();
        let (port_a, port_b) = (chip.GPIOA.split(), chip.GPIOB.split());
        let serial = chip
            .USART2
            .serial((port_a.pa2, port_a.pa3), 57_600.bps(), &clocks);
        let Ok(serial) = serial else {
            defmt::panic!("the clock gives no 57,600 bits a second");
        };
        let (sender, mut bytes) = serial.split();
        bytes.listen();
        let bus = I2c::new(chip.I2C1, (port_b.pb8, port_b.pb9), 400.kHz(), &clocks);
        let (_, (left, right, ..)) = chip.TIM3.pwm_hz(20.kHz(), &clocks);
        let (mut left, mut right) = (left.with(port_a.pa6), right.with(port_a.pa7));
        left.enable();
        right.enable();
        let motors = Wheels {
            left,
            right,
            left_back: port_b.pb0.into_push_pull_output(),
            right_back: port_b.pb1.into_push_pull_output(),
            delay: core.SYST.delay(&clocks),
        };
        let (producer, frames) = context.local.frames.split();
        let local = Local {
            explorer: context.local.planner,
            modem: Some(Modem { frames, sender }),
            rangers: Some(Rangers::new(bus)),
            motors: Some(motors),
            bytes,
            receiver: Receiver::new(producer),
        };
        (Shared {}, local)
    }

    #[idle(local = [explorer, modem, rangers, motors])]
    fn idle(context: idle::Context) -> ! {
        let local = context.local;
        let parts = (
            local.modem.take(),
            local.rangers.take(),
            local.motors.take(),
        );
        let (Some(modem), Some(rangers), Some(motors)) = parts else {
            defmt::unreachable!("idle begins once");
        };
        robot::run(local.explorer, modem, rangers, motors)
    }

    #[task(binds = USART2, local = [bytes, receiver], priority = 2)]
    fn listen(context: listen::Context) {
        while let Ok(byte) = context.local.bytes.read() {
            context.local.receiver.take(byte);
        }
    }
}

/// The robot has stopped, for good. It goes on listening.
#[cfg(target_os = "none")]
fn rest() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}
