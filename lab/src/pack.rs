//! A world in an address: its size, its name and its cells, compressed.

use host_sim::world::{LARGEST, World};
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;
use planner_core::{Cell, Extent};

use crate::maps::file_name;

/// The digits of base 64 that an address may hold as they are [RFC 4648 §5].
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/// `cells:NAME:WIDTHxHEIGHT:CELLS`.
pub(crate) fn pack(world: &World) -> String {
    let Extent { width, height } = world.extent();
    let mut bits = vec![0u8; (world.extent().cells() as usize).div_ceil(8)];
    for (index, cell) in cells(world.extent()).enumerate() {
        bits[index / 8] |= u8::from(!world.is_free(cell)) << (index % 8);
    }
    let name = file_name(world.name());
    format!(
        "cells:{name}:{width}x{height}:{}",
        encode(&compress_to_vec(&bits, 9))
    )
}

/// Reads [`pack`].
pub(crate) fn unpack(text: &str) -> Result<World, String> {
    let parse = || {
        let mut parts = text.strip_prefix("cells:")?.split(':');
        let name = parts.next()?;
        let (width, height) = parts.next()?.split_once('x')?;
        let extent = Extent::new(width.parse().ok()?, height.parse().ok()?);
        let largest = (LARGEST.cells() as usize).div_ceil(8);
        let bits = decompress_to_vec_with_limit(&decode(parts.next()?)?, largest).ok()?;
        (bits.len() == (extent.cells() as usize).div_ceil(8)).then_some((name, extent, bits))
    };
    let (name, extent, bits) =
        parse().ok_or_else(|| format!("the address: there is no map `{text}`"))?;
    let width = usize::from(extent.width);
    let blocked = |cell: Cell| {
        let index = cell.y as usize * width + cell.x as usize;
        bits[index / 8] >> (index % 8) & 1 == 1
    };
    World::from_fn(name, extent, blocked).map_err(|error| error.to_string())
}

fn cells(extent: Extent) -> impl Iterator<Item = Cell> {
    (0..extent.height as i16)
        .flat_map(move |y| (0..extent.width as i16).map(move |x| Cell::new(x, y)))
}

fn encode(bytes: &[u8]) -> String {
    let digits = bytes.chunks(3).flat_map(|chunk| {
        let word = chunk
            .iter()
            .fold(0u32, |word, &byte| word << 8 | u32::from(byte));
        let word = word << (8 * (3 - chunk.len()));
        (0..=chunk.len()).map(move |place| DIGITS[(word >> (18 - 6 * place)) as usize & 63])
    });
    digits.map(char::from).collect()
}

fn decode(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    for chunk in text.as_bytes().chunks(4) {
        let mut word = 0;
        for &digit in chunk {
            word = word << 6 | DIGITS.iter().position(|&known| known == digit)? as u32;
        }
        word <<= 6 * (4 - chunk.len());
        bytes.extend(&word.to_be_bytes()[1..chunk.len()]);
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back() {
        for length in 0..20u8 {
            let bytes: Vec<u8> = (0..length).map(|i| i.wrapping_mul(97)).collect();
            assert_eq!(decode(&encode(&bytes)), Some(bytes));
        }
    }
}
