//! The winding heats up.

use super::{At, Effect, Kind, Param, Winding};

/// One thermal node: τ·dΔT/dt = Rth·R·i² − ΔT; the resistance grows to R·(1 + α·ΔT) and both constants fall
/// to K·(1 − β·ΔT) (IEC 60034-1 for copper, α = 0.0039/K; magnets lose 0.1–0.2 %/K). The memory is ΔT in K,
/// 0 at the start.
struct Heating {
    thermal_resistance_k_w: f64,
    time_constant_s: f64,
    copper_per_k: f64,
    magnet_per_k: f64,
    cold_resistance_ohm: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "heating",
    about: "the winding heats up: more resistance, weaker magnets",
    electrical: None,
    params: &[
        Param {
            name: "thermal_resistance",
            unit: "K/W",
            about: "thermal resistance Rth from the winding to the surroundings",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 200.0 / (machine.supply_v * machine.stall_current_a()),
        },
        Param {
            name: "time_constant",
            unit: "s",
            about: "thermal time constant τ of the winding",
            scales: false,
            range: (0.01, 1e6),
            typical: |_| 20.0,
        },
        Param {
            name: "copper",
            unit: "1/K",
            about: "temperature coefficient α of the resistance",
            scales: false,
            range: (0.0, 0.01),
            typical: |_| 0.0039,
        },
        Param {
            name: "magnet",
            unit: "1/K",
            about: "temperature coefficient β of the constants",
            scales: false,
            range: (0.0, 0.01),
            typical: |_| 0.001,
        },
    ],
    other_laws: &[],
    build: |values, machine| {
        Box::new(Heating {
            thermal_resistance_k_w: values[0],
            time_constant_s: values[1],
            copper_per_k: values[2],
            magnet_per_k: values[3],
            cold_resistance_ohm: machine.resistance_ohm,
        })
    },
    draw: |_, _, random| {
        vec![
            ("time_constant", random.log_uniform(5.0, 60.0)),
            ("magnet", random.uniform(0.0, 0.002)),
        ]
    },
    truth: |values, machine, _| {
        // dΔT/dt = (Rth·R(1 + αΔT)·i² − ΔT)/τ with y = α·ΔT and c = R·i.
        vec![
            values[2] * values[0] / (machine.resistance_ohm * values[1]),
            values[1],
            values[3] / values[2],
        ]
    },
};

impl Effect for Heating {
    fn memories(&self) -> usize {
        1
    }

    fn memory_rates(&self, at: &At) -> [f64; 2] {
        let [warmer, _] = at.memory;
        let resistance = self.cold_resistance_ohm * (1.0 + self.copper_per_k * warmer);
        let loss = resistance * at.current * at.current;
        let rate = (self.thermal_resistance_k_w * loss - warmer) / self.time_constant_s;
        [rate, 0.0]
    }

    fn winding(&self, winding: &mut Winding, at: &At) {
        let [warmer, _] = at.memory;
        winding.resistance_ohm *= 1.0 + self.copper_per_k * warmer;
        let field = (1.0 - self.magnet_per_k * warmer).max(0.0);
        winding.kt_n_m_a *= field;
        winding.kb_v_s_rad *= field;
    }
}
