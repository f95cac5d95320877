//! The survey's figures and tables: `survey_figures FOLDER TERRAINS`.

fn main() -> Result<(), String> {
    let mut args = std::env::args().skip(1);
    let folder = args.next().unwrap_or("out/survey".into());
    let terrains = args
        .next()
        .and_then(|number| number.parse().ok())
        .unwrap_or(100);
    print!("{}", host_sim::survey::figures(folder.as_ref(), terrains)?);
    Ok(())
}
