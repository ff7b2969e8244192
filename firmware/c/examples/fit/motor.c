/* L di/dt = u - R i - k w,  J dw/dt = k i - F sgn(w), in steps of 10 us, and an encoder that floors. */
#include "motor.h"

#include <math.h>

static const double RESISTANCE_OHM = 1.2;
static const double INDUCTANCE_H = 6e-4;
static const double CONSTANT_N_M_A = 0.017;
static const double INERTIA_KG_M2 = 6e-6;
static const double FRICTION_N_M = 1e-3;
static const double SUPPLY_V = 12.0;
static const double COUNTS_PER_REV = 2000.0;
static const double STEP_S = 1e-5;
static const int STEPS = 100;

static double current_a;
static double speed_rad_s;
static double angle_rad;
static int32_t count;

void motor_reset(void) {
  current_a = 0.0;
  speed_rad_s = 0.0;
}

int32_t motor_period(int16_t duty) {
  const double volts = duty / 32768.0 * SUPPLY_V;
  for (int k = 0; k < STEPS; k += 1) {
    current_a += STEP_S / INDUCTANCE_H * (volts - RESISTANCE_OHM * current_a - CONSTANT_N_M_A * speed_rad_s);
    const double free = speed_rad_s + STEP_S / INERTIA_KG_M2 * CONSTANT_N_M_A * current_a;
    const double friction = STEP_S / INERTIA_KG_M2 * FRICTION_N_M;
    /* Friction stops the shaft, and never turns it back. */
    speed_rad_s = fabs(free) <= friction ? 0.0 : free - copysign(friction, free);
    angle_rad += STEP_S * speed_rad_s;
  }
  const int32_t now = (int32_t)floor(angle_rad / 6.283185307179586 * COUNTS_PER_REV);
  const int32_t step = now - count;
  count = now;
  return step;
}
