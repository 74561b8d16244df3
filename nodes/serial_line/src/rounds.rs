//! Which sensor a record is of, and how many of its records are missing.

/// Sensors that speak in turn, lowest number first: a round begins where the numbers begin anew.
///
/// ```
/// let mut rounds = serial_line::Rounds::new(&[1, 2]);
/// let turns = [1, 2, 1, 1].map(|number| rounds.place(number, 0));
/// assert_eq!(turns.map(|turn| turn.map(|turn| turn.skipped)), [Some(0); 4]);
/// let late = rounds.place(2, 0).ok_or("a stranger")?;
/// assert_eq!((late.sensor, late.skipped), (1, 1), "the second sensor's record of the round before was lost");
/// assert_eq!(rounds.place(7, 0), None);
/// # Ok::<(), &str>(())
/// ```
#[derive(Debug, Clone)]
pub struct Rounds {
    /// The number of each sensor, and the round in which it spoke last.
    sensors: Vec<(u8, u64)>,
    round: u64,
    last_number: Option<u8>,
}

/// Whose record it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turn {
    /// The place of its number among those that were asked for, from 0.
    pub sensor: usize,
    /// How many of its records are missing before this one.
    pub skipped: u32,
}

impl Rounds {
    /// For sensors with these numbers, ascending.
    pub fn new(numbers: &[u8]) -> Self {
        Self { sensors: numbers.iter().map(|&number| (number, 0)).collect(), round: 0, last_number: None }
    }

    /// A record with this number has come, `missed` others in pieces before it; `None` when nobody asked for its sensor.
    pub fn place(&mut self, number: u8, missed: u32) -> Option<Turn> {
        self.round += u64::from(missed) / self.sensors.len().max(1) as u64;
        if self.last_number.is_none_or(|last| number <= last) {
            self.round += 1;
        }
        self.last_number = Some(number);
        let sensor = self.sensors.iter().position(|(other, _)| *other == number)?;
        let before = std::mem::replace(&mut self.sensors[sensor].1, self.round);
        let skipped = self.round.saturating_sub(before + 1);
        Some(Turn { sensor, skipped: u32::try_from(skipped).unwrap_or(u32::MAX) })
    }
}
