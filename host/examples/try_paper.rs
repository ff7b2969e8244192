use host::paper::*;
use host::compare;
use host::solve::Objective;
use std::sync::atomic::AtomicBool;
fn main() {
    let data = Experiment { seconds: 10.0, sample_s: 1e-3 }.record().unwrap();
    let stop = AtomicBool::new(false);
    for v in Variant::all() {
        let p = paper_problem(&data, v, BOX);
        let truth = p.structure.coordinates(&[0.02, 1.2, 0.06, 6.2e-4, 1e-4, 0.06]);
        println!("{} truth {}", v.name(), p.cost(&truth));
        let c = compare::Contest { problem: &p, budget: 5000, seeds: (1..=30).collect() };
        let t = std::time::Instant::now();
        let rows = compare::run(&c, &solvers(5), &stop, &|| {});
        println!("{:?}\n{}", t.elapsed(), host::report::text::compare(&rows, 5000, 30));
        if let Some(p) = identifiable_problem(&data, v) {
            println!("start cost {}", p.cost(p.start.as_ref().unwrap()));
            let c = compare::Contest { problem: &p, budget: 1500, seeds: (1..=10).collect() };
            let rows = compare::run(&c, &host::solve::all(), &stop, &|| {});
            println!("{}", host::report::text::compare(&rows, 1500, 10));
        }
    }
}
