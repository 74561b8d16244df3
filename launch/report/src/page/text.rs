//! Numbers and names as the page writes them.

/// Text that cannot be read as markup.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c => safe.push(c),
        }
    }
    safe
}

/// A count, in groups of three digits: 1 234 567.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Three digits that count: 0.0123, 1.23, 12.3, 123, 12 345.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    let text = match size {
        s if s >= 999.5 => {
            return format!("{}{}", if value < 0.0 { "\u{2212}" } else { "" }, count(size.round() as u64));
        }
        s if s >= 99.95 => format!("{size:.0}"),
        s if s >= 9.995 => format!("{size:.1}"),
        s if s >= 0.0995 => format!("{size:.2}"),
        0.0 => "0".to_owned(),
        s if s < 0.0005 => format!("{size:.1e}"),
        _ => format!("{size:.3}"),
    };
    if value < 0.0 { format!("\u{2212}{text}") } else { text }
}

/// A share of 0..1 in per cent, never rounded up to all of it.
pub fn percent(share: f64) -> String {
    let text = format!("{:.1}", (share * 1000.0).floor() / 10.0);
    format!("{}\u{2009}%", text.strip_suffix(".0").filter(|_| share == 1.0 || share == 0.0).unwrap_or(&text))
}

/// A number that may not be known.
pub fn known(value: Option<f64>) -> String {
    value.map_or_else(|| "\u{2013}".to_owned(), number)
}
