//! A device that has not answered yet: that is said, and it is asked once more on the same line.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use serial_line::{
    Device, Emulated, FaultsConfig, Heard, HostClock, Line, LineSettings, News, Pty, Session, Tally, Trouble,
};
use std::sync::mpsc::{Sender, channel};
use std::time::Duration;

/// The other end: the driver below says nothing to it.
struct Nobody;

impl Emulated for Nobody {
    fn hear(&mut self, _: &[u8], _: i64) {}
    fn speak(&mut self, _: i64) -> Option<(i64, Vec<u8>)> {
        None
    }
}

/// Answers at its third opening, and tells each call.
struct Slow {
    calls: u32,
    tell: Sender<u32>,
}

impl Device for Slow {
    type Record = ();

    fn set_up(&mut self, _: &mut Line) -> Result<String, Trouble> {
        self.calls += 1;
        let _ = self.tell.send(self.calls);
        match self.calls {
            2 | 4 => Err(Trouble::Device("silent".to_owned())),
            6 => Ok("there".to_owned()),
            _ => Err(Trouble::Starting("it may be starting up".to_owned())),
        }
    }

    fn take(&mut self, _: &[u8], _: &mut dyn FnMut(Heard<()>)) {}
    fn tally(&self) -> Tally {
        Tally::default()
    }
    fn most_silence(&self) -> Duration {
        Duration::from_secs(3600)
    }
    fn silence(&self) -> String {
        String::new()
    }
    fn garbage(&self, _: &[u8]) -> String {
        String::new()
    }
}

#[test]
fn it_is_told_at_once_and_once_and_asked_again() {
    let clock = HostClock::start();
    let pty = Pty::start(Nobody, FaultsConfig::default(), clock, None).unwrap();
    let settings = LineSettings { path: pty.path().to_owned(), baud: 115_200, rts: false, dtr: true };
    let (tell, calls) = channel();
    let (say, news) = channel();
    let _session = Session::start(Slow { calls: 0, tell }, settings, clock, move |piece| drop(say.send(piece)));
    let long = Duration::from_secs(20);
    let words: Vec<String> = std::iter::repeat_with(|| news.recv_timeout(long).unwrap())
        .map(|piece| match piece {
            News::Trouble(trouble) => trouble.to_string(),
            News::Streaming(found) | News::Noisy(found) => found,
        })
        .take(3)
        .collect();
    // Three openings; what was said of the first is not said again of the next.
    assert_eq!(words, ["it may be starting up", "silent", "there"]);
    assert_eq!(calls.try_iter().collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6]);
}
