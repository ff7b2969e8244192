//! Reads the text of a definition of ROS.
//!
//! The crate `re_ros_msg` is not used: it trusts the lengths in a message, and definitions that hold themselves.

use super::schema::{Count, Field, Schema, Type};
use std::collections::HashMap;

/// How deep definitions may lie within each other.
const DEEPEST: usize = 32;
/// Definitions that a message may refer to.
const MOST_DEFINITIONS: usize = 1024;

impl Schema {
    /// Reads a definition of the message `name`; an error says which part of it is not known.
    pub(crate) fn parse(name: &str, text: &str, is_ros1: bool) -> Result<Self, String> {
        let mut definitions: HashMap<String, Vec<&str>> = HashMap::new();
        let (mut current, mut lines) = (key(name), Vec::new());
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.starts_with("===") {
                continue;
            }
            if let Some(next) = line.strip_prefix("MSG:") {
                let whole = std::mem::take(&mut lines);
                definitions.entry(current).or_insert(whole);
                current = key(next.trim());
            } else if !line.is_empty() {
                lines.push(line);
            }
        }
        definitions.entry(current).or_insert(lines);
        if definitions.len() > MOST_DEFINITIONS {
            return Err(format!("a message with {} definitions", definitions.len()));
        }
        let mut reader = Reader {
            definitions: &definitions,
            numbers: HashMap::new(),
            open: Vec::new(),
            schema: Schema {
                messages: Vec::new(),
                is_ros1,
            },
        };
        reader.message(&key(name))?;
        Ok(reader.schema)
    }
}

/// `package/Type` of a name that may be `package/msg/Type`.
fn key(name: &str) -> String {
    name.replace("/msg/", "/")
}

struct Reader<'t> {
    definitions: &'t HashMap<String, Vec<&'t str>>,
    numbers: HashMap<String, usize>,
    /// The definitions that are being read, each within the one before.
    open: Vec<String>,
    schema: Schema,
}

