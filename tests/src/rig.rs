//! A rig that runs as a user starts it: a process with its nodes below it, found as `limn top` finds it.

use bus::{Bus, BusConfig, Presence, Subscriber};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use wire::{Header, Message, Progress, topic};

/// Nothing here takes so long unless it hangs.
pub const PATIENCE: Duration = Duration::from_secs(90);

/// Waits for a condition; between two looks it rests a moment.
///
/// # Panics
/// When it does not come about in time.
pub fn wait_until(what: &str, mut done: impl FnMut() -> bool) {
    let deadline = Instant::now() + PATIENCE;
    while !done() {
        assert!(Instant::now() < deadline, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Processes whose parent is `parent`: from /proc/PID/stat (proc(5), field 4).
pub fn children(parent: u32) -> Vec<u32> {
    let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let pids = processes.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    pids.filter(|pid| parent_of(*pid) == Some(parent)).collect()
}

fn parent_of(pid: u32) -> Option<u32> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    stat.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse().ok()
}

/// Neither gone nor waiting to be buried.
pub fn is_alive(pid: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    stat.rsplit_once(") ").is_some_and(|(_, rest)| !rest.starts_with(['Z', 'X']))
}

/// Sends a signal: `KILL`, `STOP`, `CONT`, `INT`.
///
/// # Panics
/// When there is no such process.
pub fn signal(pid: u32, name: &str) {
    let sent = Command::new("kill").args([&format!("-{name}"), &pid.to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()), "no process {pid} takes SIG{name}");
}

/// A process of `limn` that starts nodes. Dropped, it is killed, and its nodes follow it.
pub struct Rig {
    launcher: Child,
    /// Where it leaves its address; `limn` commands with this in `XDG_RUNTIME_DIR` find it.
    pub runtime: TempDir,
    said: PathBuf,
}

impl Rig {
    /// Starts it, with a place of its own for its words, and for its address unless the command names one.
    ///
    /// # Panics
    /// When it cannot be started.
    pub fn start(command: &mut Command) -> Self {
        let place = tempfile::tempdir().and_then(|runtime| {
            let said = runtime.path().join("said.txt");
            let file = File::create(&said)?;
            Ok((runtime, said, file.try_clone()?, file))
        });
        let Ok((runtime, said, out, err)) = place else { panic!("no temporary folder") };
        if !command.get_envs().any(|(name, _)| name == "XDG_RUNTIME_DIR") {
            command.env("XDG_RUNTIME_DIR", runtime.path());
        }
        match command.stdin(Stdio::null()).stdout(out).stderr(err).spawn() {
            Ok(launcher) => Self { launcher, runtime, said },
            Err(error) => panic!("{command:?}: {error}"),
        }
    }

    /// The process.
    pub fn pid(&self) -> u32 {
        self.launcher.id()
    }

    /// What it has written so far.
    pub fn said(&self) -> String {
        std::fs::read_to_string(&self.said).unwrap_or_default()
    }

    /// The way to its bus, as soon as it is up.
    ///
    /// # Panics
    /// When it is not up in time.
    pub fn config(&mut self) -> BusConfig {
        let folder = self.runtime.path().join("limn");
        let mut found = None;
        wait_until("the rig is not up", || {
            assert!(matches!(self.launcher.try_wait(), Ok(None)), "it has ended: {}", self.said());
            let files = std::fs::read_dir(&folder).into_iter().flatten().flatten().map(|entry| entry.path());
            let texts = files.filter(|path| path.extension().is_some_and(|e| e == "json")).map(std::fs::read);
            let mut rigs = texts.filter_map(|text| serde_json::from_slice::<serde_json::Value>(&text.ok()?).ok());
            found = rigs.find_map(|rig| serde_json::from_value(rig["bus"].clone()).ok());
            found.is_some()
        });
        found.unwrap_or_default()
    }

    /// A place on its bus.
    ///
    /// # Panics
    /// When there is none.
    pub fn bus(&mut self) -> Bus {
        let config = self.config();
        match Bus::open(&config) {
            Ok(bus) => bus,
            Err(error) => panic!("{error}\n{}", self.said()),
        }
    }

    /// The process of a node, while it runs.
    pub fn node(&self, kind: &str) -> Option<u32> {
        children(self.pid()).into_iter().filter(|pid| is_alive(*pid)).find(|pid| {
            let line = std::fs::read_to_string(format!("/proc/{pid}/cmdline")).unwrap_or_default();
            line.contains(&format!("\0node\0{kind}\0"))
        })
    }

    /// Waits until it has ended, and returns how, and all that it said.
    ///
    /// # Panics
    /// When it does not end.
    pub fn end(mut self) -> (ExitStatus, String) {
        let mut status = None;
        let deadline = Instant::now() + PATIENCE;
        while status.is_none() {
            assert!(Instant::now() < deadline, "the rig does not end:\n{}", self.said());
            status = self.launcher.try_wait().ok().flatten();
            std::thread::sleep(Duration::from_millis(20));
        }
        (status.unwrap_or_default(), self.said())
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.launcher.kill();
        let _ = self.launcher.wait();
    }
}

/// How far each node has come, from now on.
pub struct Course<'a> {
    bus: &'a Bus,
    progress: Subscriber<Progress>,
    /// For each node (kind/instance), the numbers of the messages that it has finished.
    pub finished: BTreeMap<String, Vec<u64>>,
    reached: BTreeMap<String, Header>,
}

impl<'a> Course<'a> {
    /// Begins to listen.
    ///
    /// # Panics
    /// When the bus is gone.
    pub fn follow(bus: &'a Bus) -> Self {
        match bus.subscribe(&topic::progress("**"), 1 << 16) {
            Ok(progress) => Self { bus, progress, finished: BTreeMap::new(), reached: BTreeMap::new() },
            Err(error) => panic!("{error}"),
        }
    }

    /// Waits until a node has finished everything up to a moment of the scan's own clock.
    ///
    /// # Panics
    /// When it does not get there.
    pub fn wait_for(&mut self, node: &str, stamp_nanos: i64) {
        let what = format!("{node} to reach {} s", stamp_nanos as f64 * 1e-9);
        self.wait(node, &what, |header| header.stamp_nanos >= stamp_nanos);
    }

    /// Waits until a node has done its work on a whole scan.
    ///
    /// # Panics
    /// When it does not.
    pub fn wait_for_end(&mut self, node: &str) {
        self.wait(node, &format!("{node} to finish"), Header::is_end);
    }

    fn wait(&mut self, node: &str, what: &str, there: impl Fn(&Header) -> bool) {
        let bus = self.bus;
        wait_on(bus, what, || {
            while let Some(progress) = self.progress.next() {
                self.finished.entry(progress.node.clone()).or_default().push(progress.finished_seq);
                self.reached.insert(progress.node, progress.header);
            }
            self.reached.get(node).is_some_and(&there).then_some(())
        });
    }
}

/// Waits until a node is ready.
///
/// # Panics
/// When it is not in time.
pub fn wait_for_ready(bus: &Bus, mut is_it: impl FnMut(&str) -> bool) {
    let presence: Presence = match bus.presence() {
        Ok(presence) => presence,
        Err(error) => panic!("{error}"),
    };
    wait_on(bus, "a node is not ready", || presence.nodes().iter().any(|node| is_it(node)).then_some(()));
}

/// Waits until something has come on the bus.
///
/// # Panics
/// When it does not.
pub fn wait_on<T>(bus: &Bus, what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let deadline = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(Instant::now() < deadline, "waited in vain: {what}");
        bus.wait(Duration::from_millis(50));
    }
}

/// The first message of a topic, for whoever comes late.
///
/// # Panics
/// When nothing comes.
pub fn first<M: Message>(bus: &Bus, topic: &topic::Topic<M>) -> M {
    let Ok(mut input) = bus.subscribe(topic, 16) else { panic!("no subscription to {}", topic.key) };
    wait_on(bus, &format!("nothing on {}", topic.key), || input.next())
}
