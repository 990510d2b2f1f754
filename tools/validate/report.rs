//! The numbers of a topic, each with the limit that the project promises.

use serde_json::{Map, Value, json};

/// The limit of a number.
#[derive(Clone, Copy)]
enum Limit {
    AtMost(f64),
    AtLeast(f64),
}

impl Limit {
    /// NaN is within no limit.
    fn holds(self, value: f64) -> bool {
        match self {
            Self::AtMost(limit) => value <= limit,
            Self::AtLeast(limit) => value >= limit,
        }
    }
}

/// One measured number.
pub struct Figure {
    key: &'static str,
    value: f64,
    limit: Option<Limit>,
    note: &'static str,
}

/// The numbers of one topic, in the order in which they were added.
#[derive(Default)]
pub struct Report {
    figures: Vec<Figure>,
}

impl Report {
    /// Adds a number that must not exceed `limit`.
    pub fn at_most(&mut self, key: &'static str, value: f64, limit: f64, note: &'static str) {
        self.figures.push(Figure { key, value, limit: Some(Limit::AtMost(limit)), note });
    }

    /// Adds a number that must reach `limit`.
    pub fn at_least(&mut self, key: &'static str, value: f64, limit: f64, note: &'static str) {
        self.figures.push(Figure { key, value, limit: Some(Limit::AtLeast(limit)), note });
    }

    /// Adds a number without a limit.
    pub fn record(&mut self, key: &'static str, value: f64, note: &'static str) {
        self.figures.push(Figure { key, value, limit: None, note });
    }

    /// Whether every number is within its limit.
    pub fn holds(&self) -> bool {
        self.figures.iter().all(|figure| figure.limit.is_none_or(|limit| limit.holds(figure.value)))
    }

    /// Prints the numbers as a table.
    pub fn print(&self) {
        for Figure { key, value, limit, note } in &self.figures {
            let verdict = limit.map_or("recorded".to_owned(), |limit| {
                let (sign, value_limit) = match limit {
                    Limit::AtMost(value) => ("<=", value),
                    Limit::AtLeast(value) => (">=", value),
                };
                format!("{sign} {value_limit:<8} {}", if limit.holds(*value) { "ok" } else { "MISSED" })
            });
            println!("{key:<34} {value:>12.5e}   {verdict:<19}  {note}");
        }
    }

    /// The numbers as a flat JSON object.
    pub fn to_json(&self) -> Value {
        let numbers: Map<String, Value> =
            self.figures.iter().map(|figure| (figure.key.to_owned(), json!(figure.value))).collect();
        Value::Object(numbers)
    }
}
