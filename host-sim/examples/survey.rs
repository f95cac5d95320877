//! Trials of the survey planners: `survey PLANNER ROBOTS TERRAINS [SIDE] [LOSS]`.

use clap::ValueEnum;
use host_sim::survey::{Planner, Scenario, Terrain, run};
use rayon::prelude::*;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: f64| args.get(i).map_or(default, |a| a.parse().unwrap());
    let robots = number(1, 8.0) as usize;
    let side = number(3, 100.0) as u16;
    for name in args[0].split(',') {
        let planner = Planner::from_str(name, true).unwrap();
        let traces: Vec<_> = {
            let o: u64 = std::env::var("FIRST").map_or(0, |v| v.parse().unwrap());
            o..o + number(2, 100.0) as u64
        }
        .into_par_iter()
        .map(|seed| {
            let mut scenario = Scenario::new(planner, robots, seed);
            scenario.loss = number(4, 0.0);
            scenario.skip = number(5, 0.0);
            run(&Terrain::gaussian(seed, side), &scenario).unwrap()
        })
        .collect();
        if let Ok(step) = std::env::var("DRAW") {
            let worst = (0..traces.len())
                .max_by_key(|&i| traces[i].seen.len())
                .unwrap();
            println!("worst {worst} {}", traces[worst].seen.len());
            for i in [worst, 0] {
                host_sim::survey::draw::top_view(
                    &Terrain::gaussian(i as u64, side),
                    &traces[i],
                    step.parse().unwrap(),
                )
                .save(format!("/tmp/{name}-{i}.png"))
                .unwrap();
            }
        }
        let column = |share: f64| {
            let steps: Vec<f64> = traces
                .iter()
                .map(|t| t.steps_to(share).map_or(f64::NAN, f64::from))
                .collect();
            let missing = steps.iter().filter(|s| s.is_nan()).count();
            let steps: Vec<f64> = steps.into_iter().filter(|s| !s.is_nan()).collect();
            let mean = steps.iter().sum::<f64>() / steps.len() as f64;
            let variance =
                steps.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / steps.len() as f64;
            (mean, variance.sqrt(), missing)
        };
        let (all, deviation, missing) = column(1.0);
        let safety = traces.iter().fold([0; 4], |sum, t| {
            let s = t.safety;
            [
                sum[0] + s.altitude_violations,
                sum[1] + s.obstacle_violations,
                sum[2] + s.separation_violations,
                sum[3] + s.step_violations,
            ]
        });
        let stopped = traces.iter().map(|t| t.seen.len() as f64).sum::<f64>() / traces.len() as f64;
        let blocked = traces
            .iter()
            .flat_map(|t| &t.records)
            .filter(|r| r.blocked)
            .count();
        let hover = {
            let mut local = 0;
            let mut n = 0;
            let mut alt = 0.0;
            let mut altf = 0.0;
            let mut hov = 0;
            let mut gains = [(0.0f32, 0); 4];
            for (seed, t) in traces.iter().enumerate() {
                let terrain = Terrain::gaussian(seed as u64, side);
                let mut last = vec![None; robots];
                let mut mode = vec![0; robots];
                for r in &t.records {
                    if r.stop.is_some() {
                        continue;
                    }
                    n += 1;
                    let a = r.at.z - terrain.height(r.at.cell()).unwrap().cells();
                    if last[r.robot as usize] == Some(r.at) {
                        hov += 1;
                    }
                    last[r.robot as usize] = Some(r.at);
                    let m = mode[r.robot as usize];
                    if r.step > 0 {
                        gains[m].0 += r.gain;
                        gains[m].1 += 1;
                    }
                    mode[r.robot as usize] =
                        2 * usize::from(r.target.is_some()) + usize::from(r.step > 60);
                    if r.target.is_none() {
                        local += 1;
                        alt += a;
                    } else {
                        altf += a;
                    }
                }
            }
            format!(
                "local {:.2} alt {:.2}/{:.2} hover {:.3} gains {:?}",
                local as f32 / n as f32,
                alt / local as f32,
                altf / (n - local) as f32,
                hov as f32 / n as f32,
                gains.map(|(g, n)| (g / n as f32, n))
            )
        };
        let decisions = traces.iter().map(|t| t.records.len()).sum::<usize>();
        let work = traces
            .iter()
            .flat_map(|t| &t.records)
            .map(|r| f64::from(r.work))
            .sum::<f64>()
            / decisions as f64;
        let worst = traces
            .iter()
            .flat_map(|t| &t.records)
            .map(|r| r.work)
            .max()
            .unwrap();
        if std::env::var("CURVE").is_ok() {
            let c: Vec<u32> = (0..16)
                .map(|k| {
                    traces
                        .iter()
                        .map(|t| *t.seen.get(k * 8).unwrap_or(t.seen.last().unwrap()))
                        .sum::<u32>()
                        / traces.len() as u32
                })
                .collect();
            println!("{c:?}");
        }
        println!(
            "{name:20} 95% {:6.1}  99% {:6.1}  100% {all:6.1} ± {deviation:4.1}  missing {missing}  stopped {stopped:.1}  unsafe {safety:?} blocked {blocked}/{decisions} {hover} work {work:.0} max {worst}",
            column(0.95).0,
            column(0.99).0,
        );
    }
}
