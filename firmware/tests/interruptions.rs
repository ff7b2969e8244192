//! A thousand interruptions of the link during commissionings: silence, noise, cut frames, frames that come twice or late.

use firmware::app::{Memory, Recording};
use firmware::phase::{Bridge, Phase};
use firmware::plant::SMALL;
use firmware::trials::{RECORD, bench::Bench, host::Host};
use shared::fit::{Fit, Settings};
use shared::rng::{self, Rng};
use shared::trace::Trace;
use shared::wire::*;
use std::cell::RefCell;
use std::collections::BTreeMap;

const RUNS: u64 = 250;
const INTERRUPTIONS: usize = 4;
/// Periods in which a run without interruptions has its outcome.
const WHOLE: u32 = 4_000;
/// Host time-out after which the device must open the bridge.
const SILENCE: u32 = 500;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Nothing arrives either way.
    Silence,
    /// Only what the host says is lost.
    Deaf,
    /// Only what the device says is lost.
    Mute,
    /// Every byte may be another.
    Noise,
    /// Every few bytes one is missing.
    Cut,
    /// Old frames of the host arrive again.
    Late,
}

const KINDS: [Kind; 6] = [
    Kind::Silence,
    Kind::Deaf,
    Kind::Mute,
    Kind::Noise,
    Kind::Cut,
    Kind::Late,
];

/// The host's knowledge at the end of a run.
#[derive(Default)]
struct Known {
    rows: BTreeMap<u32, Row>,
    report: Option<Report>,
    failure: Option<Failure>,
    armed: Option<u32>,
}

impl Known {
    fn receive(&mut self, message: ToHost) {
        match message {
            ToHost::Rows(rows) if rows.stage == Stage::Record => {
                for (k, row) in rows.rows.iter().enumerate() {
                    let earlier = self.rows.insert(rows.first + k as u32, *row);
                    // Retransmitted rows carry no current.
                    assert!(
                        earlier.is_none_or(
                            |earlier| (earlier.duty, earlier.step) == (row.duty, row.step)
                        ),
                        "period {} was told twice, differently",
                        rows.first + k as u32
                    );
                }
            }
            ToHost::Report(report) => self.report = Some(report),
            ToHost::Failed(failure) => self.failure = Some(failure),
            ToHost::Armed { nonce, .. } => self.armed = Some(nonce),
            _ => {}
        }
    }

    fn whole(&self) -> bool {
        self.rows.len() == RECORD
    }
}

fn start(nonce: u32) -> ToDevice {
    ToDevice::Start {
        nonce,
        job: job(),
        plan: PlanDigest::of(&[]),
    }
}

fn job() -> Job {
    Job {
        kind: shared::wire::Kind::Commission,
        amplitude: 30_000,
        excite: 700,
        coast: true,
        record: RECORD as u16,
        verify: 400,
        verify_within: 100,
        accept: shared::fit::Grade::No,
        seed: 3,
        fit: Settings {
            evaluations: 100,
            ..Settings::USUAL
        },
        limits: Limits {
            duty: 32_000,
            time: 60_000,
            ..Limits::NONE
        },
        counts_per_rev: SMALL.counts_per_rev as u32,
        supply_mv: 24_000,
    }
}

struct Table<'b> {
    host: Host<'b, f32, RECORD>,
    rng: rng::Generator,
    inbox: Deframer,
    known: Known,
    /// All frames sent by the host.
    said: Vec<u8>,
    /// Periods for which the bridge has driven since a byte reached the device.
    unheard: u32,
}

impl Table<'_> {
    fn send(&mut self, message: &ToDevice) {
        let mut buffer = [0; LONGEST_FRAME];
        let frame = encode(message, &mut buffer).unwrap();
        self.said.extend_from_slice(frame);
        let mut bench = self.host.bench.borrow_mut();
        for &byte in frame {
            let _ = bench.to_device.push_back(byte);
        }
    }

    /// Applies the interruption to bytes in transit.
    fn passes(&mut self, bytes: Vec<u8>, disturbed: Option<Kind>, to_device: bool) -> Vec<u8> {
        let rng = &mut self.rng;
        match disturbed {
            Some(Kind::Silence) => Vec::new(),
            Some(Kind::Deaf) if to_device => Vec::new(),
            Some(Kind::Mute) if !to_device => Vec::new(),
            Some(Kind::Noise) => bytes
                .into_iter()
                .map(|byte| {
                    if rng::below(rng, 8) == 0 {
                        rng.next_u32() as u8
                    } else {
                        byte
                    }
                })
                .collect(),
            Some(Kind::Cut) => bytes
                .into_iter()
                .filter(|_| rng::below(rng, 20) != 0)
                .collect(),
            Some(Kind::Late) if to_device && !self.said.is_empty() => {
                let from = rng::below(rng, self.said.len() as u32) as usize;
                let to = (from + 60).min(self.said.len());
                [bytes, self.said[from..to].to_vec()].concat()
            }
            _ => bytes,
        }
    }

    fn period(&mut self, disturbed: Option<Kind>) {
        if self.host.bench.borrow().period.is_multiple_of(100) {
            self.send(&ToDevice::Alive);
        }
        let waiting: Vec<u8> = self
            .host
            .bench
            .borrow_mut()
            .to_device
            .iter()
            .copied()
            .collect();
        let passed = self.passes(waiting, disturbed, true);
        self.unheard = if passed.is_empty() {
            self.unheard + 1
        } else {
            0
        };
        {
            let mut bench = self.host.bench.borrow_mut();
            bench.to_device.clear();
            for &byte in &passed {
                let _ = bench.to_device.push_back(byte);
            }
        }
        self.host.app.period();
        let (driven, said): (_, Vec<u8>) = {
            let mut bench = self.host.bench.borrow_mut();
            let said = bench.to_host.iter().copied().collect();
            bench.to_host.clear();
            (bench.driven, said)
        };
        let phase = self.host.app.phase();
        assert!(
            driven.is_none() || phase.bridge() == Bridge::Driven,
            "driven in {phase:?}"
        );
        if driven.is_none() {
            self.unheard = 0;
        }
        assert!(
            self.unheard <= SILENCE + 1,
            "driven though the host has been silent for {} periods",
            self.unheard
        );
        for byte in self.passes(said, disturbed, false) {
            if let Some(message) = self.inbox.push(byte) {
                self.known.receive(message);
            }
        }
    }
}

