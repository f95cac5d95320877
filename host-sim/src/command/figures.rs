//! `host-sim figures`.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use clap::Args;
use host_sim::experiments::figures::{
    Drawn, Effort, Figure, SURVEYS, figures, measure, page, survey,
};
use host_sim::world::{ReadOptions, Scale, World, WorldError};
use indicatif::{ProgressBar, ProgressStyle};

use super::folder::{Folder, FolderError};
use super::{Done, tell_notes};

#[derive(Args)]
pub(crate) struct Figures {
    /// Folder for the figures.
    #[arg(long, value_name = "DIR", default_value = "out/figures")]
    out: PathBuf,
    /// These figures only: fig6 to fig11, spread, minpos; in 3-D fcao3, fcao4, fcao6,
    /// fcao-robots, fcao-work, towns.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    only: Vec<String>,
    /// A few runs only, to see that all is well.
    #[arg(long)]
    quick: bool,
    /// The hospital section of Player/Stage as an image, for the figure minpos.
    #[arg(long, value_name = "IMAGE")]
    hospital: Option<PathBuf>,
    /// Pixels of that image that are one cell.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    pixels_per_cell: u32,
    /// No progress bar.
    #[arg(long)]
    quiet: bool,
}

impl Figures {
    pub(crate) fn run(self) -> Done {
        let figures = self.figures()?;
        let runs: usize = figures.iter().map(|figure| figure.plan.runs()).sum();
        let bar = self.progress_bar(runs);
        let mut folder = Folder::open(self.out.clone())?;
        let mut explorations = Vec::new();
        for figure in figures {
            bar.set_message(figure.id);
            let drawn = Drawn::from(&measure(figure, &|| bar.inc(1))?);
            write(&mut folder, &drawn)?;
            bar.suspend(|| print!("{}", drawn.summary));
            explorations.push(drawn);
        }
        let mut surveys = Vec::new();
        for id in SURVEYS.into_iter().filter(|id| self.is_wanted(id)) {
            bar.set_message(id);
            let terrains = if self.quick { 3 } else { 100 };
            if let Some(drawn) = survey(id, terrains)? {
                write(&mut folder, &drawn)?;
                bar.suspend(|| print!("{}", drawn.summary));
                surveys.push(drawn);
            }
        }
        folder.put("index.html", &page(&explorations, &surveys))?;
        folder.close()?;
        bar.finish_and_clear();
        println!("{}: {runs} runs", self.out.join("index.html").display());
        Ok(ExitCode::SUCCESS)
    }

    fn figures(&self) -> Result<Vec<Figure>, Box<dyn std::error::Error>> {
        let effort = match self.quick {
            true => Effort::Quick,
            false => Effort::Full,
        };
        let options = ReadOptions {
            scale: Scale::Pixels(self.pixels_per_cell),
            ..ReadOptions::default()
        };
        let hospital = self.hospital.as_ref();
        let hospital = hospital.map(|path| {
            let world = World::read(path, &options)?;
            tell_notes(path, &world);
            Ok::<_, WorldError>(Arc::new(world))
        });
        let mut figures = figures(effort, hospital.transpose()?);
        if let Some(unknown) = self.only.iter().find(|id| {
            figures.iter().all(|figure| figure.id != **id) && !SURVEYS.contains(&id.as_str())
        }) {
            let ids = figures.iter().map(|figure| figure.id);
            let ids: Vec<_> = ids.chain(SURVEYS).collect();
            return Err(
                format!("--only: no figure {unknown}; there are {}", ids.join(", ")).into(),
            );
        }
        figures.retain(|figure| self.is_wanted(figure.id));
        Ok(figures)
    }

    fn is_wanted(&self, id: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|wanted| wanted == id)
    }

    fn progress_bar(&self, runs: usize) -> ProgressBar {
        if self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let style = "{spinner} {percent:>3} % {wide_bar} {pos}/{len} runs, {msg} [{elapsed}]";
        ProgressBar::new(runs as u64)
            .with_style(ProgressStyle::with_template(style).expect("the template is well-formed"))
    }
}

/// The files of a figure.
fn write(folder: &mut Folder, Drawn { id, chart, csv, .. }: &Drawn) -> Result<(), FolderError> {
    folder.write(format!("{id}.svg"), |file| {
        Ok(file.write_all(chart.svg()?.as_bytes())?)
    })?;
    folder.write(format!("{id}.png"), |file| chart.write_png(file))?;
    folder.put(format!("{id}.csv"), csv)
}
