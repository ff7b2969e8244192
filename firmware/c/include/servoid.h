/* Identifies a DC motor from its own duties and counts, judges the result, and makes a servo of it: in your memory, without
 * an allocator. Generated from firmware/c/src by cbindgen: do not edit. firmware/c/README.md tells how to build and use it. */

#ifndef SERVOID_H
#define SERVOID_H

#include <stdint.h>

/**
 * The duty that stands for an open bridge.
 */
#define SERVOID_OPEN -32768

/**
 * How a call ended.
 */
typedef enum ServoidStatus {
  /**
   * It has done what it does.
   */
  SERVOID_STATUS_DONE = 0,
  /**
   * There is more to do: call it again.
   */
  SERVOID_STATUS_RUNNING = 1,
  /**
   * An address is null.
   */
  SERVOID_STATUS_NULL = 2,
  /**
   * What must be called before was not.
   */
  SERVOID_STATUS_TOO_EARLY = 3,
  /**
   * The shaft did not move with the drive: there is nothing to fit.
   */
  SERVOID_STATUS_NOTHING_TO_FIT = 4,
  /**
   * No motor of the recording could be built: it is beyond the number format.
   */
  SERVOID_STATUS_NO_MODEL = 5,
  /**
   * A number is not finite, or beyond its range.
   */
  SERVOID_STATUS_OUT_OF_RANGE = 6,
} ServoidStatus;

/**
 * What a motor is good for, best last.
 */
typedef enum ServoidGrade {
  /**
   * For nothing that its numbers are needed for.
   */
  SERVOID_GRADE_NO = 0,
  /**
   * For gains.
   */
  SERVOID_GRADE_CONTROL = 1,
  /**
   * For all: what it leaves is the encoder's.
   */
  SERVOID_GRADE_FLOOR = 2,
} ServoidGrade;

/**
 * Why a grade is no better.
 */
typedef enum ServoidReason {
  /**
   * There is no better.
   */
  SERVOID_REASON_NONE = 0,
  /**
   * What is left is more than the encoder's.
   */
  SERVOID_REASON_LEFT = 1,
  /**
   * The recording does not determine gain or time constant well enough.
   */
  SERVOID_REASON_UNDETERMINED = 2,
  /**
   * What was predicted has another gain or time constant.
   */
  SERVOID_REASON_DISAGREES = 3,
  /**
   * It predicts hardly better than one who takes it that the speed stays.
   */
  SERVOID_REASON_PREDICTS = 4,
} ServoidReason;

/**
 * What to search for, and how. `servoid_usual_settings` has what suits most motors.
 */
typedef struct ServoidSettings {
  /**
   * Seed of the search.
   */
  uint64_t seed;
  /**
   * Models of a search; there may be three, and a polish comes on top of each.
   */
  uint16_t evaluations;
  /**
   * Waves of the bridge's carrier in a control period, to fit what its dead time takes; 0 takes a bridge that loses nothing.
   */
  uint16_t carriers;
  /**
   * What the dead time takes by the board's own figure, as a duty: twice the dead time by the carrier's period, times 32,768.
   */
  uint16_t dead_time;
  /**
   * Duty that is the whole supply; 0 for 32,768.
   */
  uint16_t full;
  /**
   * Particles or fireflies, at most 20.
   */
  uint8_t population;
  /**
   * Not 0: particle swarm; 0: fireflies.
   */
  uint8_t swarm;
  /**
   * Not 0: fit Coulomb friction.
   */
  uint8_t coulomb;
  /**
   * Not 0: fit a constant load.
   */
  uint8_t load;
  /**
   * Not 0: fit the resistance of a supply that is not measured.
   */
  uint8_t supply;
} ServoidSettings;

/**
 * Memory for a fit, its prediction and its verdict; at most one of each at a time. A static of it needs no image. What is in it is not for
 * the caller.
 */
typedef struct ServoidFit {
  uint64_t memory[1000];
} ServoidFit;

/**
 * A run from standstill: `duties[k]` is held from one reading of the encoder to the next, which is `steps[k]` counts further.
 */
typedef struct ServoidRecording {
  /**
   * Duties: 32,768 is the whole supply, `SERVOID_OPEN` an open bridge.
   */
  const int16_t *duties;
  /**
   * Counts travelled in each period.
   */
  const int16_t *steps;
  /**
   * Periods, of which both arrays have as many.
   */
  uint32_t periods;
} ServoidRecording;

/**
 * A value with its standard deviation, which is infinite where nothing determines it; both are 0 where it was not fitted.
 */
typedef struct ServoidEstimate {
  /**
   * The value.
   */
  float value;
  /**
   * Its standard deviation.
   */
  float deviation;
} ServoidEstimate;

/**
 * What a fit found. With `P` seconds a period, `N` counts a revolution and `V` volts of supply, a gain in rad/s/V is `value*2*pi/(N*P*V)`,
 * a time in seconds `value*P`, a voltage `value*V`.
 */
typedef struct ServoidOutcome {
  /**
   * Steady speed under the whole supply, counts a period.
   */
  struct ServoidEstimate gain;
  /**
   * Coefficient a1 of the response to voltage, nearly the mechanical time constant, periods.
   */
  struct ServoidEstimate first_order;
  /**
   * Electrical time constant, periods.
   */
  struct ServoidEstimate electrical;
  /**
   * Coulomb friction, a part of the supply.
   */
  struct ServoidEstimate coulomb;
  /**
   * Constant load against positive rotation, a part of the supply.
   */
  struct ServoidEstimate load;
  /**
   * What the bridge's dead time takes, a part of the supply.
   */
  struct ServoidEstimate dead_time;
  /**
   * Part of the damping that is viscous friction.
   */
  struct ServoidEstimate viscous;
  /**
   * Resistance of the supply, a part of the winding's.
   */
  struct ServoidEstimate supply;
  /**
   * Mean squared error, counts squared; an encoder that floors leaves 1/12.
   */
  float mean_square;
  /**
   * Models that were run.
   */
  uint32_t evaluations;
} ServoidOutcome;

