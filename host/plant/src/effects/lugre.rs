//! LuGre friction: bristles that bend before they slide.

use super::{At, Effect, Kind, Law, Machine, Param};

/// ż = ω − |ω|·z/zs(ω), T = −(σ0·z + σ1·ż), with the steady deflection σ0·zs(ω) = Tc·(1 + r·exp(−(ω/ωs)²))
/// (Canudas de Wit, Olsson, Åström and Lischinsky, "A new model for control of systems with friction", IEEE
/// TAC 40(3), 1995). The viscous term σ2 is the machine's. The memory is the deflection z in rad, 0 at the start.
struct Lugre {
    stiffness_n_m_rad: f64,
    damping_n_m_s: f64,
    damping_falls: bool,
    deflection_rad: f64,
    extra: f64,
    speed_rad_s: f64,
    inertia_kg_m2: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "lugre",
    about: "dry friction with an elastic deflection before it slides",
    electrical: None,
    params: &[
        Param {
            name: "coulomb",
            unit: "N*m",
            about: "sliding friction Tc",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.03 * machine.stall_torque_n_m(),
        },
        Param {
            name: "extra",
            unit: "1",
            about: "excess r of static over sliding friction, as a share of it",
            scales: false,
            range: (0.0, 10.0),
            typical: |_| 0.3,
        },
        Param {
            name: "speed",
            unit: "rad/s",
            about: "Stribeck speed ωs",
            scales: false,
            range: (f64::MIN_POSITIVE, f64::INFINITY),
            typical: |machine| 0.03 * machine.top_speed_rad_s(),
        },
        Param {
            name: "presliding",
            unit: "rad",
            about: "deflection at break-away",
            scales: false,
            range: (1e-5, 1.0),
            typical: |_| 0.008,
        },
        Param {
            name: "damping",
            unit: "1",
            about: "damping ratio of the shaft on its bent bristles",
            scales: false,
            range: (0.0, 2.0),
            typical: |_| 0.5,
        },
    ],
    other_laws: &[Law {
        name: "falling_damping",
        about: "the damping of the bristles falls as exp(-(w/ws)^2)",
        build: |values, machine| Box::new(Lugre::new(values, machine, true)),
        form: Some(1.0),
    }],
    build: |values, machine| Box::new(Lugre::new(values, machine, false)),
    draw: |_, machine, random| {
        vec![
            ("extra", random.uniform(0.0, 0.6)),
            (
                "speed",
                machine.top_speed_rad_s() * random.log_uniform(0.01, 0.06),
            ),
            ("presliding", random.log_uniform(0.002, 0.03)),
            ("damping", random.uniform(0.2, 1.0)),
        ]
    },
    truth: |values, machine, _| {
        let [torque, extra, speed, presliding, damping] = *values else {
            return Vec::new();
        };
        // The model has the time σ1/σ0 in the place of the damping ratio.
        let stiffness = torque * (1.0 + extra) / presliding;
        let damping = 2.0 * damping * (stiffness * machine.inertia_kg_m2).sqrt();
        vec![
            machine.winding_volts(torque),
            extra,
            speed,
            presliding,
            damping / stiffness,
            0.0,
        ]
    },
};

impl Lugre {
    /// From the values of its parameters.
    fn new(values: &[f64], machine: &Machine, damping_falls: bool) -> Lugre {
        let (coulomb, extra, presliding) = (values[0], values[1], values[3]);
        let stiffness_n_m_rad = coulomb * (1.0 + extra) / presliding;
        Lugre {
            stiffness_n_m_rad,
            damping_n_m_s: 2.0 * values[4] * (stiffness_n_m_rad * machine.inertia_kg_m2).sqrt(),
            damping_falls,
            deflection_rad: presliding / (1.0 + extra),
            extra,
            speed_rad_s: values[2],
            inertia_kg_m2: machine.inertia_kg_m2,
        }
    }

    /// σ1 at a speed: constant, or falling with it so that sliding stays dissipative (Olsson, "Control Systems with
    /// Friction", Lund 1996, eq. 3.12).
    fn damping(&self, speed: f64) -> f64 {
        if self.damping_falls {
            self.damping_n_m_s * (-(speed / self.speed_rad_s).powi(2)).exp()
        } else {
            self.damping_n_m_s
        }
    }

    /// Deflection zs at which the bristles slide steadily, rad.
    fn steady_deflection(&self, speed: f64) -> f64 {
        self.deflection_rad * (1.0 + self.extra * (-(speed / self.speed_rad_s).powi(2)).exp())
    }
}

impl Effect for Lugre {
    fn memories(&self) -> usize {
        usize::from(self.stiffness_n_m_rad > 0.0)
    }

    fn memory_rates(&self, at: &At) -> [f64; 2] {
        let [deflection, _] = at.memory;
        let returned = at.speed.abs() * deflection / self.steady_deflection(at.speed);
        [at.speed - returned, 0.0]
    }

    fn torque(&self, at: &At) -> f64 {
        let ([deflection, _], [rate, _]) = (at.memory, self.memory_rates(at));
        -self.stiffness_n_m_rad * deflection - self.damping(at.speed) * rate
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        if self.stiffness_n_m_rad == 0.0 {
            return 0.0;
        }
        // Fast sliding damps the bristles' own transient: there the substep need not resolve it, only
        // stay stable, for which two steps in three time constants are enough.
        let sliding = 0.5 * at.speed.abs() / self.steady_deflection(at.speed);
        let bending = (self.stiffness_n_m_rad / self.inertia_kg_m2).sqrt();
        sliding + bending + self.damping_n_m_s / self.inertia_kg_m2
    }
}
