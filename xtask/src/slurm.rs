//! The recipe of docs/sweeps.md under a real Slurm: one machine, all ports on the loopback,
//! all files in a folder that is gone afterwards.

use std::fs;
use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::shell::{Command, command, root};
use crate::{host, install};

/// What is swept: a task takes seconds, and longer than it takes to stop it.
const SWEEP: &str = "--families all --worlds 12 --robots 1,3,10";
/// The task that is stopped midway.
const STOPPED: &str = "2-of-4";
const LIMIT: Duration = Duration::from_secs(300);

/// Runs the array of the recipe with one task requeued midway and the merge after it, and
/// compares what comes of it with one run of all.
pub(crate) fn sweeps_as_one_run() -> Result<String> {
    install::slurm()?;
    let programs = host::build_simulator()?;
    let cluster = Cluster::start(&programs)?;
    let folder = &cluster.folder;
    fs::write(folder.join("sweep.sh"), recipe()?)?;

    let sweep = SWEEP.split(' ');
    let job = cluster.tool("sbatch").args(["--parsable", "sweep.sh"]);
    let job = said(&job.args(sweep.clone()))?;
    let merge = "host-sim compare --merge out/sweep";
    let dependency = format!("--dependency=afterok:{job}");
    let merged = cluster
        .tool("sbatch")
        .args(["--parsable", &dependency, "--wrap", merge]);
    let merged = said(&merged)?;

    let part = folder.join(format!("out/sweep/parts/{STOPPED}.csv"));
    let rows = |path: &Path| fs::read_to_string(path).map_or(0, |text| text.lines().count());
    wait_until("a task has begun", &cluster, || Ok(rows(&part) > 10))?;
    let task = format!("{job}_2");
    said(&cluster.tool("scontrol").args(["requeue", &task]))?;
    wait_until("the task is stopped", &cluster, || {
        let queue = cluster
            .tool("squeue")
            .args(["--noheader", "--states=PENDING", "--format=%T"]);
        Ok(said(&queue.args(["--jobs", &task]))? == "PENDING")
    })?;
    let stopped_at = rows(&part);
    // Slurm would let it wait for two minutes. At once is too soon: the node still refuses
    // what it has just been told to stop.
    let soon = [format!("JobId={task}"), "StartTime=now+3".into()];
    said(&cluster.tool("scontrol").arg("update").args(soon))?;
    wait_until("the merge has ended", &cluster, || {
        let queue = cluster
            .tool("squeue")
            .args(["--noheader", "--states=all", "--format=%T"]);
        let state = said(&queue.args(["--jobs", &merged]))?;
        match state.as_str() {
            "COMPLETED" => Ok(true),
            "PENDING" | "RUNNING" | "COMPLETING" | "CONFIGURING" => Ok(false),
            state => bail!("the merge ended as {state}"),
        }
    })?;
    if stopped_at >= rows(&part) {
        bail!("the task had ended when it was to be stopped, at {stopped_at} rows");
    }

    let whole = folder.join("whole");
    let program = command(programs.join("host-sim"))
        .arg("compare")
        .args(sweep);
    let output = program.arg("--out").arg(&whole).output()?;
    if !output.success() {
        bail!("the run of all failed:\n{}", output.stderr);
    }
    for name in ["runs.csv", "table.md", "table.csv"] {
        let read = |folder: &Path| fs::read(folder.join(name)).with_context(|| name.to_owned());
        if read(&whole)? != read(&folder.join("out/sweep"))? {
            bail!("{name} of the array is not that of one run");
        }
    }
    Ok(format!(
        "{} runs; a task was stopped after {} of its {}",
        rows(&whole.join("runs.csv")) - 1,
        stopped_at - 1,
        rows(&part) - 1
    ))
}

/// The script in docs/sweeps.md.
fn recipe() -> Result<String> {
    let text = fs::read_to_string(root().join("docs/sweeps.md"))?;
    let blocks = text.split("```").skip(1).step_by(2);
    let mut scripts = blocks.filter_map(|block| block.strip_prefix("sh\n"));
    let script = scripts.find(|script| script.starts_with("#!/bin/sh"));
    Ok(script.context("docs/sweeps.md has no script")?.to_owned())
}

/// Daemons that end with this value.
struct Cluster {
    folder: PathBuf,
    path: String,
    daemons: Vec<Child>,
}

impl Cluster {
    fn start(programs: &Path) -> Result<Self> {
        let folder = host::built().join("slurm");
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("state"))?;
        fs::create_dir_all(folder.join("spool"))?;
        // Nobody else may ask the daemons for anything: they may be root's.
        fs::set_permissions(&folder, fs::Permissions::from_mode(0o700))?;
        let folder = folder.canonicalize()?;
        let path = std::env::var("PATH").unwrap_or_default();
        let mut cluster = Self {
            path: format!("{}:{path}:/usr/sbin", programs.display()),
            daemons: Vec::new(),
            folder,
        };
        let key = cluster.folder.join("munge.key");
        let mut secret = vec![0; 64];
        std::io::Read::read_exact(&mut fs::File::open("/dev/urandom")?, &mut secret)?;
        fs::write(&key, secret)?;
        fs::set_permissions(&key, fs::Permissions::from_mode(0o600))?;
        fs::write(cluster.folder.join("slurm.conf"), cluster.configuration()?)?;

