//! Files that others recorded. They are not part of the project: where they are absent, that is said, and nothing is tested.

mod expected;

use expected::rows;
use servoid_formats::{Format, Log, open};
use std::path::{Path, PathBuf};

/// The file beside the checkout.
fn recorded(name: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/raw");
    let path = folder.join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("SKIPPED: there is no {}", path.display());
    None
}

fn opened(path: &Path, format: Format) -> Box<dyn Log> {
    let log = open(path).unwrap().unwrap();
    assert_eq!(log.format(), format);
    log
}

/// A table: its name, its rows, and its columns with their sums.
type Summed<'a> = (&'a str, u64, &'a [(&'a str, f64)]);

/// Every table with its rows and the sums of its columns, as NumPy and SciPy have them.
fn holds(log: &mut dyn Log, expected: &[Summed<'_>]) {
    let tables = log.tables().to_vec();
    assert_eq!(tables.len(), expected.len());
    for (at, (table, (name, count, columns))) in tables.iter().zip(expected).enumerate() {
        assert_eq!((&*table.name, table.rows), (*name, Some(*count)));
        let names = table.columns.iter().map(|column| &*column.name);
        assert!(names.eq(columns.iter().map(|(name, _)| *name)));
        let all: Vec<usize> = (0..columns.len()).collect();
        for (values, (name, sum)) in rows(log, at, &all).unwrap().iter().zip(*columns) {
            assert_eq!(values.len() as u64, *count);
            let found: f64 = values.iter().sum();
            let size: f64 = values.iter().map(|value| value.abs()).sum();
            assert!(
                (found - sum).abs() <= 1e-9 * size,
                "{name}: {found} and not {sum}"
            );
        }
    }
}

#[test]
fn matlab_structs_of_a_course_kit() {
    let chirp = [
        ("Time", 400_010.0),
        ("Input", 22_455.006_555_264_42),
        ("Velo", 377_945.257_158_756_3),
    ];
    let step = [
        ("Time", 9_001.5),
        ("Input", 48_000.0),
        ("Velo", 958_331.483_186_721_8),
    ];
    for (name, count, columns) in [
        ("fra233_g04_chirp_1.mat", 40_001, chirp),
        ("fra233_g04_step_1.mat", 6001, step),
    ] {
        let Some(path) = recorded(name) else { return };
        let mut log = opened(&path, Format::Matlab5);
        holds(&mut *log, &[("RawData", count, &columns)]);
    }
}

#[test]
fn numpy_array_of_an_odrive() {
    let Some(path) = recorded("odrive_slow2_nocomp_0.npy") else {
        return;
    };
    let mut log = opened(&path, Format::Npy);
    let columns = [
        ("[0]", 21_358.149_607_181_55),
        ("[1]", 17_456_022.311_421_394),
        ("[2]", 1_166.489_448_870_881_5),
    ];
    holds(&mut *log, &[("", 4306, &columns)]);
}

#[test]
fn four_tests_of_sysid() {
    let Some(path) = recorded("frc_simple_sysid.json") else {
        return;
    };
    let mut log = opened(&path, Format::SysId);
    // Times begin with each test.
    let table = |name, count: u64, sums: [f64; 4], start: f64| {
        let [time, voltage, position, velocity] = sums;
        let time = time - start * count as f64;
        let columns = [
            ("time", time),
            ("voltage", voltage),
            ("position", position),
            ("velocity", velocity),
        ];
        (name, count, columns)
    };
    let tables = [
        table(
            "fast-backward",
            1167,
            [
                95_624.970_214_000_02,
                -8_162.0,
                1_036_202.977_544_000_4,
                -65_207.387_699,
            ],
            79.025809,
        ),
        table(
            "fast-forward",
            1287,
            [
                91_815.678_175,
                9_002.0,
                1_112_130.302_252_999,
                71_249.018_563,
            ],
            68.126067,
        ),
        table(
            "slow-backward",
            3027,
            [
                138_851.043_434,
                -5_721.119_515,
                2_459_159.528_844_995_4,
                -33_602.392_537,
            ],
            38.305818,
        ),
        table(
            "slow-forward",
            4211,
            [
                90_161.223_135,
                11_074.989_65,
                2_504_166.700_517_009,
                72_980.776_357,
            ],
            10.886112,
        ),
    ];
    let tables: Vec<_> = tables
        .iter()
        .map(|(name, count, sums)| (*name, *count, &sums[..]))
        .collect();
    holds(&mut *log, &tables);
    let unit = log.tables()[0].columns[2].unit.clone().unwrap();
    assert!(
        unit.contains("1 rotation = 6.283185307179586 Radians"),
        "{unit}"
    );
}

#[test]
fn entries_of_bam() {
    let Some(path) = recorded("bam_xl330_up_and_down_kp400.json") else {
        return;
    };
    let mut log = opened(&path, Format::Json);
    let columns = [
        ("position", 720.981_708_171_766_7),
        ("speed", 170.191_907_377_287_63),
        ("load", 525_543.0),
        ("input_volts", 8_152.2),
        ("temp", 36_175.0),
        ("timestamp", 3_382.501_674_056_053),
        ("goal_position", 1_236.836_577_854_661_8),
        ("torque_enable", 1_123.0),
    ];
    holds(&mut *log, &[("entries", 1123, &columns)]);
    let facts = log.facts();
    assert!(facts.contains(&("mass".to_owned(), "0.49".to_owned())));
    assert!(facts.contains(&("motor".to_owned(), "xl330".to_owned())));
}
