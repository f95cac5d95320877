//! The robot on an nRF52840: its own radio, IEEE 802.15.4 on channel 20.
#![no_std]
#![no_main]

use defmt_rtt as _;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_nrf::gpio::{AnyPin, Level, Output, OutputDrive};
use embassy_nrf::interrupt::{self, InterruptExt, Priority};
use embassy_nrf::radio::ieee802154::{Packet, Radio};
use embassy_nrf::{Peri, bind_interrupts, peripherals, radio};
use embassy_time::Timer;
use panic_probe as _;
use planner_core::sight::Zone;
use planner_core::{Cell, Direction, RobotId};
use robot::{Frame, Place, Wheels, Zones};

bind_interrupts!(struct Irqs {
    RADIO => radio::InterruptHandler<peripherals::RADIO>;
});

/// The executor of the radio: it interrupts the planner.
static URGENT: InterruptExecutor = InterruptExecutor::new();

#[cortex_m_rt::interrupt]
fn EGU1_SWI1() {
    // The handler of the interrupt that this executor was started with.
    unsafe { URGENT.on_interrupt() }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let chip = embassy_nrf::init(Default::default());
    interrupt::EGU1_SWI1.set_priority(Priority::P6);
    let urgent = URGENT.start(interrupt::EGU1_SWI1);
    let mut radio = Radio::new(chip.RADIO, Irqs);
    radio.set_channel(20);
    urgent.spawn(defmt::unwrap!(listen(Air(radio))));
    spawner.spawn(defmt::unwrap!(measure(Front)));
    let pin = |pin: Peri<'static, AnyPin>| Output::new(pin, Level::Low, OutputDrive::Standard);
    let wheels = Wheels::new(
        [pin(chip.P0_03.into()), pin(chip.P0_04.into())],
        [pin(chip.P0_28.into()), pin(chip.P0_29.into())],
    );
    let place = Place {
        id: RobotId(0),
        start: Cell::new(32, 32),
        heading: Direction::East,
    };
    robot::planner(place, wheels).await;
}

#[embassy_executor::task]
async fn listen(radio: Air) {
    robot::radio(radio).await
}

#[embassy_executor::task]
async fn measure(front: Front) {
    robot::sensor(front).await
}

/// Frames are the whole payload, without addresses: whatever else is on the channel, the
/// planner refuses.
struct Air(Radio<'static>);

impl robot::Radio for Air {
    async fn send(&mut self, frame: &[u8]) {
        let mut packet = Packet::new();
        packet.copy_from_slice(frame);
        if self.0.try_send(&mut packet).await.is_err() {
            defmt::debug!("the channel is in use: a frame is lost");
        }
    }

    async fn receive(&mut self) -> Frame {
        loop {
            let mut packet = Packet::new();
            // An error is a wrong checksum, or something longer than a frame.
            if self.0.receive(&mut packet).await.is_ok()
                && let Ok(frame) = Frame::from_slice(&packet)
            {
                return frame;
            }
        }
    }
}

/// The driver of your sensor comes here. For a VL53L5CX that is ST's, which the crate
/// `vl53l5cx-uld` wraps: take the status and the distance of each zone through
/// [`Zone::from_vl53`]. Until then no zone says anything, and the robot stays where it is.
struct Front;

impl Zones for Front {
    async fn measure(&mut self) -> [Zone; 64] {
        Timer::after_millis(66).await;
        [Zone::Invalid; 64]
    }
}
