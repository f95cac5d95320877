//! How many ticks a second can be shown, without a window: 100 robots on 256×256 cells,
//! or the scenario of an address; so many ticks of it at most; and with one of its robots
//! selected.
//!
//! ```sh
//! cargo run --release -p lab --no-default-features --example measure
//! ```

use std::fmt::Write;

use egui::epaint::{ClippedPrimitive, Primitive};
use egui::{Pos2, RawInput, Rect, vec2};

use lab::App;
use lab::platform::Stopwatch;
use lab::playback::{Playback, Verdict};

const CROWD: &str = "map=generate:rooms:256x256:1&robots=100&start=random";

fn main() {
    let address = std::env::args().nth(1).unwrap_or_else(|| CROWD.into());
    let mut app = App::from_address(&address);
    let number = |place| std::env::args().nth(place)?.parse().ok();
    let most = number(2);
    app.selected = number(3);
    println!("{}", measure(app, most.unwrap_or(usize::MAX)));
}

/// Plays the lab's scenario to its end, one tick a frame, with everything that a frame
/// takes but the graphics card: the tick, the layout, and the triangles. Tells the usual
/// and the slowest frames, and what the parts cost the processor, which does not depend on
/// what else the machine does.
fn measure(mut app: App, most: usize) -> String {
    let context = egui::Context::default();
    let mut frames = Vec::new();
    let mut triangles = 0;
    // Tick, layout, triangles.
    let mut parts = [0.0; 3];
    app.playing = false;
    let whole = Stopwatch::start();
    while frames.len() < most
        && app
            .runs
            .iter()
            .any(|run| run.watch.verdict() == Verdict::Running)
    {
        let clock = Stopwatch::start();
        let mut begin = processor();
        let mut part = |index: usize| {
            let end = processor();
            parts[index] += end - begin;
            begin = end;
        };
        app.tick();
        part(0);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 800.0))),
            ..RawInput::default()
        };
        let mut output = context.run_ui(input, |ui| app.ui(ui));
        part(1);
        // Nobody wants the textures.
        output.textures_delta.clear();
        let shapes = context.tessellate(output.shapes, output.pixels_per_point);
        part(2);
        frames.push(clock.seconds());
        triangles = triangles.max(shapes.iter().map(count).sum());
    }
    let seconds = whole.seconds();
    frames.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let index = (frames.len() as f64 * share) as usize;
        1000.0
            * frames
                .get(index.min(frames.len().saturating_sub(1)))
                .unwrap_or(&0.0)
    };
    let mut text = String::new();
    let ticks = frames.len();
    let [tick, layout, tessellation] = parts.map(|part| 1000.0 * part / ticks.max(1) as f64);
    let _ = write!(
        text,
        "{ticks} ticks shown in {seconds:.1} s: {:.0} a second; a frame takes {:.1} ms in the \
         median, {:.1} ms at most for 99 of 100, {:.1} ms at most; up to {triangles} triangles; processor, a frame: \
         tick {tick:.2} ms, layout {layout:.2} ms, triangles {tessellation:.2} ms",
        ticks as f64 / seconds,
        at(0.5),
        at(0.99),
        at(1.0),
    );
    text
}

/// Seconds of processor time of this thread; 0 where the system does not tell.
fn processor() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split(' ').next().and_then(|first| first.parse().ok());
    nanoseconds.unwrap_or(0.0) / 1e9
}

fn count(shape: &ClippedPrimitive) -> usize {
    match &shape.primitive {
        Primitive::Mesh(mesh) => mesh.indices.len() / 3,
        Primitive::Callback(_) => 0,
    }
}