impl Reader<'_> {
    fn message(&mut self, key: &str) -> Result<usize, String> {
        if let Some(number) = self.numbers.get(key) {
            return Ok(*number);
        }
        if self.open.len() >= DEEPEST || self.open.iter().any(|open| open == key) {
            return Err(format!(
                "the definition of {key}, which lies too deep within itself"
            ));
        }
        let Some(lines) = self.definitions.get(key) else {
            return Err(format!("a message with {key}, which is not defined"));
        };
        let number = self.schema.messages.len();
        self.schema.messages.push(Vec::new());
        self.open.push(key.to_owned());
        let mut fields = Vec::new();
        for line in lines {
            if let Some(field) = self.field(key, line)? {
                fields.push(field);
            }
        }
        self.open.pop();
        if let Some(message) = self.schema.messages.get_mut(number) {
            *message = fields;
        }
        self.numbers.insert(key.to_owned(), number);
        Ok(number)
    }

    /// The field of a line; `None` where the line is a constant.
    fn field(&mut self, within: &str, line: &str) -> Result<Option<Field>, String> {
        let strange = || format!("the line {line:?} of the definition of {within}");
        let (kind, rest) = line.split_once(char::is_whitespace).ok_or_else(strange)?;
        let rest = rest.trim_start();
        let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let end = rest.find(|c| !is_name(c)).unwrap_or(rest.len());
        let (name, rest) = rest.split_at_checked(end).ok_or_else(strange)?;
        if rest.trim_start().starts_with('=') {
            return Ok(None);
        }
        if name.is_empty() {
            return Err(strange());
        }
        let (kind, count) = match kind.split_once('[') {
            None => (kind, Count::One),
            Some((kind, count)) => {
                let count = count.strip_suffix(']').ok_or_else(strange)?;
                let count = match count.strip_prefix("<=").unwrap_or(count) {
                    fixed if fixed == count && !fixed.is_empty() => {
                        Count::Fixed(fixed.parse().map_err(|_| strange())?)
                    }
                    _ => Count::Any,
                };
                (kind, count)
            }
        };
        let kind = self.kind(within, kind)?;
        // Without a byte of its own, it is nowhere in the message.
        if count == Count::Fixed(0) || self.schema.is_ros1 && self.is_empty(kind) {
            return Ok(None);
        }
        Ok(Some(Field {
            name: name.to_owned(),
            kind,
            count,
        }))
    }

    fn is_empty(&self, kind: Type) -> bool {
        let Type::Message(number) = kind else {
            return false;
        };
        self.schema.messages.get(number).is_some_and(Vec::is_empty)
    }

    fn kind(&mut self, within: &str, name: &str) -> Result<Type, String> {
        let is_ros1 = self.schema.is_ros1;
        Ok(match name.split("<=").next().unwrap_or(name) {
            "bool" => Type::Bool,
            "byte" if is_ros1 => Type::I8,
            "int8" => Type::I8,
            "uint8" | "byte" | "char" => Type::U8,
            "int16" => Type::I16,
            "uint16" => Type::U16,
            "int32" => Type::I32,
            "uint32" => Type::U32,
            "int64" => Type::I64,
            "uint64" => Type::U64,
            "float32" | "float" => Type::F32,
            "float64" | "double" => Type::F64,
            "string" => Type::Text,
            "wstring" => return Err("a message with texts of wide characters".to_owned()),
            "time" | "builtin_interfaces/Time" | "builtin_interfaces/msg/Time" => Type::Time,
            "duration" | "builtin_interfaces/Duration" | "builtin_interfaces/msg/Duration" => {
                Type::Duration
            }
            other => Type::Message(self.message(&self.resolved(within, other))?),
        })
    }

    /// The definition that a name means: one of the same package unless it says another.
    fn resolved(&self, within: &str, name: &str) -> String {
        if name.contains('/') {
            return key(name);
        }
        let package = within.rsplit_once('/').map_or("", |(package, _)| package);
        let own = format!("{package}/{name}");
        if self.definitions.contains_key(&own) {
            return own;
        }
        if name == "Header" {
            return "std_msgs/Header".to_owned();
        }
        let end = format!("/{name}");
        let mut ending = self.definitions.keys().filter(|key| key.ends_with(&end));
        match (ending.next(), ending.next()) {
            (Some(only), None) => only.clone(),
            _ => own,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Schema;
    use crate::mcap::ros::schema::{Count, Type};

    const TEXT: &str = "\
# A comment
uint8 LIMIT = 3
string NAME=\"a # b\"
std_msgs/Header header
string<=10 label \"x=1\"
float64[] position
Pose[2] poses  # and its comment
int32[<=4] few
================================================================================
MSG: std_msgs/msg/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: test_msgs/Pose
float32 x 1.5
";

    #[test]
    fn definitions_are_read_with_all_that_they_refer_to() {
        let schema = Schema::parse("test_msgs/msg/Arm", TEXT, false);
        let messages = schema.map(|schema| schema.messages).unwrap_or_default();
        let fields: Vec<Vec<(&str, Type, Count)>> = messages
            .iter()
            .map(|fields| {
                fields
                    .iter()
                    .map(|f| (f.name.as_str(), f.kind, f.count))
                    .collect()
            })
            .collect();
        let arm = vec![
            ("header", Type::Message(1), Count::One),
            ("label", Type::Text, Count::One),
            ("position", Type::F64, Count::Any),
            ("poses", Type::Message(2), Count::Fixed(2)),
            ("few", Type::I32, Count::Any),
        ];
        let header = vec![
            ("stamp", Type::Time, Count::One),
            ("frame_id", Type::Text, Count::One),
        ];
        let pose = vec![("x", Type::F32, Count::One)];
        assert_eq!(fields, [arm, header, pose]);
    }

    #[test]
    fn a_definition_that_holds_itself_is_refused() {
        let text = "B b\n===\nMSG: p/B\nA a\n===\nMSG: p/A\nB b";
        assert!(Schema::parse("p/A", text, false).is_err());
        assert!(Schema::parse("p/A", "Missing m", false).is_err());
    }
}
