//! The robot on an RP2040, which has no radio: frames go to a modem on UART0, and to a
//! modem that carries bytes.
#![no_std]
#![no_main]

use defmt_rtt as _;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_rp::gpio::{Level, Output};
use embassy_rp::interrupt::{self, InterruptExt, Priority};
use embassy_rp::uart::{
    BufferedInterruptHandler, BufferedUart, BufferedUartRx, BufferedUartTx, Config,
};
use embassy_rp::{bind_interrupts, peripherals};
use embassy_time::Timer;
use embedded_io_async::{Read, Write};
use panic_probe as _;
use planner_core::radio::MAX_LEN;
use planner_core::sight::Zone;
use planner_core::{Cell, Direction, RobotId};
use robot::{Frame, Place, Wheels, Zones};
use static_cell::ConstStaticCell;

bind_interrupts!(struct Irqs {
    UART0_IRQ => BufferedInterruptHandler<peripherals::UART0>;
});

/// The executor of the radio: it interrupts the planner.
static URGENT: InterruptExecutor = InterruptExecutor::new();

#[cortex_m_rt::interrupt]
fn SWI_IRQ_1() {
    // The handler of the interrupt that this executor was started with.
    unsafe { URGENT.on_interrupt() }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    static SENT: ConstStaticCell<[u8; 128]> = ConstStaticCell::new([0; 128]);
    static HEARD: ConstStaticCell<[u8; 256]> = ConstStaticCell::new([0; 256]);

    let chip = embassy_rp::init(Default::default());
    interrupt::SWI_IRQ_1.set_priority(Priority::P2);
    let urgent = URGENT.start(interrupt::SWI_IRQ_1);
    let mut config = Config::default();
    config.baudrate = 57_600;
    let uart = BufferedUart::new(
        chip.UART0,
        chip.PIN_0,
        chip.PIN_1,
        Irqs,
        SENT.take(),
        HEARD.take(),
        config,
    );
    let (sender, receiver) = uart.split();
    urgent.spawn(defmt::unwrap!(listen(Modem {
        sender,
        receiver,
        heard: [0; MAX_CODED],
        length: 0,
    })));
    spawner.spawn(defmt::unwrap!(measure(Front)));
    let wheels = Wheels::new(
        [
            Output::new(chip.PIN_10, Level::Low),
            Output::new(chip.PIN_11, Level::Low),
        ],
        [
            Output::new(chip.PIN_12, Level::Low),
            Output::new(chip.PIN_13, Level::Low),
        ],
    );
    let place = Place {
        id: RobotId(0),
        start: Cell::new(32, 32),
        heading: Direction::East,
    };
    robot::planner(place, wheels).await;
}

#[embassy_executor::task]
async fn listen(radio: Modem) {
    robot::radio(radio).await
}

#[embassy_executor::task]
async fn measure(front: Front) {
    robot::sensor(front).await
}

/// Bytes of a frame in COBS, with the zero that ends it.
const MAX_CODED: usize = MAX_LEN + 2;

/// A modem that sends every byte to all others. It knows no frames: they are told apart by a
/// zero, which COBS keeps out of them.
struct Modem {
    sender: BufferedUartTx,
    receiver: BufferedUartRx,
    /// What has come in of the next frame.
    heard: [u8; MAX_CODED],
    length: usize,
}

impl robot::Radio for Modem {
    async fn send(&mut self, frame: &[u8]) {
        let mut coded = [0; MAX_CODED];
        let length = cobs::encode(frame, &mut coded);
        let coded = coded.get(..=length).unwrap_or(&[]);
        if self.sender.write_all(coded).await.is_err() {
            defmt::debug!("a frame is lost");
        }
    }

    async fn receive(&mut self) -> Frame {
        loop {
            let mut byte = [0];
            if self.receiver.read(&mut byte).await.is_err() {
                self.length = 0;
                continue;
            }
            let [byte] = byte;
            if byte != 0 {
                // What is longer than a frame is none: it ends with the next zero.
                if let Some(place) = self.heard.get_mut(self.length) {
                    *place = byte;
                    self.length += 1;
                }
                continue;
            }
            let length = core::mem::take(&mut self.length);
            let mut frame = [0; MAX_CODED];
            let coded = self.heard.get(..length).unwrap_or(&[]);
            if let Ok(report) = cobs::decode(coded, &mut frame)
                && let Some(bytes) = frame.get(..report.frame_size())
                && let Ok(frame) = Frame::from_slice(bytes)
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
