use host::bench::{Bench, Machine, DriveSample, Hidden};
use host::fit::{self, Options, Fit};
use host::problem::Data;
use host::recording::{Drive, Recording};
use host::solve::lm_quick::LmQuick;
use shared::effects::Kind;
use shared::excite::{commands, COMMISSIONING, COMMISSIONING_COAST};
use std::sync::atomic::AtomicBool;

fn record(machine: &str, hidden: &[&str], coast: bool, seed: u64) -> Recording {
    let m = Machine::preset(machine).unwrap();
    let mut b = Bench::new(m.clone());
    b.counts_per_rev = 2000;
    b.sample_s = 1e-3;
    b.seed = seed;
    for h in hidden { b.effects.push(Hidden::parse(h, &m).unwrap()); }
    let plan = if coast { &COMMISSIONING_COAST } else { &COMMISSIONING };
    let d: Vec<DriveSample> = commands::<f64>(plan, 1e-3, seed).map(|c| DriveSample { volts: c.drive * m.supply_v, enabled: c.enabled }).collect();
    let run = b.run(&d).unwrap();
    Recording { source: machine.into(), time_s: run.time_s, command: run.voltage_v, counts: run.counts.iter().map(|&c| c as f64).collect(), current_a: None,
        enabled: coast.then_some(run.enabled), counts_per_rev: 2000.0, quantised: true, supply_v: Some(m.supply_v), drive: Drive::Voltage }
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let hidden: Vec<&str> = args.get(1).map(|s| s.split('+').filter(|s| !s.is_empty()).collect()).unwrap_or_default();
    let with: Vec<Kind> = args.get(2).map(|s| s.split(',').filter(|s| !s.is_empty()).map(|s| Kind::by_name(s).unwrap()).collect()).unwrap_or_default();
    let coast = args.get(3).is_some_and(|s| s == "coast");
    let rec = record(&args[0], &hidden, coast, 1);
    let val = record(&args[0], &hidden, coast, 2);
    let (data, vdata) = (Data::new(&rec).unwrap(), Data::new(&val).unwrap());
    let options = Options { effects: with, ..Default::default() };
    let t = std::time::Instant::now();
    let problem = fit::problem(&data, &options).unwrap();
    println!("start {:?} {:?}", problem.structure.values(problem.start.as_ref().unwrap()), t.elapsed());
    let stop = AtomicBool::new(false);
    let found = fit::search(&problem, &LmQuick, &options, &stop, &mut |_, _| {});
    println!("evals {} {:?}", found.evaluations, t.elapsed());
    let f = Fit::conclude(&problem, "lm", "squared", &found, &options, Some(&vdata)).unwrap();
    println!("rms {} validate {:?} eff {} windowed {:?}", f.rms_counts, f.validate_rms_counts, f.effective_samples, f.windowed);
    for p in &f.parameters { println!("{p:?}"); }
    for n in &f.notes { println!("- {n}"); }
    let m = Machine::preset(&args[0]).unwrap();
    {
        use host::problem::{Candidate, StartAngle, cost::{errors, rms_counts, Horizon}, simulate::Method};
        use shared::effects::EffectSet;
        let ph = shared::motor::Physical { resistance: m.resistance_ohm, inductance: m.inductance_h, kt: m.kt_n_m_a, kb: m.kb_v_s_rad, inertia: m.inertia_kg_m2, viscous: m.viscous_n_m_s };
        let mut set = EffectSet::default();
        for h in &hidden { let h = Hidden::parse(h, &m).unwrap();
            let ps: Vec<_> = h.parameters().collect(); println!("{ps:?}");
            let k = Kind::by_name(h.name()).unwrap();
            let mut v: Vec<f64> = ps.iter().map(|p| if p.2.contains('N') { p.1 * m.resistance_ohm / m.kt_n_m_a } else { p.1 }).collect();
            if h.name() == "stribeck" { v = vec![v[0], v[1] - v[0], v[2]]; }
            if h.name() == "cogging" { let (a, ph) = (v[0], v[2]); v = vec![a * ph.sin(), a * ph.cos(), v[1]]; }
            println!("{v:?}");
            set.push(k, &v).unwrap(); }
        for sub in [1, 2, 4, 8] {
        let c = Candidate { machine: ph.machine(), effects: set, start_speed: 0.0 };
        let e = errors(&data, &c, Method { substeps: sub, ..Default::default() }, &Horizon::Whole, StartAngle::Free, shared::cost::Cost::Squared).unwrap();
        println!("TRUTH rms substeps {sub}: {} {:?}", rms_counts(&data, &e), ph.machine().response()); }
    }
    let d = m.kt_n_m_a * m.kb_v_s_rad + m.resistance_ohm * m.viscous_n_m_s;
    let g = m.kt_n_m_a / d; let a1 = (m.resistance_ohm * m.inertia_kg_m2 + m.inductance_h * m.viscous_n_m_s) / d;
    println!("true gain {g} a1 {a1} te {} -> err {:.5}% {:.5}%", m.inductance_h / m.resistance_ohm, 100.0 * (f.response.gain / g - 1.0), 100.0 * (f.response.a1 / a1 - 1.0));
    println!("{:?}", t.elapsed());
}