/**
 * A verdict.
 */
typedef struct ServoidVerdict {
  /**
   * What the motor is good for.
   */
  enum ServoidGrade grade;
  /**
   * Why it is for no more.
   */
  enum ServoidReason reason;
  /**
   * Part by which the gain may be off, with a probability of 95 %.
   */
  float gain;
  /**
   * The same of the time constant.
   */
  float time_constant;
  /**
   * The same of gain over time constant, from which a servo is made.
   */
  float acceleration;
  /**
   * Mean squared error of the prediction, counts squared.
   */
  float mean_square;
} ServoidVerdict;

/**
 * Memory for a servo. What is in it is not for the caller, but for the gains.
 */
typedef struct ServoidServo {
  /**
   * Speed asked for by a count off, a period.
   */
  float position;
  /**
   * Part of the supply asked for by a count a period too slow.
   */
  float speed;
  /**
   * Part of the supply that a speed of a count a period takes.
   */
  float back_emf;
  /**
   * Part of the supply that friction takes.
   */
  float friction;
  uint64_t memory[16];
} ServoidServo;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Settings that suit most motors: fireflies, 4,000 models, Coulomb friction, seed 1.
 */
struct ServoidSettings servoid_usual_settings(void);

/**
 * Begins a fit of a recording. The memory must be all zeros before its first fit, as a static is.
 *
 * # Safety
 * The addresses are null or of what they are declared as; the recording's arrays have as many elements as there are periods.
 */
enum ServoidStatus servoid_fit_begin(struct ServoidFit *fit,
                                     const struct ServoidRecording *recording,
                                     const struct ServoidSettings *settings);

/**
 * Runs models along at most about so many periods of the recording with which the fit has begun. `SERVOID_STATUS_RUNNING` until the fit is
 * over.
 *
 * # Safety
 * As of `servoid_fit_begin`.
 */
enum ServoidStatus servoid_fit_work(struct ServoidFit *fit,
                                    const struct ServoidRecording *recording,
                                    uint32_t samples);

/**
 * What a fit found that is over.
 *
 * # Safety
 * The addresses are null or of what they are declared as.
 */
enum ServoidStatus servoid_fit_outcome(struct ServoidFit *fit, struct ServoidOutcome *outcome);

/**
 * Gets the fitted motor ready to predict about so many periods from standstill, none of the `fitted` ones, judged over windows of so many
 * periods: as many as 50 ms have.
 *
 * # Safety
 * The address is null or of what it is declared as.
 */
enum ServoidStatus servoid_predict_begin(struct ServoidFit *fit,
                                         uint32_t fitted,
                                         uint32_t periods,
                                         uint32_t window);

/**
 * One period of what the motor predicts: the duty acted, and the reading is so many counts further. It takes no time: `servoid_predict_catch_up`
 * does the work.
 *
 * # Safety
 * The address is null or of what it is declared as.
 */
enum ServoidStatus servoid_predict_observe(struct ServoidFit *fit,
                                           int16_t duty,
                                           int16_t step);

/**
 * Runs models along at most about so many of the periods that were observed; call it in every period, and after the last one until it is
 * done. At most 256 periods may wait: what comes later is not predicted.
 *
 * # Safety
 * The address is null or of what it is declared as.
 */
enum ServoidStatus servoid_predict_catch_up(struct ServoidFit *fit,
                                            uint32_t samples);

/**
 * What the motor is good for, by what it predicted; errors within so many counts RMS are the encoder's (0.5 for one that floors).
 *
 * # Safety
 * The addresses are null or of what they are declared as.
 */
enum ServoidStatus servoid_verdict(struct ServoidFit *fit,
                                   float within,
                                   struct ServoidVerdict *verdict);

/**
 * Begins a servo of the fitted motor where its shaft rests, whose gain over time constant may be off by the part `off` (of its verdict), with
 * duties up to `limit`, a part of the supply from 0 to 1. The memory must be all zeros before its first use, as a static is.
 *
 * # Safety
 * The addresses are null or of what they are declared as.
 */
enum ServoidStatus servoid_servo_begin(struct ServoidServo *servo,
                                       struct ServoidFit *fit,
                                       float off,
                                       float limit);

/**
 * The count went on by `step` in the period that has ended, and the duty that was given last acts now. Gives the duty of the period after
 * this one, a part of the supply, on the way to `target`, counts from where the servo began; 0 before it has begun.
 *
 * # Safety
 * The address is null or of what it is declared as.
 */
float servoid_servo_next(struct ServoidServo *servo,
                         int32_t step,
                         int32_t target);

/**
 * The same on the way to a speed, counts a period; 0 before it has begun, or if the speed is not finite.
 *
 * # Safety
 * The address is null or of what it is declared as.
 */
float servoid_servo_turn(struct ServoidServo *servo, int32_t step, float speed);

/**
 * The next duty will be another than was given, as behind a limit of the current.
 *
 * # Safety
 * The address is null or of what it is declared as.
 */
void servoid_servo_acts(struct ServoidServo *servo, float duty);

/**
 * Periods in which a step is over; 0 before the servo has begun.
 *
 * # Safety
 * The address is null or of what it is declared as.
 */
float servoid_servo_settling(struct ServoidServo *servo);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SERVOID_H */
