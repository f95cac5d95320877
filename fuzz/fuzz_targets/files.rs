//! Arbitrary bytes as maps, as the two files of a map_server map, and as traces.
#![no_main]

use std::path::Path;

use host_sim::draw;
use host_sim::record::TraceError;
use host_sim::record::grid::Trace;
use host_sim::world::{Problem, ReadOptions, Scale, World};
use libfuzzer_sys::fuzz_target;

/// Between the YAML file and its image in one input.
const BORDER: &[u8] = b"\n---image---\n";

fuzz_target!(|input: &[u8]| {
    let Some((&kind, bytes)) = input.split_first() else {
        return;
    };
    let scale = match kind >> 4 {
        0..8 => Scale::Pixel,
        8..12 => Scale::Pixels(u32::from(kind >> 4) - 7),
        _ => Scale::Metres(f64::from(kind >> 4) / 10.0),
    };
    match kind & 0xf {
        0 | 1 => trace(bytes),
        2 => map("a.png", bytes, scale),
        3 => map("a.txt", bytes, scale),
        4 => map("a.map", bytes, scale),
        5 => map("a.unknown", bytes, scale),
        _ => map("a.yaml", bytes, scale),
    }
});

/// A world that was read keeps its promises, and comes back from text as it was.
fn map(name: &str, bytes: &[u8], scale: Scale) {
    let border = bytes.windows(BORDER.len()).position(|part| part == BORDER);
    let (file, image) = match border {
        Some(at) => (&bytes[..at], &bytes[at + BORDER.len()..]),
        None => (bytes, &[][..]),
    };
    let open = |path: &Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        match name.rsplit('.').next() {
            _ if path == Path::new("a.yaml") => Ok(file.to_vec()),
            Some("pgm" | "png") if name != "gone.pgm" => Ok(image.to_vec()),
            _ => Err(Problem::Missing),
        }
    };
    let options = ReadOptions {
        scale,
        ..ReadOptions::default()
    };
    let read = match name {
        "a.yaml" => World::read_with(name, &options, open),
        _ => World::read_with(name, &options, |_: &Path| Ok(bytes.to_vec())),
    };
    match read {
        Ok(world) => {
            assert!(world.free_cells().next().is_some());
            let text = world.to_text();
            let again = World::read_with("a.txt", &ReadOptions::default(), |_: &Path| {
                Ok(text.clone().into_bytes())
            });
            let again = again.expect("what is written can be read");
            assert!(again.free_cells().eq(world.free_cells()));
            world.notes().iter().for_each(|note| is_printable(note));
        }
        Err(error) => is_printable(&error.to_string()),
    }
}

/// What was read can be drawn. The count and the digest in the header are mended first:
/// nobody finds a digest by chance.
fn trace(bytes: &[u8]) {
    let mut text = String::from_utf8_lossy(bytes).into_owned();
    for _ in 0..3 {
        match Trace::read(text.as_bytes()) {
            Err(TraceError::Records { expected, found }) => {
                let (wrong, right) = (
                    format!("\"records\":{expected}"),
                    format!("\"records\":{found}"),
                );
                text = text.replacen(&wrong, &right, 1);
            }
            Err(TraceError::Digest { expected, found }) => {
                text = text.replacen(&expected, &found, 1);
            }
            Err(error) => return is_printable(&error.to_string()),
            Ok(trace) => {
                if trace.ticks() < 100 && trace.scenario.world.extent().cells() < 1_000 {
                    draw::animation(&trace, std::io::sink()).expect("a sink takes everything");
                    let coverage = draw::Coverage::from(&trace);
                    coverage.write_csv(std::io::sink()).expect("a sink takes everything");
                }
                return;
            }
        }
    }
}

/// An error quotes little, and nothing that a terminal obeys.
fn is_printable(words: &str) {
    assert!(words.chars().count() < 1_000, "{words}");
    assert!(!words.chars().any(char::is_control), "{words:?}");
}
