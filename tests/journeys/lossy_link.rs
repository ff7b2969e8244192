//! A link that loses, doubles and reorders frames: the device plays the plan that was ordered, or nothing.

use firmware::app::{App, Memory, Recording};
use firmware::board::Board;
use firmware::phase::{Bridge, Fault};
use host::device::Conversation;
use shared::fit::Settings;
use shared::rng::{self, Rng};
use shared::wire::{Job, Kind, Limits, Segment};
use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Result, Write};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Frames that can be under way at once.
const UNDER_WAY: usize = 4;

/// One direction of a link.
struct Wire {
    /// Of a hundred frames so many are lost, as many doubled, as many overtaken by the next.
    percent: u32,
    rng: rng::Generator,
    frame: Vec<u8>,
    held: VecDeque<Vec<u8>>,
    arrived: VecDeque<u8>,
}

impl Wire {
    fn new(percent: u32, seed: u64) -> Self {
        Wire {
            percent,
            rng: rng::seeded(seed),
            frame: Vec::new(),
            held: VecDeque::new(),
            arrived: VecDeque::new(),
        }
    }

    fn happens(&mut self) -> bool {
        rng::below(&mut self.rng, 100) < self.percent
    }

    fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.frame.push(byte);
            if byte == 0 {
                let frame = std::mem::take(&mut self.frame);
                let copies = match (self.happens(), self.happens()) {
                    (true, _) => 0,
                    (false, true) => 2,
                    (false, false) => 1,
                };
                for _ in 0..copies {
                    if self.happens() {
                        self.held.push_back(frame.clone());
                    } else {
                        self.arrived.extend(&frame);
                    }
                }
                // What was overtaken comes in any order, some of it much later.
                while self.held.len() > UNDER_WAY || (!self.held.is_empty() && self.happens()) {
                    let late = rng::below(&mut self.rng, self.held.len() as u32) as usize;
                    self.arrived
                        .extend(self.held.remove(late).unwrap_or_default());
                }
            }
        }
    }
}

/// What device and host share.
struct Table {
    to_device: Wire,
    to_host: Wire,
    driven: Option<i16>,
    played: Vec<Option<i16>>,
    periods: u64,
}

type Shared = Arc<Mutex<Table>>;

/// A board with a shaft that stands; it keeps what it was told to drive.
struct Still(Shared);

impl Board for Still {
    const NAME: &'static str = "still";
    const PERIOD_US: u32 = 1000;
    const SLICE: u32 = 1000;

    fn drive(&mut self, duty: i16) {
        self.0.lock().unwrap().driven = Some(duty);
    }

    fn coast(&mut self) {
        self.0.lock().unwrap().driven = None;
    }

    fn count(&mut self) -> i32 {
        0
    }

    fn tick(&mut self) -> std::result::Result<(), Fault> {
        let mut table = self.0.lock().unwrap();
        let driven = table.driven;
        table.played.push(driven);
        table.periods += 1;
        Ok(())
    }

    fn receive(&mut self) -> Option<u8> {
        self.0.lock().unwrap().to_device.arrived.pop_front()
    }

    fn send(&mut self, bytes: &[u8]) -> usize {
        self.0.lock().unwrap().to_host.send(bytes);
        bytes.len()
    }

    fn entropy(&mut self) -> u32 {
        1
    }
}

type Device = App<'static, Still, f32, 4>;

/// The host's end; a read lets a period of the device pass.
struct End {
    table: Shared,
    device: Arc<Mutex<Device>>,
}

impl Read for End {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        self.device.lock().unwrap().period();
        let mut table = self.table.lock().unwrap();
        let taken = buffer.len().min(table.to_host.arrived.len());
        if taken == 0 {
            return Err(ErrorKind::TimedOut.into());
        }
        for (slot, byte) in buffer.iter_mut().zip(table.to_host.arrived.drain(..taken)) {
            *slot = byte;
        }
        Ok(taken)
    }
}

