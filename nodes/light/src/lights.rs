//! The lights at the other end of a line.

use crate::config::Config;
use crate::plan::{DARK, lit};
use crate::protocol::{self, Answer, Answers, Dialect};
use serial_line::{HostClock, Line, LineError, LineSettings, News, Trouble};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use wire::{Light, Phase};

/// A new state is looked for so often.
const TICK: Duration = Duration::from_millis(2);
/// Said again so often, well within the second after which the lights put themselves out.
const AGAIN: Duration = Duration::from_millis(300);
/// An Arduino starts anew when its port is opened, and listens after its boot loader is done.
const STARTS_WITHIN: Duration = Duration::from_secs(4);
const GREETED_AGAIN: Duration = Duration::from_millis(500);
/// A line of text is answered within milliseconds.
const ANSWERS_WITHIN: Duration = Duration::from_millis(500);
const FIRST_BACKOFF: Duration = Duration::from_millis(250);
const LAST_BACKOFF: Duration = Duration::from_secs(4);
/// The same trouble is named again after so long.
const NAMED_AGAIN: Duration = Duration::from_secs(30);

/// A thread that keeps the lights as the phase wants them; when it is dropped, they are put out.
pub struct Lights {
    now: Arc<Mutex<Now>>,
    stopping: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// The phase, and when it began.
type Now = (Phase, Instant);

impl Lights {
    /// Starts with both off; `say` is called with news, on the thread.
    pub fn start(config: Config, say: impl FnMut(News) + Send + 'static) -> Self {
        let now = Arc::new(Mutex::new((Phase::End, Instant::now())));
        let stopping = Arc::<AtomicBool>::default();
        let (named, greeted) = (None, false);
        let keeper = Keeper { config, say, now: now.clone(), stopping: stopping.clone(), named, greeted };
        Self { now, stopping, thread: Some(std::thread::spawn(move || keeper.live())) }
    }

    /// Keeps them as this phase wants them, from now on.
    pub fn begin(&self, phase: Phase) {
        *self.now.lock().unwrap_or_else(PoisonError::into_inner) = (phase, Instant::now());
    }
}

impl Drop for Lights {
    fn drop(&mut self) {
        self.stopping.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

struct Keeper<S> {
    config: Config,
    say: S,
    now: Arc<Mutex<Now>>,
    stopping: Arc<AtomicBool>,
    named: Option<(Trouble, Instant)>,
    /// Somebody was there.
    greeted: bool,
}

impl<S: FnMut(News)> Keeper<S> {
    fn live(mut self) {
        let mut backoff = FIRST_BACKOFF;
        while !self.is_stopping() {
            self.greeted = false;
            let Err(trouble) = self.attempt() else { return };
            if self.greeted {
                (backoff, self.named) = (FIRST_BACKOFF, None);
            }
            self.name(trouble);
            let until = Instant::now() + backoff;
            while Instant::now() < until && !self.is_stopping() {
                std::thread::sleep(TICK);
            }
            backoff = (backoff * 2).min(LAST_BACKOFF);
        }
    }

    fn is_stopping(&self) -> bool {
        self.stopping.load(Ordering::SeqCst)
    }

    fn wanted(&self) -> Light {
        let (phase, since) = *self.now.lock().unwrap_or_else(PoisonError::into_inner);
        lit(&self.config, phase, since.elapsed())
    }

    fn name(&mut self, trouble: Trouble) {
        let known = self.named.as_ref().is_some_and(|(said, at)| *said == trouble && at.elapsed() < NAMED_AGAIN);
        if !known {
            self.named = Some((trouble.clone(), Instant::now()));
            (self.say)(News::Trouble(trouble));
        }
    }

    /// Opens, greets and keeps the lights, until it is told to stop (then they are off) or something is wrong.
    fn attempt(&mut self) -> Result<(), Trouble> {
        // DTR starts an Arduino, and a Ciclop's board is one.
        let settings = LineSettings { path: self.config.port.clone(), baud: self.config.baud, rts: false, dtr: true };
        // The line is not told when the node stops: the lights have to be put out first.
        let line = Line::open(&settings, HostClock::start(), Arc::default())?;
        let mut talk = Talk { line, answers: Answers::new(self.config.dialect), waiting: Vec::new() };
        let Some(greeting) = self.greet(&mut talk)? else { return Ok(()) };
        self.greeted = true;
        (self.say)(News::Streaming(greeting));
        self.keep(&mut talk)
    }

    /// Who is there; none when it was told to stop.
    fn greet(&self, talk: &mut Talk) -> Result<Option<String>, Trouble> {
        let started = Instant::now();
        while started.elapsed() < STARTS_WITHIN {
            if self.is_stopping() {
                return Ok(None);
            }
            talk.line.write(protocol::greeting(self.config.dialect))?;
            let asked = Instant::now();
            while asked.elapsed() < GREETED_AGAIN {
                if let Some(Answer::Greeting(name)) = talk.hear()? {
                    return Ok(Some(format!("{name} on {}", self.config.port.display())));
                }
            }
        }
        Err(self.silent())
    }

    fn keep(&self, talk: &mut Talk) -> Result<(), Trouble> {
        let mut said: Option<(Light, Instant)> = None;
        loop {
            if self.is_stopping() {
                return self.switch(talk, DARK);
            }
            let wanted = self.wanted();
            if said.is_some_and(|(light, at)| light == wanted && at.elapsed() < AGAIN) {
                std::thread::sleep(TICK);
                continue;
            }
            self.switch(talk, wanted)?;
            said = Some((wanted, Instant::now()));
        }
    }

    /// Each line waits for its answer.
    fn switch(&self, talk: &mut Talk, light: Light) -> Result<(), Trouble> {
        for line in protocol::switch(&self.config, light) {
            talk.line.write(line.as_bytes())?;
            let asked = Instant::now();
            loop {
                match talk.hear()? {
                    Some(Answer::Done(told)) if told.is_none_or(|told| told == light) => break,
                    Some(Answer::Refused(words)) => {
                        let path = self.config.port.display();
                        let sentence = format!(
                            "the lights on {path} do not understand {:?} ({words:?}): set `dialect`, or flash the sketch \
                             of docs/hardware.md again",
                            line.trim()
                        );
                        return Err(Trouble::Device(sentence));
                    }
                    _ if asked.elapsed() > ANSWERS_WITHIN => return Err(self.silent()),
                    _ => {}
                }
            }
        }
        Ok(())
    }

    fn silent(&self) -> Trouble {
        let sketch = match self.config.dialect {
            Dialect::Limn => "flashed with the sketch of docs/hardware.md",
            Dialect::Horus => "the board of a Ciclop (else set dialect = \"limn\")",
        };
        Trouble::Device(format!(
            "nothing answers on {} at {} baud: is it {sketch}, and its power on?",
            self.config.port.display(),
            self.config.baud
        ))
    }
}

/// A line, and what came of an answer.
struct Talk {
    line: Line,
    answers: Answers,
    waiting: Vec<u8>,
}

impl Talk {
    /// The next answer; none when none is whole after 20 ms of silence.
    fn hear(&mut self) -> Result<Option<Answer>, LineError> {
        if self.waiting.is_empty() {
            let mut bytes = [0; 64];
            let chunk = self.line.read(&mut bytes)?;
            self.waiting.extend(&bytes[..chunk.len]);
        }
        let mut taken = 0;
        let answer = self.waiting.iter().find_map(|byte| {
            taken += 1;
            self.answers.push(*byte)
        });
        self.waiting.drain(..taken);
        Ok(answer)
    }
}
