//! The window.

#[cfg(not(target_arch = "wasm32"))]
mod window {
    use std::process::ExitCode;

    use clap::Parser;
    use lab::App;

    /// Watch, steer and compare explorations.
    #[derive(Parser)]
    struct Arguments {
        /// A map or a trace to open.
        file: Option<String>,
        /// The scenario: the part of the page's address behind `#`.
        #[arg(long, value_name = "ADDRESS", default_value = "")]
        scenario: String,
    }

    pub(crate) fn main() -> ExitCode {
        let arguments = Arguments::parse();
        let mut app = match arguments.file {
            None => App::welcome(&arguments.scenario),
            Some(_) => App::from_address(&arguments.scenario),
        };
        if let Some(file) = &arguments.file {
            match std::fs::read(file) {
                Ok(bytes) => app.open(file, &bytes),
                Err(error) => app.fail(format!("{file}: {error}")),
            }
        }
        let options = eframe::NativeOptions {
            viewport: egui::ViewportBuilder::default().with_inner_size([1280.0, 800.0]),
            ..Default::default()
        };
        let window = Window(app);
        let opened = eframe::run_native(
            "Exploration lab",
            options,
            Box::new(|_| Ok(Box::new(window))),
        );
        match opened {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("error: no window can be opened: {error}");
                ExitCode::from(2)
            }
        }
    }

    struct Window(App);

    impl eframe::App for Window {
        fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
            self.0.ui(ui);
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    window::main()
}

/// In the browser, the library starts by itself.
#[cfg(target_arch = "wasm32")]
fn main() {}
