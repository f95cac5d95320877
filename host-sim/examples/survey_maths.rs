//! How long surveys take with the mathematics that this was built with, and the digest
//! of all their traces: `survey_maths TERRAINS`. Compare with and without
//! `--features micromath`.

use host_sim::survey::{Planner, Scenario, Terrain, run};
use sha2::{Digest, Sha256};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let terrains = std::env::args()
        .nth(1)
        .map_or(Ok(20), |n| n.parse::<u64>())?;
    for planner in [
        Planner::CoordinatedSurvey,
        Planner::CoordinatedCubic,
        Planner::Fcao,
    ] {
        let (mut ticks, mut work, mut violations) = (0.0, 0.0, 0);
        let mut digests = Sha256::new();
        let mut first = String::new();
        for seed in 0..terrains {
            let trace = run(
                &Terrain::gaussian(seed, 100),
                &Scenario::new(planner, 8, seed),
            )?;
            ticks += trace.ticks_to(1.0).map_or(f64::NAN, f64::from) / terrains as f64;
            violations += trace.safety.violations();
            let sum: f64 = trace.records.iter().map(|r| f64::from(r.work)).sum();
            work += sum / trace.records.len() as f64 / terrains as f64;
            digests.update(trace.digest());
            if seed == 0 {
                for record in trace
                    .records
                    .iter()
                    .filter(|record| record.robot == 0)
                    .take(6)
                {
                    first += &format!(" {:.2},{:.2}", record.at.x, record.at.y);
                }
            }
        }
        let digest = digests.finalize();
        println!(
            "{planner:20} {ticks:6.1} ticks, work {work:6.0}, {violations} violations, digest {:02x}{:02x}{:02x}{:02x}",
            digest[0], digest[1], digest[2], digest[3]
        );
        println!("{:20} terrain 0, robot 0:{first}", "");
    }
    Ok(())
}
