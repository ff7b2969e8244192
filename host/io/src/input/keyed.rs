//! Rows that name each of their numbers, as programs on a microcontroller print them: `t:1 v:2.5, pos=3`.

/// The names and the texts of the numbers of a row, in their order; `None` where the row is no such row.
pub(super) fn pairs(line: &[u8]) -> Option<Vec<(&str, &str)>> {
    let mut rest = std::str::from_utf8(line).ok()?.trim();
    let mut pairs = Vec::new();
    while !rest.is_empty() {
        let (name, behind) = rest.split_once([':', '='])?;
        let behind = behind.trim_start();
        let end = behind
            .find(|c: char| c.is_whitespace() || c == ',' || c == ';')
            .unwrap_or(behind.len());
        let (number, behind) = behind.split_at(end);
        let name = name.trim();
        let is_name = name.starts_with(|c: char| c.is_alphabetic() || c == '_')
            && name
                .chars()
                .all(|c| c.is_alphanumeric() || "_ .[]()/-".contains(c));
        if !is_name || number.is_empty() {
            return None;
        }
        pairs.push((name, number));
        rest = behind.trim_start_matches(|c: char| c.is_whitespace() || c == ',' || c == ';');
    }
    Some(pairs)
}

/// The names of a row whose numbers are all numbers, two or more and each once.
pub(super) fn keys(line: &[u8]) -> Option<Vec<String>> {
    let pairs = pairs(line)?;
    let names: Vec<String> = pairs.iter().map(|(name, _)| (*name).to_owned()).collect();
    let all = pairs
        .iter()
        .all(|(_, number)| number.parse::<f64>().is_ok());
    let once = (0..names.len()).all(|k| !names[..k].contains(&names[k]));
    (all && once && names.len() >= 2).then_some(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_taken_apart() {
        let all: [(&str, &[(&str, &str)]); 4] = [
            (
                "t:1 v:2.5 pos:-3",
                &[("t", "1"), ("v", "2.5"), ("pos", "-3")],
            ),
            (
                "t: 1, v = 2.5,\tpos[0]: 3 ",
                &[("t", "1"), ("v", "2.5"), ("pos[0]", "3")],
            ),
            ("time (ms):1;u=2", &[("time (ms)", "1"), ("u", "2")]),
            ("", &[]),
        ];
        for (line, wanted) in all {
            assert_eq!(pairs(line.as_bytes()).as_deref(), Some(wanted), "{line}");
        }
        for line in ["1,2,3", "t:", "t:1 done", "12:30 1", "\u{0}:1"] {
            assert_eq!(keys(line.as_bytes()), None, "{line}");
        }
        assert_eq!(keys(b"\xff:1 b:2"), None);
    }
}
