//! Single keys from the terminal while a rig is up.

use crate::operator::Order;
use rustix::termios::{LocalModes, OptionalActions, Termios, isatty, tcgetattr, tcsetattr};
use std::io::Read as _;
use tokio::sync::mpsc;

/// The keys, for people.
pub const HELP: &str = "keys: s shape, c colour, b both, e end, d discard; Ctrl-C stops";

/// Gives the terminal its own ways back when it is dropped.
pub struct Keys(Termios);

impl Keys {
    /// Takes single keys, when standard input is a terminal. Ctrl-C stays a signal.
    pub fn open() -> Option<(Self, mpsc::Receiver<Order>)> {
        let stdin = std::io::stdin();
        if !isatty(&stdin) {
            return None;
        }
        let before = tcgetattr(&stdin).ok()?;
        let mut single = before.clone();
        single.local_modes.remove(LocalModes::ICANON | LocalModes::ECHO);
        tcsetattr(&stdin, OptionalActions::Now, &single).ok()?;
        let (sender, receiver) = mpsc::channel(16);
        // Reading blocks for ever; the thread ends with the process.
        std::thread::spawn(move || {
            let keys = std::io::stdin().lock().bytes().map_while(Result::ok);
            for order in keys.filter_map(order) {
                if sender.blocking_send(order).is_err() {
                    break;
                }
            }
        });
        Some((Self(before), receiver))
    }
}

impl Drop for Keys {
    fn drop(&mut self) {
        // The terminal may be gone.
        let _ = tcsetattr(std::io::stdin(), OptionalActions::Now, &self.0);
    }
}

fn order(key: u8) -> Option<Order> {
    Some(match key.to_ascii_lowercase() {
        b's' => Order::Shape,
        b'c' => Order::Colour,
        b'b' => Order::Both,
        b'e' => Order::End,
        b'd' => Order::Discard,
        _ => return None,
    })
}
