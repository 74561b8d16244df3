//! Readings in the order of time, whatever came between them.

/// The longest row of stamps each of which is later than the one before (Schensted 1961), as indices. A single wild
/// stamp so costs one reading and not all behind it.
pub(super) fn longest_rising(stamps: &[i64]) -> Vec<usize> {
    // tails[n] ends the row of n + 1 stamps that ends earliest; before[i] is the stamp ahead of i in its row.
    let mut tails: Vec<usize> = Vec::with_capacity(stamps.len());
    let mut before: Vec<Option<usize>> = Vec::with_capacity(stamps.len());
    for (i, stamp) in stamps.iter().enumerate() {
        let place = match tails.last() {
            Some(&last) if stamps[last] >= *stamp => tails.partition_point(|&tail| stamps[tail] < *stamp),
            _ => tails.len(),
        };
        before.push(place.checked_sub(1).map(|ahead| tails[ahead]));
        match tails.get_mut(place) {
            Some(tail) => *tail = i,
            None => tails.push(i),
        }
    }
    let mut row: Vec<usize> = std::iter::successors(tails.last().copied(), |&i| before[i]).collect();
    row.reverse();
    row
}
