//! The spectrum of a diagnosis finds the order of a cogging torque on drawn motors.

use super::{Case, Excite, HowMany, Laws, SetUp};
use servoid_identify::diagnose::order_lines;
use servoid_identify::fit::{Options, problem};
use testing::length::cases;

const SEED: u64 = 20_261_122;
const MOTORS: u64 = 30;

/// Whatever its order: drawn motors whose cogging is beyond a count, at 1,000 to some 10,000 counts a revolution.
#[test]
fn the_order_of_a_cogging_torque_is_the_first_line_beside_a_linear_motor_that_regression_found() {
    let set_up = SetUp {
        seed: SEED,
        hidden: HowMany::One,
        excite: Excite::Commissioning,
        effects: vec!["cogging".to_owned()],
        laws: Laws::Own,
        discover: false,
    };
    let mut found = 0;
    let motors = cases(MOTORS, 10);
    for number in 0..motors {
        let case = Case::record(&set_up, number).unwrap();
        let mut hidden = case.drawn.hidden[0].split([':', ',']);
        let order = hidden.find_map(|part| part.strip_prefix("order="));
        let order: usize = order.and_then(|order| order.parse().ok()).unwrap();
        let problem = problem(&case.fitted, &Options::default()).unwrap();
        let start = problem.start.clone().unwrap();
        let linear = problem.structure.candidate_at(&start);
        let lines = order_lines(&case.fitted, &linear);
        let place = lines.iter().position(|line| line.order == order);
        println!("seed {SEED}, motor {number}, order {order}: {place:?}");
        found += usize::from(place == Some(0));
    }
    println!("{found} of {motors}");
    assert!(found * 10 >= motors as usize * 9, "{found} of {motors}");
}
