//! The servo's laws: on drawn motors a step is answered as the gains predict, with friction, a coarse encoder, and a motor that is not quite the fitted one.

use shared::fit::Evaluation;
use shared::model::{Rigid, RigidPlan};
use shared::motor::Response as Voltage;
use shared::rng;
use shared::servo::{Gains, Response, Servo, Step, Target};
use shared::units::PerUnit;

/// A motor in counts, periods and parts of the supply.
#[derive(Clone, Copy, Debug)]
struct Motor {
    gain: f32,
    mechanical: f32,
    electrical: f32,
    coulomb: f32,
}

fn draw(seed: u64) -> Motor {
    let rng = &mut rng::seeded(seed);
    let mut between = |low: f32, high: f32| low * (high / low).powf(rng::uniform(rng));
    let counts = [12.0, 44.0, 100.0, 400.0, 2_000.0, 8_192.0][(seed % 6) as usize];
    Motor {
        // 250 to 1200 rad/s.
        gain: between(0.04, 0.19) * counts,
        mechanical: between(4.0, 300.0),
        electrical: between(0.05, 1.0),
        coulomb: between(0.01, 0.06),
    }
}

impl Motor {
    fn gains(&self) -> Gains {
        Gains::of(
            self.gain,
            [self.mechanical, self.electrical],
            self.coulomb,
            0.02,
        )
    }

    fn model(&self) -> Evaluation<f32> {
        let response = Voltage {
            gain: f64::from(self.gain),
            a1: f64::from(self.mechanical),
            a2: f64::from(self.mechanical * self.electrical),
        };
        let plan = RigidPlan {
            machine: response.machine(),
            coulomb: f64::from(self.coulomb),
            load: 0.0,
            dead_time: 0.0,
            carriers: 0.0,
            supply: 0.0,
            full: 1.0,
            units: PerUnit::new(1.0, f64::from(self.gain), 1.0, std::f64::consts::TAU).unwrap(),
        };
        Evaluation::new(Rigid::new(&plan).expect("a motor")).expect("within f32")
    }
}

fn step_of(motor: &Motor, gains: &Gains, target: f32) -> Response {
    let mut model = motor.model();
    let (mut servo, mut step) = (Servo::IDLE, Step::NONE);
    servo.begin(*gains, 0.9);
    step.begin(target);
    let (mut count, mut duty) = (0, 0.0f32);
    for _ in 0..(2.5 * gains.settling()) as usize + 20 {
        let now = model.error().floor() as i32;
        step.see(now);
        let next = servo.next(now - count, Target::Position(target as i32));
        count = now;
        model.step((duty * 32_767.0) as i16, 0);
        duty = next;
    }
    step.response()
}

/// Inertia and friction of a motor by those of the fitted one.
const OTHERS: [(f32, f32); 5] = [(1.0, 1.0), (1.2, 1.0), (0.8, 1.0), (1.0, 1.5), (1.0, 0.5)];

#[test]
fn a_step_settles_in_its_time_and_hardly_overshoots_also_on_a_motor_that_is_another() {
    let mut all = 0;
    let mut late = Vec::new();
    for seed in 0..60 {
        let fitted = draw(seed);
        let gains = fitted.gains();
        let target = gains.largest_step(0.5).max(20.0).floor();
        for (inertia, friction) in OTHERS {
            let motor = Motor {
                mechanical: fitted.mechanical * inertia,
                coulomb: fitted.coulomb * friction,
                ..fitted
            };
            let answer = step_of(&motor, &gains, target);
            all += 1;
            let in_time = (answer.settling as f32) < 1.25 * gains.settling() + 20.0;
            if !(in_time && answer.overshoot < 0.1 && answer.left.abs() <= (0.02 * target).max(2.0))
            {
                late.push(format!(
                    "seed {seed}, {inertia} of the inertia, {friction} of the friction: {answer:?} of {target}, {} periods, {fitted:?}",
                    gains.settling()
                ));
            }
        }
    }
    println!(
        "{} of {all} are late, overshoot or miss: {late:#?}",
        late.len()
    );
    assert!(late.len() * 50 <= all, "{} of {all}", late.len());
}

#[test]
fn a_count_moves_the_duty_by_no_more_than_a_tenth_and_a_bad_motor_makes_no_nan() {
    for seed in 0..60 {
        let gains = draw(seed).gains();
        let mut servo = Servo::IDLE;
        servo.begin(gains, 1.0);
        servo.next(0, Target::Position(0));
        // A count beyond the half of one that says nothing.
        let target = Target::Position(2);
        let moved = servo.next(2, target) - servo.next(0, target);
        assert!(moved.abs() < 0.3, "seed {seed}: {moved}, {gains:?}");
        let (far, fast) = (Target::Position, Target::Speed);
        for target in [
            far(i32::MAX),
            far(i32::MIN),
            fast(f32::MAX),
            fast(-f32::MAX),
        ] {
            let duty = servo.next(i32::MAX, target);
            assert!(duty.abs() <= 1.0, "seed {seed}: {duty}");
        }
    }
}
