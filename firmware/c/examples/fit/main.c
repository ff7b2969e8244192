/* A motor is fitted from a recording, judged by another one, and turned by a servo. Here it is simulated (motor.c); on a board, `motor_period`
 * is a control period: apply the duty, wait, read the encoder. */
#include "motor.h"
#include "servoid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  FITTED = 1000,
  PREDICTED = 1000,
  /* Periods in 50 ms. */
  WINDOW = 50,
  /* What a slice of a fit may cost: models along so many periods. */
  SLICE = 600,
};

static const float SUPPLY_V = 12.0f;
static const float PERIOD_S = 1e-3f;
static const float COUNTS_PER_REV = 2000.0f;
static const float PI = 3.14159265f;

/* All of it is the caller's. */
static ServoidFit fit;
static ServoidServo servo;
static int16_t duties[FITTED];
static int16_t steps[FITTED];

/* The library has found an error of its own: open the bridge here, and do not return. */
_Noreturn void servoid_panicked(void) { abort(); }

/* A drive of steps of random height and length. */
static int16_t drive(uint32_t *seed, unsigned period) {
  static int16_t held;
  static unsigned left;
  if (period == 0 || left == 0) {
    *seed = *seed * 1664525u + 1013904223u;
    held = (int16_t)((int32_t)(*seed >> 16) - 32768) / 2;
    left = 5 + (*seed >> 10) % 60;
  }
  left -= 1;
  return held;
}

static void bits(const char *name, float value) {
  uint32_t as_bits;
  memcpy(&as_bits, &value, sizeof as_bits);
  printf("%-14s %12.6g  %08lx\n", name, (double)value, (unsigned long)as_bits);
}

static int failed(const char *what, ServoidStatus status) {
  printf("%s: status %d\n", what, (int)status);
  return 1;
}

int main(void) {
  uint32_t seed = 1;
  motor_reset();
  for (unsigned k = 0; k < FITTED; k += 1) {
    duties[k] = drive(&seed, k);
    steps[k] = (int16_t)motor_period(duties[k]);
  }
  const ServoidRecording recording = {duties, steps, FITTED};
  const ServoidSettings settings = servoid_usual_settings();

  ServoidStatus status = servoid_fit_begin(&fit, &recording, &settings);
  if (status != SERVOID_STATUS_DONE) return failed("servoid_fit_begin", status);
  /* In the main loop of a firmware: a slice a turn. */
  do {
    status = servoid_fit_work(&fit, &recording, SLICE);
  } while (status == SERVOID_STATUS_RUNNING);
  ServoidOutcome found;
  if (status != SERVOID_STATUS_DONE) return failed("servoid_fit_work", status);
  servoid_fit_outcome(&fit, &found);
  bits("gain", found.gain.value);
  bits("  +-", found.gain.deviation);
  bits("a1", found.first_order.value);
  bits("electrical", found.electrical.value);
  bits("coulomb", found.coulomb.value);
  bits("mean square", found.mean_square);
  printf("%.4f rad/s/V, %.3f ms, %.3f V of friction\n",
         (double)(found.gain.value * 2.0f * PI / (COUNTS_PER_REV * PERIOD_S * SUPPLY_V)),
         (double)(found.first_order.value * PERIOD_S * 1e3f), (double)(found.coulomb.value * SUPPLY_V));

  /* Another run from standstill, predicted while it is driven. */
  motor_reset();
  status = servoid_predict_begin(&fit, FITTED, PREDICTED, WINDOW);
  if (status != SERVOID_STATUS_DONE) return failed("servoid_predict_begin", status);
  for (unsigned k = 0; k < PREDICTED; k += 1) {
    const int16_t duty = drive(&seed, k);
    servoid_predict_observe(&fit, duty, (int16_t)motor_period(duty));
    servoid_predict_catch_up(&fit, SLICE);
  }
  while (servoid_predict_catch_up(&fit, SLICE) == SERVOID_STATUS_RUNNING) {
  }
  ServoidVerdict verdict;
  status = servoid_verdict(&fit, 0.5f, &verdict);
  if (status != SERVOID_STATUS_DONE) return failed("servoid_verdict", status);
  bits("predicted", verdict.mean_square);
  bits("acceleration", verdict.acceleration);
  printf("grade %d, reason %d\n", (int)verdict.grade, (int)verdict.reason);
  if (verdict.grade == SERVOID_GRADE_NO) return failed("the motor is good for nothing", status);

  /* A step of a revolution, answered by a servo. */
  motor_reset();
  status = servoid_servo_begin(&servo, &fit, verdict.acceleration, 0.9f);
  if (status != SERVOID_STATUS_DONE) return failed("servoid_servo_begin", status);
  const float settling = servoid_servo_settling(&servo);
  int32_t count = 0;
  int32_t step = 0;
  float acts = 0.0f;
  for (unsigned k = 0; k < 500; k += 1) {
    const float next = servoid_servo_next(&servo, step, (int32_t)COUNTS_PER_REV);
    step = motor_period((int16_t)(acts * 32767.0f));
    count += step;
    acts = next;
  }
  bits("settling", settling);
  printf("%ld counts after 0.5 s, of %.0f\n", (long)count, (double)COUNTS_PER_REV);
  return fabsf((float)count - COUNTS_PER_REV) > 3.0f;
}
