//! Running commands from the top of the project, with each one shown.

use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use anyhow::{Context, Result, bail};

use crate::output;

/// The folder of the workspace.
pub(crate) fn root() -> &'static Path {
    static ROOT: OnceLock<PathBuf> = OnceLock::new();
    ROOT.get_or_init(|| {
        // Cargo says where we are when it runs us; where we were compiled can be
        // another checkout that shares a target folder with this one.
        let xtask = std::env::var_os("CARGO_MANIFEST_DIR")
            .map_or(env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
        xtask.parent().map(Path::to_path_buf).unwrap_or(xtask)
    })
}

/// A command that runs in [`root`] or elsewhere, without input.
pub(crate) struct Command {
    program: OsString,
    arguments: Vec<OsString>,
    environment: Vec<(&'static str, String)>,
    folder: PathBuf,
}

/// What a command printed, and how it ended.
pub(crate) struct Output {
    pub(crate) status: Option<i32>,
    pub(crate) stdout: String,
    /// What `stdout` was before it was made text.
    pub(crate) bytes: Vec<u8>,
    pub(crate) stderr: String,
}

impl Output {
    pub(crate) fn success(&self) -> bool {
        self.status == Some(0)
    }
}

pub(crate) fn command(program: impl Into<OsString>) -> Command {
    Command {
        program: program.into(),
        arguments: Vec::new(),
        environment: Vec::new(),
        folder: root().to_path_buf(),
    }
}

pub(crate) fn cargo<const N: usize>(arguments: [&str; N]) -> Command {
    command("cargo").args(arguments)
}

impl Command {
    pub(crate) fn arg(mut self, argument: impl Into<OsString>) -> Self {
        self.arguments.push(argument.into());
        self
    }

    pub(crate) fn args<A: Into<OsString>>(
        mut self,
        arguments: impl IntoIterator<Item = A>,
    ) -> Self {
        self.arguments.extend(arguments.into_iter().map(Into::into));
        self
    }

    pub(crate) fn env(mut self, key: &'static str, value: impl Into<String>) -> Self {
        self.environment.push((key, value.into()));
        self
    }

    /// Lets it run in this folder.
    pub(crate) fn dir(mut self, folder: &Path) -> Self {
        self.folder = folder.to_path_buf();
        self
    }

    /// Shows the command, lets it print, and wants it to succeed.
    pub(crate) fn run(self) -> Result<()> {
        println!("$ {self}");
        let mut expression = self.expression();
        if output::is_kept() {
            expression = expression.stderr_to_stdout().stdout_capture();
        }
        let output = expression.run().with_context(|| self.absent())?;
        output::write(&output.stdout, std::io::stdout());
        if !output.status.success() {
            bail!("`{self}` failed ({})", output.status);
        }
        Ok(())
    }

    /// Runs the command quietly and returns what it printed.
    pub(crate) fn output(&self) -> Result<Output> {
        self.expression()
            .stdout_capture()
            .stderr_capture()
            .run()
            .map(|output| read(&output))
            .with_context(|| self.absent())
    }

    /// As [`output`](Self::output); kills a command that takes longer than `limit`.
    pub(crate) fn output_within(&self, limit: Duration) -> Result<Output> {
        let handle = self
            .expression()
            .stdout_capture()
            .stderr_capture()
            .start()
            .with_context(|| self.absent())?;
        match handle.wait_timeout(limit)? {
            Some(output) => Ok(read(output)),
            None => {
                handle.kill()?;
                bail!("`{self}` did not end within {} s", limit.as_secs())
            }
        }
    }

    fn expression(&self) -> duct::Expression {
        let mut expression = duct::cmd(&self.program, &self.arguments)
            .dir(&self.folder)
            .stdin_null()
            .unchecked();
        // Cargo describes the package xtask to us; Cargo's that we start would
        // pass it on to build scripts, which then run again for nothing.
        for (key, _) in std::env::vars_os() {
            if key.to_str().is_some_and(|key| {
                key.starts_with("CARGO_PKG_") || key.starts_with("CARGO_MANIFEST_")
            }) {
                expression = expression.env_remove(key);
            }
        }
        if std::io::stdout().is_terminal() {
            expression = expression.env("CARGO_TERM_COLOR", "always");
        }
        for (key, value) in &self.environment {
            expression = expression.env(key, value);
        }
        expression
    }

    fn absent(&self) -> String {
        format!(
            "`{}` does not start; is it installed?",
            self.program.display()
        )
    }
}

impl std::fmt::Display for Command {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (key, value) in &self.environment {
            if value.contains(' ') {
                write!(f, "{key}='{value}' ")?;
            } else {
                write!(f, "{key}={value} ")?;
            }
        }
        write!(f, "{}", self.program.display())?;
        for argument in &self.arguments {
            write!(f, " {}", argument.display())?;
        }
        Ok(())
    }
}

fn read(output: &std::process::Output) -> Output {
    Output {
        status: output.status.code(),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        bytes: output.stdout.clone(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}