impl Write for End {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.table.lock().unwrap().to_device.send(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Small enough that no limit holds it back; it begins and ends with a drive, and no segment is a brake.
fn plan(rng: &mut rng::Generator) -> Vec<Segment> {
    let segments = 1 + rng::below(rng, 80);
    (0..segments)
        .map(|_| Segment {
            duty: 1 + rng::below(rng, 9_000) as i16,
            periods: 1 + rng::below(rng, 4) as u16,
        })
        .collect()
}

fn expanded(plan: &[Segment]) -> Vec<i16> {
    plan.iter()
        .flat_map(|segment| vec![segment.duty; segment.periods.into()])
        .collect()
}

fn job() -> Job {
    Job {
        kind: Kind::Play,
        amplitude: 20_000,
        excite: 0,
        coast: false,
        record: 0,
        verify: 0,
        verify_within: 100,
        accept: shared::fit::Grade::No,
        seed: 0,
        fit: Settings::USUAL,
        limits: Limits {
            duty: 32_000,
            time: 60_000,
            ..Limits::NONE
        },
        counts_per_rev: 2_000,
        supply_mv: 24_000,
    }
}

/// One run over a link that spoils so many of a hundred frames each way; true if the host says that it was started.
fn run(percent: u32, seed: u64) -> bool {
    let mut rng = rng::seeded(seed);
    let table = Arc::new(Mutex::new(Table {
        to_device: Wire::new(0, rng.next_u64()),
        to_host: Wire::new(0, rng.next_u64()),
        driven: None,
        played: Vec::new(),
        periods: 0,
    }));
    let memory = Box::leak(Box::new(Memory::new()));
    let recording = Box::leak(Box::new(Recording::new()));
    let device = Arc::new(Mutex::new(App::new(
        Still(Arc::clone(&table)),
        memory,
        recording,
    )));
    let end = End {
        table: Arc::clone(&table),
        device: Arc::clone(&device),
    };
    let (origin, clock) = (Instant::now(), Arc::clone(&table));
    let clock = move || origin + Duration::from_millis(clock.lock().unwrap().periods);
    let mut host =
        Conversation::over(Box::new(end), "lossy".to_owned()).with_clock(Box::new(clock));

    // The device has played another plan before, over a link that was whole.
    host.start(job(), &plan(&mut rng)).unwrap();
    for _ in 0..1000 {
        host.say(&shared::wire::ToDevice::Alive).unwrap();
        host.hear().unwrap();
    }
    host.about().unwrap();
    {
        let mut table = table.lock().unwrap();
        (table.to_device.percent, table.to_host.percent) = (percent, percent);
        table.played.clear();
    }
    let ordered = plan(&mut rng);
    let started = host.start(job(), &ordered);
    {
        let mut table = table.lock().unwrap();
        (table.to_device.percent, table.to_host.percent) = (0, 0);
    }
    for _ in 0..1000 {
        host.say(&shared::wire::ToDevice::Alive).unwrap();
        host.hear().unwrap();
    }
    assert_eq!(device.lock().unwrap().phase().bridge(), Bridge::Open);
    let played: Vec<i16> = table
        .lock()
        .unwrap()
        .played
        .iter()
        .flatten()
        .copied()
        .skip_while(|&duty| duty == 0)
        .collect();
    let wanted = expanded(&ordered);
    // A host that was not told that it runs falls silent, and the device stops.
    let right = match started {
        Ok(()) => played == wanted,
        Err(_) => wanted.starts_with(&played),
    };
    assert!(
        right,
        "seed {seed}, {percent} %, {started:?}: played {played:?} instead of {wanted:?}"
    );
    started.is_ok()
}

#[test]
fn over_any_link_the_device_plays_what_was_ordered_or_nothing() {
    let runs = testing::length::cases(10_000, 2_000);
    let mut started = 0;
    for seed in 0..runs as u64 {
        let percent = [1, 3, 10, 20, 30][seed as usize % 5];
        started += usize::from(run(percent, seed));
    }
    println!("{started} of {runs} runs were started");
    assert!(started * 10 > runs * 8, "{started} of {runs}");
}