        let munge = ["key-file", "socket", "pid-file", "log-file", "seed-file"];
        let munge = munge.map(|option| {
            let name = option.trim_end_matches("-file");
            format!("--{option}={}/munge.{name}", cluster.folder.display())
        });
        cluster.spawn(
            "munged",
            munge
                .iter()
                .map(String::as_str)
                .chain(["--foreground", "--force"]),
        )?;
        let socket = cluster.folder.join("munge.socket");
        wait_until("munged answers", &cluster, || Ok(socket.exists()))?;
        cluster.spawn("slurmctld", ["-D", "-i"])?;
        cluster.spawn("slurmd", ["-D"])?;
        wait_until("the node is idle", &cluster, || {
            let nodes = cluster.tool("sinfo").args(["--noheader", "--format=%T"]);
            Ok(nodes.output()?.stdout.trim() == "idle")
        })?;
        Ok(cluster)
    }

    fn configuration(&self) -> Result<String> {
        let name = said(&command("hostname").arg("-s"))?;
        let user = said(&command("id").arg("-un"))?;
        let folder = self.folder.display();
        // Both are free now; held together, so that they differ.
        let free = [
            TcpListener::bind("127.0.0.1:0")?,
            TcpListener::bind("127.0.0.1:0")?,
        ];
        let mut ports = Vec::new();
        for listener in &free {
            ports.push(listener.local_addr()?.port());
        }
        Ok(format!(
            "ClusterName=sweeps\n\
             SlurmctldHost={name}(127.0.0.1)\n\
             SlurmctldPort={}\n\
             SlurmdPort={}\n\
             CommunicationParameters=NoInAddrAny,NoCtldInAddrAny\n\
             AuthType=auth/munge\n\
             AuthInfo=socket={folder}/munge.socket\n\
             CredType=cred/munge\n\
             SlurmUser={user}\n\
             SlurmdUser={user}\n\
             StateSaveLocation={folder}/state\n\
             SlurmdSpoolDir={folder}/spool\n\
             SlurmctldPidFile={folder}/slurmctld.pid\n\
             SlurmdPidFile={folder}/slurmd.pid\n\
             SlurmctldLogFile={folder}/slurmctld.log\n\
             SlurmdLogFile={folder}/slurmd.log\n\
             ProctrackType=proctrack/linuxproc\n\
             TaskPlugin=task/none\n\
             MpiDefault=none\n\
             SelectType=select/cons_tres\n\
             SelectTypeParameters=CR_CPU\n\
             SchedulerParameters=sched_interval=1,bf_interval=1\n\
             SlurmdParameters=config_overrides\n\
             DependencyParameters=kill_invalid_depend\n\
             ReturnToService=2\n\
             KillWait=1\n\
             NodeName={name} NodeAddr=127.0.0.1 CPUs=4\n\
             PartitionName=all Nodes=ALL Default=YES State=UP\n",
            ports[0], ports[1]
        ))
    }

    fn spawn<'a>(
        &mut self,
        daemon: &str,
        arguments: impl IntoIterator<Item = &'a str>,
    ) -> Result<()> {
        let log = fs::File::create(self.folder.join(format!("{daemon}.out")))?;
        let child = std::process::Command::new(daemon)
            .args(arguments)
            .current_dir(&self.folder)
            .env("PATH", &self.path)
            .env("SLURM_CONF", self.folder.join("slurm.conf"))
            .stdin(Stdio::null())
            .stdout(log.try_clone()?)
            .stderr(log)
            .spawn()
            .with_context(|| format!("{daemon} does not start"))?;
        self.daemons.push(child);
        Ok(())
    }

    /// One of Slurm's tools, which work in the folder.
    fn tool(&self, name: &str) -> Command {
        command("env")
            .arg("-C")
            .arg(&self.folder)
            .arg(format!("PATH={}", self.path))
            .arg(format!("SLURM_CONF={}/slurm.conf", self.folder.display()))
            .arg(name)
    }

    /// What the daemons and the jobs said last.
    fn logs(&self) -> String {
        let mut said = String::new();
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        for path in entries.map(|entry| entry.path()) {
            let is_log = path
                .extension()
                .is_some_and(|of| of == "log" || of == "out");
            if let Some(text) = is_log.then(|| fs::read_to_string(&path).ok()).flatten() {
                let lines: Vec<&str> = text.lines().collect();
                let last = lines[lines.len().saturating_sub(8)..].join("\n");
                said += &format!("\n{}:\n{last}", path.display());
            }
        }
        said
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        if self.daemons.len() == 3 {
            let everything = ["--quiet", "--state=RUNNING", "--partition=all"];
            let _ = self.tool("scancel").args(everything).output();
        }
        // The youngest first: a node stops its jobs while it can still say so.
        while let Some(mut daemon) = self.daemons.pop() {
            let _ = command("kill").arg(daemon.id().to_string()).output();
            let begin = Instant::now();
            while let Ok(None) = daemon.try_wait() {
                if begin.elapsed() > Duration::from_secs(10) {
                    let _ = daemon.kill();
                }
                std::thread::sleep(Duration::from_millis(20));
            }
        }
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// What a command prints, which has to succeed.
fn said(command: &Command) -> Result<String> {
    let output = command.output()?;
    if !output.success() {
        bail!("`{command}` failed:\n{}", output.stderr);
    }
    Ok(output.stdout.trim().to_owned())
}

fn wait_until(what: &str, cluster: &Cluster, is_so: impl Fn() -> Result<bool>) -> Result<()> {
    let begin = Instant::now();
    while !is_so().with_context(|| cluster.logs())? {
        if begin.elapsed() > LIMIT {
            bail!(
                "waited {} s until {what}{}",
                LIMIT.as_secs(),
                cluster.logs()
            );
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Ok(())
}
