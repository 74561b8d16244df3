//! The known word that was probably meant.

/// `, did you mean "x"?`, or `; known are ...` when nothing is near.
pub fn nearest(word: &str, known: &[&str]) -> String {
    let near = known.iter().map(|&candidate| (strsim::damerau_levenshtein(word, candidate), candidate)).min();
    match near {
        Some((distance, candidate)) if distance <= 1 + word.len() / 3 => format!(", did you mean {candidate:?}?"),
        Some(_) => format!("; known are {}", known.join(", ")),
        None => "; nothing is known here".to_owned(),
    }
}
