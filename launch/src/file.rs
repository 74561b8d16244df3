//! A launch file as text: TOML to settings that know their lines.

use crate::setting::{Origin, Setting, Settings, Value};
use anyhow::{Context as _, Result, anyhow, bail};
use std::path::Path;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Parses the text of the launch file `path`.
pub fn parse(path: &Path, text: &str) -> Result<Settings> {
    let path: Arc<Path> = Arc::from(path);
    read(text, &|line| Origin::File { path: Arc::clone(&path), line })
}

/// Parses what stands in the code.
pub fn defaults(text: &str) -> Result<Settings> {
    read(text, &|_| Origin::Default)
}

fn read(text: &str, origin: &dyn Fn(usize) -> Origin) -> Result<Settings> {
    let place = Place { origin, text };
    let table = DeTable::parse(text).map_err(|error| {
        let line = error.span().map_or(1, |span| place.line(span.start));
        anyhow!("{}: {}", origin(line), error.message())
    })?;
    place.table(table.get_ref())
}

struct Place<'a> {
    origin: &'a dyn Fn(usize) -> Origin,
    text: &'a str,
}

impl Place<'_> {
    fn line(&self, offset: usize) -> usize {
        1 + self.text.bytes().take(offset).filter(|&byte| byte == b'\n').count()
    }

    fn table(&self, table: &DeTable<'_>) -> Result<Settings> {
        table
            .iter()
            .map(|(key, value)| {
                let origin = (self.origin)(self.line(key.span().start));
                let value = match value.get_ref() {
                    DeValue::Table(inner) => Value::Table(self.table(inner)?),
                    other => Value::Leaf(leaf(other).with_context(|| format!("{origin}: {}", key.get_ref()))?),
                };
                Ok((key.get_ref().to_string(), Setting { origin, value }))
            })
            .collect()
    }
}

fn leaf(value: &DeValue<'_>) -> Result<toml::Value> {
    Ok(match value {
        DeValue::String(text) => toml::Value::String(text.to_string()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => toml::Value::Integer(number),
            Err(_) => bail!("{number} does not fit a 64-bit integer"),
        },
        DeValue::Float(number) => toml::Value::Float(number.as_str().parse().context("not a number")?),
        DeValue::Boolean(truth) => toml::Value::Boolean(*truth),
        DeValue::Datetime(date) => toml::Value::Datetime(*date),
        DeValue::Array(items) => {
            toml::Value::Array(items.iter().map(|item| leaf(item.get_ref())).collect::<Result<_>>()?)
        }
        DeValue::Table(table) => {
            let pair = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
                let key: &std::borrow::Cow<'_, str> = key.get_ref();
                Ok((key.to_string(), leaf(value.get_ref())?))
            };
            toml::Value::Table(table.iter().map(pair).collect::<Result<_>>()?)
        }
    })
}
