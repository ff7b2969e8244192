//! What the elements of a NumPy array are made of.

use super::literal::Literal;
use crate::log::Kind;
use crate::number::{Class, Number};
use crate::plan::MOST_COLUMNS;

/// Depth to which structured elements are nested.
const DEEPEST: usize = 16;
/// Steps that a description may take to be understood, those that add no value among them.
const MOST_STEPS: u64 = 16 * MOST_COLUMNS;

/// How one value of an element is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scalar {
    /// A number.
    Number(Number),
    /// True or false.
    Flag,
    /// A time or a duration as a count of ticks.
    Ticks {
        /// Whether its first byte is the most significant one.
        big: bool,
        /// Seconds of a tick, times `denominator`.
        numerator: f64,
        /// See `numerator`.
        denominator: f64,
    },
    /// A text, or what is no number.
    Text,
}

/// One value of an element.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    /// Its name; empty where the element is one value.
    pub(crate) name: String,
    /// Its first byte in the element.
    pub(crate) offset: u64,
    /// Its bytes.
    pub(crate) bytes: u64,
    /// How it is written.
    pub(crate) scalar: Scalar,
}

impl Field {
    /// What its values are.
    pub(crate) fn kind(&self) -> Kind {
        match self.scalar {
            Scalar::Number(_) => Kind::Number,
            Scalar::Flag => Kind::Flag,
            Scalar::Ticks { .. } => Kind::Time,
            Scalar::Text => Kind::Text,
        }
    }
}

/// The elements of an array.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Dtype {
    /// The values of an element.
    pub(crate) fields: Vec<Field>,
    /// The bytes of an element.
    pub(crate) bytes: u64,
    /// Whether it is a text of little-endian letters of four bytes, and no other.
    pub(crate) is_unicode: bool,
    steps: u64,
}

/// Why elements cannot be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Untold {
    /// They are objects of Python.
    Objects,
    /// They have more values than is allowed.
    TooMany,
    /// The description is none.
    Damaged,
}

impl Dtype {
    /// Reads the description of a header.
    pub(crate) fn parse(description: &Literal) -> Result<Self, Untold> {
        let is_unicode = matches!(description, Literal::Text(code) if code.starts_with("<U"));
        let mut dtype = Dtype {
            is_unicode,
            ..Dtype::default()
        };
        dtype.add("", description, DEEPEST)?;
        Ok(dtype)
    }

    /// The value that an element is, if it is one without a name.
    pub(crate) fn plain(&self) -> Option<&Field> {
        match self.fields.as_slice() {
            [field] if field.name.is_empty() => Some(field),
            _ => None,
        }
    }

    fn add(&mut self, name: &str, description: &Literal, depth: usize) -> Result<(), Untold> {
        let depth = depth.checked_sub(1).ok_or(Untold::Damaged)?;
        self.step()?;
        match description {
            Literal::Text(code) => self.add_scalar(name, code),
            Literal::List(fields) => fields.iter().try_for_each(|field| {
                let Literal::List(parts) = field else {
                    return Err(Untold::Damaged);
                };
                let (label, inner, axes) = match parts.as_slice() {
                    [label, inner] => (label, inner, Vec::new()),
                    [label, inner, axes] => (label, inner, self::axes(axes)?),
                    _ => return Err(Untold::Damaged),
                };
                let path = crate::plan::join(name, ".", field_name(label)?);
                self.add_array(&path, inner, &axes, depth)
            }),
            _ => Err(Untold::Damaged),
        }
    }

    fn add_array(
        &mut self,
        name: &str,
        element: &Literal,
        axes: &[u64],
        depth: usize,
    ) -> Result<(), Untold> {
        let Some((&first, others)) = axes.split_first() else {
            return self.add(name, element, depth);
        };
        let depth = depth.checked_sub(1).ok_or(Untold::Damaged)?;
        (0..first).try_for_each(|at| {
            self.step()?;
            self.add_array(&format!("{name}[{at}]"), element, others, depth)
        })
    }

