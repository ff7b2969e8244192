// A motor commissions itself at power-up, then follows the set-points that come over the serial port: "1200" and a line end turn it to count
// 1200. The bridge has two inputs (IN1, IN2) and a pin that enables it; a resistor pulls that low. Mind: nothing here limits travel or
// current, as the firmware in Rust does. Begin with a free shaft and a supply that limits its current.
#include <Arduino.h>

#include "servoid.h"

namespace {

constexpr int IN1 = PA8;
constexpr int IN2 = PA9;
constexpr int ENABLE = PA10;
constexpr int A = PC6;
constexpr int B = PC7;

constexpr uint32_t PERIOD_US = 1000;
constexpr uint32_t CARRIER_HZ = 20000;
constexpr unsigned FITTED = 1000;
constexpr unsigned PREDICTED = 1000;
constexpr unsigned REST = 500;
// Models along so many periods take less than half of a control period on this core.
constexpr uint32_t SLICE = 600;
constexpr float LIMIT = 0.9f;

enum class Phase { Record, Fit, Rest, Verify, Follow, Failed };

// All that the library needs is here.
ServoidFit fit;
ServoidServo servo;
int16_t duties[FITTED];
int16_t steps[FITTED];
const ServoidRecording recording = {duties, steps, FITTED};

volatile int32_t count;
int32_t last;
Phase phase = Phase::Record;
unsigned period;
float acts;
int32_t target;
uint32_t seed = 1;

void edge() { count = count + ((digitalRead(A) == digitalRead(B)) ? 1 : -1); }

// A part of the supply; the other input stays low.
void drive(float part) {
  const uint32_t level = static_cast<uint32_t>(fabsf(part) * 4095.0f);
  analogWrite(IN1, part > 0.0f ? level : 0);
  analogWrite(IN2, part < 0.0f ? level : 0);
}

// Steps of random height and length.
int16_t excitation(unsigned at) {
  static int16_t held;
  static unsigned left;
  if (at == 0 || left == 0) {
    seed = seed * 1664525u + 1013904223u;
    held = static_cast<int16_t>((static_cast<int32_t>(seed >> 16) - 32768) / 2);
    left = 5 + (seed >> 10) % 60;
  }
  left -= 1;
  return held;
}

void fail(const char *what) {
  digitalWrite(ENABLE, LOW);
  phase = Phase::Failed;
  Serial.println(what);
}

void enter(Phase next) {
  phase = next;
  period = 0;
}

// One control period: the duty of the last one has acted.
void control() {
  const int32_t now = count;
  const int32_t step = now - last;
  last = now;
  switch (phase) {
    case Phase::Record: {
      if (period > 0) steps[period - 1] = static_cast<int16_t>(step);
      if (period == FITTED) {
        drive(0.0f);
        auto settings = servoid_usual_settings();
        settings.carriers = CARRIER_HZ / (1000000 / PERIOD_US);
        if (servoid_fit_begin(&fit, &recording, &settings) != SERVOID_STATUS_DONE) return fail("the shaft did not move with the drive");
        return enter(Phase::Fit);
      }
      duties[period] = excitation(period);
      drive(duties[period] / 32768.0f);
      break;
    }
    case Phase::Rest:
      // A recording begins at rest.
      if (period == REST) return enter(Phase::Verify);
      break;
    case Phase::Verify: {
      static int16_t duty;
      if (period > 0) servoid_predict_observe(&fit, duty, static_cast<int16_t>(step));
      servoid_predict_catch_up(&fit, SLICE);
      if (period == PREDICTED) {
        drive(0.0f);
        while (servoid_predict_catch_up(&fit, SLICE) == SERVOID_STATUS_RUNNING) {
        }
        ServoidVerdict verdict;
        if (servoid_verdict(&fit, 0.5f, &verdict) != SERVOID_STATUS_DONE || verdict.grade == SERVOID_GRADE_NO) {
          return fail("what was fitted is good for nothing");
        }
        servoid_servo_begin(&servo, &fit, verdict.acceleration, LIMIT);
        Serial.println(verdict.grade == SERVOID_GRADE_FLOOR ? "floor" : "control");
        return enter(Phase::Follow);
      }
      duty = excitation(period);
      drive(duty / 32768.0f);
      break;
    }
    case Phase::Follow: {
      // What was computed in the last period acts now.
      drive(acts);
      acts = servoid_servo_next(&servo, step, target);
      break;
    }
    case Phase::Fit:
    case Phase::Failed:
      return;
  }
  period += 1;
}

}  // namespace

extern "C" void servoid_panicked(void) {
  digitalWrite(ENABLE, LOW);
  for (;;) {
  }
}

void setup() {
  Serial.begin(115200);
  analogWriteResolution(12);
  analogWriteFrequency(CARRIER_HZ);
  pinMode(A, INPUT_PULLUP);
  pinMode(B, INPUT_PULLUP);
  attachInterrupt(digitalPinToInterrupt(A), edge, CHANGE);
  pinMode(ENABLE, OUTPUT);
  drive(0.0f);
  digitalWrite(ENABLE, HIGH);
}

void loop() {
  static uint32_t begun = micros();
  if (micros() - begun >= PERIOD_US) {
    begun += PERIOD_US;
    control();
  }
  if (phase == Phase::Fit) {
    const ServoidStatus status = servoid_fit_work(&fit, &recording, SLICE);
    if (status == SERVOID_STATUS_RUNNING) return;
    if (status != SERVOID_STATUS_DONE) return fail("no motor was found");
    ServoidOutcome found;
    servoid_fit_outcome(&fit, &found);
    Serial.println(found.gain.value);
    servoid_predict_begin(&fit, FITTED, PREDICTED, 50000 / PERIOD_US);
    enter(Phase::Rest);
  }
  if (phase == Phase::Follow && Serial.available() > 0) target = Serial.parseInt();
}
