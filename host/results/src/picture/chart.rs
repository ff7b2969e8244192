//! A chart as plain data: what plotly's script takes, as its reference names it (<https://plotly.com/javascript/reference/>).

use serde::Serialize;
use serde_json::{Map, Value};

/// A chart.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Chart {
    data: Vec<Properties>,
    layout: Properties,
}

impl Chart {
    /// Adds a line, a set of points or bars.
    pub(super) fn add(&mut self, trace: Properties) {
        self.data.push(trace);
    }

    /// Says how it is laid out.
    pub(super) fn lay_out(&mut self, layout: Properties) {
        self.layout = layout;
    }
}

/// Properties by their names.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Properties(Map<String, Value>);

impl Properties {
    /// These and one more, or another value of one. A number that is not finite becomes `null`, which is drawn as a gap.
    pub(super) fn set(mut self, name: &str, value: impl Serialize) -> Self {
        let value = serde_json::to_value(value).unwrap_or_default();
        self.0.insert(name.to_owned(), value);
        self
    }
}

/// Points at `x` and `y`, joined by lines or not as their `mode` says.
pub(super) fn scatter(x: impl Serialize, y: impl Serialize) -> Properties {
    trace("scatter", x, y)
}

/// Bars at `x`, so high as `y`.
pub(super) fn bars(x: impl Serialize, y: impl Serialize) -> Properties {
    trace("bar", x, y)
}

/// How a line is drawn: its colour, and its width, px.
pub(super) fn stroke(colour: impl Serialize, width: impl Serialize) -> Properties {
    let own = Properties::default().set("color", colour);
    own.set("width", width)
}

/// How points are drawn: their colour, and their size, px.
pub(super) fn marker(colour: impl Serialize, size: impl Serialize) -> Properties {
    let own = Properties::default().set("color", colour);
    own.set("size", size)
}

fn trace(kind: &str, x: impl Serialize, y: impl Serialize) -> Properties {
    let own = Properties::default().set("type", kind);
    own.set("x", x).set("y", y)
}
