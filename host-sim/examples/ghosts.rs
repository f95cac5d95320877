//! What hints can cost: three explorers among robots that are only pretended, against
//! one explorer alone, in named worlds of the generators.
//!
//! `cargo run --release -p host-sim --example ghosts [-- --worlds 100 --side 48]`

use std::sync::Arc;

use clap::Parser;
use host_sim::experiments::ghosts::{Attack, one_robot, sensor, three_robots};
use host_sim::world::{Family, generate};
use indicatif::ProgressBar;
use rayon::prelude::*;

#[derive(Parser)]
struct Arguments {
    /// Number of worlds, of all families in turn.
    #[arg(long, default_value_t = 100)]
    worlds: usize,
    /// Side of the worlds in cells, up to 64.
    #[arg(long, default_value_t = 48)]
    side: u16,
}

fn main() {
    let arguments = Arguments::parse();
    let mut attacks = vec![None];
    attacks.extend(Attack::all().into_iter().map(Some));
    let worlds: Vec<(Family, u64)> = (1..)
        .flat_map(|seed| Family::ALL.map(|family| (family, seed)))
        .take(arguments.worlds)
        .collect();
    let bar = ProgressBar::new(worlds.len() as u64);
    let rows: Vec<Vec<f64>> = worlds
        .par_iter()
        .map(|&(family, seed)| {
            let side = arguments.side;
            let world = Arc::new(generate(family, side, side, seed).expect("the size is in range"));
            let sensor = sensor(&world);
            let ticks = |ticks: Option<u32>| ticks.map_or(f64::INFINITY, f64::from);
            let alone = ticks(one_robot(&world, &sensor).expect("there are free cells"));
            let ratios = attacks.iter().map(|&attack| {
                let among = three_robots(&world, &sensor, attack).expect("there are free cells");
                ticks(among) / alone
            });
            let ratios = ratios.collect();
            bar.inc(1);
            ratios
        })
        .collect();
    bar.finish_and_clear();
    println!(
        "three robots to one alone: {} worlds of {side}×{side} cells",
        worlds.len(),
        side = arguments.side
    );
    println!("| attack                 | mean | largest | in            |");
    println!("|---|---|---|---|");
    for (column, attack) in attacks.iter().enumerate() {
        let name = attack.map_or("none".into(), |attack| attack.to_string());
        let ratios = rows.iter().map(|row| row[column]);
        let mean = ratios.clone().sum::<f64>() / rows.len() as f64;
        let (largest, (family, seed)) = ratios
            .zip(&worlds)
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .expect("there are worlds");
        println!(
            "| {name:<22} | {mean:.2} |    {largest:.2} | {:<13} |",
            format!("{family}-{seed}")
        );
    }
}
