// The motor on the bench, SI: armature, rotor, dry friction. It shares nothing with the firmware's model of it.

// Ten watts at 12 V.
export const TEN_WATTS = {
  supply: 12,
  resistance: 2.4,
  inductance: 0.6e-3,
  constant: 0.017,
  inertia: 3.2e-6,
  viscous: 1e-6,
  coulomb: 6e-4,
};

// The longest step of the integration, s.
const LONGEST_STEP = 5e-6;

export class Motor {
  constructor(of) {
    Object.assign(this, of);
    this.current = 0;
    this.speed = 0;
    this.angle = 0;
  }

  // Steady speed per volt, rad/s/V, and the first-order time constant, s.
  truth() {
    const total = this.constant ** 2 + this.resistance * this.viscous;
    return [
      this.constant / total,
      (this.resistance * this.inertia + this.inductance * this.viscous) / total,
    ];
  }

  // Lets seconds pass with a part of the supply across the winding, or null for an open bridge.
  advance(duty, seconds) {
    const steps = Math.max(1, Math.ceil(seconds / LONGEST_STEP));
    for (let k = 0; k < steps; k += 1) this.step(duty, seconds / steps);
  }

  step(duty, h) {
    const before = { current: this.current, speed: this.speed };
    if (duty === null) {
      this.current = 0;
    } else {
      // Exact for a speed that stands still during the step.
      const end = (duty * this.supply - this.constant * this.speed) / this.resistance;
      this.current = end + (this.current - end) * Math.exp((-this.resistance / this.inductance) * h);
    }
    this.speed = this.turned((this.constant * (before.current + this.current)) / 2, h);
    this.angle += ((before.speed + this.speed) / 2) * h;
  }

  // The speed after a step under a torque. Friction may stop the rotor within it; it then holds, or the rotor turns back in what
  // is left.
  turned(torque, h) {
    const acceleration = (speed, sense) =>
      (torque - Math.sign(sense) * this.coulomb - this.viscous * speed) / this.inertia;
    let left = h;
    if (this.speed !== 0) {
      const braking = acceleration(this.speed, this.speed);
      const after = this.speed + braking * h;
      if (after * this.speed > 0) return after;
      left += this.speed / braking;
    }
    return Math.abs(torque) <= this.coulomb ? 0 : acceleration(0, torque) * left;
  }
}
