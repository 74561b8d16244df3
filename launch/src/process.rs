//! One process of a node: its own process group, its configuration on standard input, its words in the log.

use crate::log::{self, Line, Sink};
use crate::stop::Rung;
use anyhow::{Context as _, Result};
use kit::NodeSpec;
use rustix::process::{Pid, Signal, kill_process_group};
use std::process::{ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWriteExt as _, BufReader};
use tokio::process::{Child, ChildStdin, Command};
use tokio::sync::watch;
use tokio::task::JoinHandle;

/// How to start a node.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Start {
    /// Its name in the launch file.
    pub(crate) name: String,
    /// The program and its arguments.
    pub(crate) command: Vec<String>,
    /// The line that it reads first.
    pub(crate) spec: NodeSpec,
}

/// A node that runs.
pub(crate) struct Process {
    child: Child,
    pub(crate) pid: u32,
    lifeline: JoinHandle<()>,
    readers: Vec<JoinHandle<()>>,
    last_words: Arc<Mutex<String>>,
}

/// How long the words of a process may come behind its end: a child of its own may hold the line open.
const LAST_WORDS: Duration = Duration::from_millis(500);

/// A picture of 4 MB comes 60 times a second. Left alone, glibc gives its pages back to the system and takes them anew
/// for each, which is a third of what receiving one costs (mallopt(3)).
const ALLOCATION: [(&str, &str); 2] =
    [("MALLOC_MMAP_THRESHOLD_", "1073741824"), ("MALLOC_TRIM_THRESHOLD_", "1073741824")];

impl Process {
    /// Starts it. Only the launcher shall get the terminal's Ctrl-C, so it leads a group of its own.
    pub(crate) fn start(start: &Start, rung: watch::Receiver<Rung>, sink: &Sink) -> Result<Self> {
        let spec = serde_json::to_string(&start.spec).context("writing the configuration")?;
        let (program, args) = start.command.split_first().context("no command")?;
        let mut child = Command::new(program)
            .args(args)
            .envs(ALLOCATION)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .process_group(0)
            .kill_on_drop(true)
            .spawn()
            .with_context(|| format!("cannot start {program}"))?;
        let pid = child.id().context("it ended at once")?;
        let stdin = child.stdin.take().context("no standard input")?;
        let lifeline = tokio::spawn(hold(stdin, spec, rung));
        let last_words = Arc::<Mutex<String>>::default();
        let mut readers = Vec::new();
        if let Some(output) = child.stdout.take() {
            readers.push(read(&start.name, output, sink, &last_words));
        }
        if let Some(output) = child.stderr.take() {
            readers.push(read(&start.name, output, sink, &last_words));
        }
        Ok(Self { child, pid, lifeline, readers, last_words })
    }

    /// Waits for its end, and sends the signals that belong to the rung on the way.
    pub(crate) async fn wait(&mut self, rung: &mut watch::Receiver<Rung>) -> Result<ExitStatus> {
        loop {
            match *rung.borrow_and_update() {
                Rung::Term => self.signal(Signal::TERM),
                Rung::Kill => self.signal(Signal::KILL),
                Rung::Run | Rung::Finish | Rung::Close => {}
            }
            tokio::select! {
                status = self.child.wait() => {
                    self.finish().await;
                    return status.context("waiting for it");
                }
                // The launcher keeps the sender for as long as nodes live.
                changed = rung.changed() => if changed.is_err() { self.signal(Signal::KILL) },
            }
        }
    }

    /// The last error that it wrote.
    pub(crate) fn last_words(&self) -> String {
        self.last_words.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// To the whole group, while its leader is not reaped: the number cannot belong to anybody else.
    fn signal(&self, signal: Signal) {
        if let Some(group) = self.child.id().and_then(|pid| Pid::from_raw(pid as i32)) {
            // It may just have ended by itself.
            let _ = kill_process_group(group, signal);
        }
    }

    async fn finish(&mut self) {
        self.lifeline.abort();
        let readers = std::mem::take(&mut self.readers);
        let all = async {
            for reader in readers {
                let _ = reader.await;
            }
        };
        let _ = tokio::time::timeout(LAST_WORDS, all).await;
    }
}

/// Writes the configuration and keeps standard input open until the nodes shall stop.
async fn hold(mut stdin: ChildStdin, spec: String, mut rung: watch::Receiver<Rung>) {
    // A node that does not read dies or is stopped; either is seen elsewhere.
    let _ = stdin.write_all(format!("{spec}\n").as_bytes()).await;
    let _ = stdin.flush().await;
    let _ = rung.wait_for(|rung| *rung >= Rung::Close).await;
}

fn read(
    name: &str,
    output: impl AsyncRead + Unpin + Send + 'static,
    sink: &Sink,
    last_words: &Arc<Mutex<String>>,
) -> JoinHandle<()> {
    let (name, sink, last_words) = (name.to_owned(), sink.clone(), last_words.clone());
    tokio::spawn(async move {
        let each = |line: Line| {
            if line.level == wire::LogLevel::Error {
                last_words.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&line.text);
            }
            sink(&line);
        };
        log::follow(&name, BufReader::new(output), each).await;
    })
}