    fn step(&mut self) -> Result<(), Untold> {
        self.steps += 1;
        if self.steps > MOST_STEPS {
            return Err(Untold::TooMany);
        }
        Ok(())
    }

    fn add_scalar(&mut self, name: &str, code: &str) -> Result<(), Untold> {
        let (scalar, bytes) = scalar(code)?;
        if self.fields.len() as u64 >= MOST_COLUMNS {
            return Err(Untold::TooMany);
        }
        self.fields.push(Field {
            name: name.to_owned(),
            offset: self.bytes,
            bytes,
            scalar,
        });
        self.bytes = self.bytes.checked_add(bytes).ok_or(Untold::TooMany)?;
        Ok(())
    }
}

/// The name of a field, which may stand behind a title.
fn field_name(label: &Literal) -> Result<&str, Untold> {
    match label {
        Literal::Text(name) => Ok(name),
        Literal::List(titled) => match titled.as_slice() {
            [_, Literal::Text(name)] => Ok(name),
            _ => Err(Untold::Damaged),
        },
        _ => Err(Untold::Damaged),
    }
}

fn axes(literal: &Literal) -> Result<Vec<u64>, Untold> {
    match literal {
        Literal::Count(length) => Ok(vec![*length]),
        _ => literal.counts().ok_or(Untold::Damaged),
    }
}

/// A value and its bytes, from a code like `<f8`.
fn scalar(code: &str) -> Result<(Scalar, u64), Untold> {
    let big = code.starts_with('>');
    let code = code.strip_prefix(['<', '>', '|', '=']).unwrap_or(code);
    let mut letters = code.chars();
    let letter = letters.next().ok_or(Untold::Damaged)?;
    if letter == 'O' {
        return Err(Untold::Objects);
    }
    let (size, unit) = letters
        .as_str()
        .split_once('[')
        .unwrap_or((letters.as_str(), ""));
    let size: u64 = size.parse().map_err(|_| Untold::Damaged)?;
    let number = |class: Option<Class>| match class {
        Some(class) => Scalar::Number(Number { class, big }),
        None => Scalar::Text,
    };
    let scalar = match letter {
        'b' if size == 1 => Scalar::Flag,
        'i' => number(Class::integer(size, true)),
        'u' => number(Class::integer(size, false)),
        'f' => number(Class::float(size)),
        'M' | 'm' if size == 8 => ticks(big, unit.trim_end_matches(']')),
        'c' | 'S' | 'a' | 'V' => Scalar::Text,
        'U' => return Ok((Scalar::Text, size.checked_mul(4).ok_or(Untold::TooMany)?)),
        _ => return Err(Untold::Damaged),
    };
    Ok((scalar, size))
}

/// Times in a unit like `ns` or `10us`. Years and months have no length in seconds.
fn ticks(big: bool, unit: &str) -> Scalar {
    let end = unit.trim_start_matches(|letter: char| letter.is_ascii_digit());
    let count = unit.strip_suffix(end).unwrap_or("");
    let count: f64 = if count.is_empty() {
        1.0
    } else {
        count.parse().unwrap_or(f64::NAN)
    };
    let (numerator, denominator) = match end {
        "W" => (604_800.0, 1.0),
        "D" => (86_400.0, 1.0),
        "h" => (3600.0, 1.0),
        "m" => (60.0, 1.0),
        "s" => (1.0, 1.0),
        "ms" => (1.0, 1e3),
        "us" | "μs" => (1.0, 1e6),
        "ns" => (1.0, 1e9),
        "ps" => (1.0, 1e12),
        "fs" => (1.0, 1e15),
        "as" => (1.0, 1e18),
        _ => return Scalar::Text,
    };
    Scalar::Ticks {
        big,
        numerator: numerator * count,
        denominator,
    }
}
