//! `host-sim survey` by itself.

use clap::Parser;
use host_sim::survey::SurveyArgs;

#[derive(Parser)]
struct Command {
    #[command(flatten)]
    survey: SurveyArgs,
}

fn main() -> Result<(), String> {
    println!("{}", Command::parse().survey.run()?);
    Ok(())
}
