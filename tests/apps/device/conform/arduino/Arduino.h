/* SPDX-License-Identifier: Apache-2.0
 *
 * Stand-in for an Arduino core's header, with what examples/arduino uses: for compilers of this computer and of
 * boards, and for a test in which time and port are in memory. */
#ifndef PHALANX_TEST_ARDUINO_H
#define PHALANX_TEST_ARDUINO_H

#include <stddef.h>
#include <stdint.h>

#define LOW 0
#define HIGH 1
#define INPUT 0
#define OUTPUT 1
#define INPUT_PULLUP 2
#define A0 14
#define A1 15
#define A2 16

unsigned long micros(void);
int analogRead(uint8_t pin);
void analogReadResolution(int bits);  // cores for an 8-bit AVR have none
void analogWrite(uint8_t pin, int value);
int digitalRead(uint8_t pin);
void digitalWrite(uint8_t pin, uint8_t value);
void pinMode(uint8_t pin, uint8_t mode);

/// The core's serial port.
struct ArduinoSerial {
  void begin(unsigned long baud);
  int available();
  int read();
  int availableForWrite();
  size_t write(const uint8_t* bytes, size_t size);
};
extern ArduinoSerial Serial;

#endif
