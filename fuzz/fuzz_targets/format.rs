//! Any bytes as a file of any format: its tables are listed and every column of numbers is read, or refused in words; every row has as many numbers as
//! columns were asked for. A hundred times faster than `log`, which guesses what the columns are, too.
#![no_main]

mod place;

use libfuzzer_sys::fuzz_target;
use servoid_formats::{Kind, open};
use std::ops::ControlFlow;

/// What one table may cost.
const MOST_ROWS: usize = 10_000;

fuzz_target!(|data: &[u8]| {
    place::with_file(data, |path| {
        let Ok(Some(mut log)) = open(path) else { return };
        let numbers: Vec<Vec<usize>> = (log.tables().iter())
            .map(|table| {
                let columns = table.columns.iter().enumerate();
                columns.filter(|(_, column)| column.kind != Kind::Text).map(|(k, _)| k).collect()
            })
            .collect();
        for (table, asked) in numbers.into_iter().enumerate() {
            let mut rows = 0;
            let read = log.read(table, &asked, &mut |part| {
                assert_eq!(part.len(), asked.len());
                assert!(part.iter().all(|column| column.len() == part[0].len()));
                rows += part.first().map_or(0, Vec::len);
                if rows < MOST_ROWS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            });
            if let Err(error) = read {
                assert!(!error.to_string().is_empty());
            }
        }
    });
});
