// As much of Arduino's header as the example needs, so that it can be compiled where there is no Arduino.
#pragma once

#include <math.h>
#include <stdint.h>

enum { LOW, HIGH, INPUT_PULLUP, OUTPUT, CHANGE, PA8, PA9, PA10, PC6, PC7 };

void pinMode(int pin, int mode);
void digitalWrite(int pin, int level);
int digitalRead(int pin);
void analogWrite(int pin, uint32_t level);
void analogWriteResolution(int bits);
void analogWriteFrequency(uint32_t hertz);
int digitalPinToInterrupt(int pin);
void attachInterrupt(int number, void (*handler)(), int mode);
uint32_t micros();

struct SerialPort {
  void begin(unsigned long baud);
  int available();
  long parseInt();
  void println(const char *text);
  void println(float number);
};
extern SerialPort Serial;