/// One run with interruptions; says whether it succeeded.
fn run(seed: u64) -> bool {
    let bench = RefCell::new(Bench::new(firmware::plant::Motor { ..SMALL }));
    let (mut memory, mut recording) = (Memory::<f32>::new(), Recording::<RECORD>::new());
    let mut table = Table {
        host: Host::new(&bench, &mut memory, &mut recording),
        rng: rng::seeded(seed),
        inbox: Deframer::new(),
        known: Known::default(),
        said: Vec::new(),
        unheard: 0,
    };
    let interruptions: Vec<(Kind, u32, u32)> = (0..INTERRUPTIONS)
        .map(|_| {
            let kind = KINDS[rng::below(&mut table.rng, KINDS.len() as u32) as usize];
            let at = 20 + rng::below(&mut table.rng, WHOLE * 3 / 4);
            // Most are short; some are longer than the device waits.
            let longest = [5, 50, 400, 1500][rng::below(&mut table.rng, 4) as usize];
            (kind, at, at + 1 + rng::below(&mut table.rng, longest))
        })
        .collect();
    table.send(&ToDevice::Arm);
    table.period(None);
    let nonce = table.known.armed.expect("armed over a whole link");
    table.send(&start(nonce));
    table.period(None);
    assert_eq!(table.host.app.phase(), Phase::Probe);

    let last = interruptions.iter().map(|&(_, _, to)| to).max();
    let until = last.unwrap_or(0) + WHOLE;
    for now in 0..until {
        let disturbed = interruptions
            .iter()
            .find(|&&(_, from, to)| (from..to).contains(&now))
            .map(|&(kind, ..)| kind);
        table.period(disturbed);
    }
    // The link has been whole for long enough: there is an outcome, and the device still tells it.
    let one_outcome = table.known.report.is_some() != table.known.failure.is_some();
    assert!(
        one_outcome,
        "no outcome, or two, in {:?}; {interruptions:?}",
        table.host.app.phase()
    );
    let succeeded = table.known.report.is_some();
    if succeeded {
        fetch(&mut table);
        let duties: Vec<i16> = table.known.rows.values().map(|row| row.duty).collect();
        let steps: Vec<i16> = table.known.rows.values().map(|row| row.step).collect();
        let trace = Trace::new(&duties, &steps);
        let mut fit = Fit::<f32>::idle();
        assert!(fit.begin(&trace, job().fit));
        let again = loop {
            if let Some(outcome) = fit.work(&trace, 1_000_000) {
                break outcome;
            }
        };
        let report = table.known.report.clone().unwrap();
        assert_eq!(report.outcome, Some(again), "the host repeats the fit");
    }
    // Nothing that was said during the run moves the motor again.
    table.send(&ToDevice::Hello);
    table.period(None);
    for now in 0..600 {
        table.period((now < 300).then_some(Kind::Late));
        assert_eq!(table.host.bench.borrow().driven, None);
    }
    succeeded
}

/// Asks for periods that were lost until the recording is whole.
fn fetch(table: &mut Table<'_>) {
    for _ in 0..RECORD {
        if table.known.whole() {
            return;
        }
        let first = (0..).find(|k| !table.known.rows.contains_key(k)).unwrap();
        table.send(&ToDevice::Resend { first });
        table.period(None);
    }
    panic!("{} of {RECORD} periods", table.known.rows.len());
}

#[test]
fn a_thousand_interruptions_never_hang_it_nor_move_it_unasked_and_what_it_reports_can_be_repeated()
{
    let succeeded = (0..RUNS).filter(|&seed| run(seed)).count();
    println!(
        "{} interruptions in {RUNS} runs: {succeeded} runs succeeded, the others were given up and said so",
        RUNS as usize * INTERRUPTIONS
    );
    assert!((RUNS as usize / 10..RUNS as usize).contains(&succeeded));
}
