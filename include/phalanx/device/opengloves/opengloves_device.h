// SPDX-License-Identifier: Apache-2.0
// LucidGloves and other gloves with OpenGloves firmware on a serial port, as a Device.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

struct OpenGlovesSettings {
  /// What the glove sends for a closed finger: 4095, 1023, or 0: found out while learning. Then it is 4095 if
  /// any number of these lines is above 1023 (a joystick at rest sends half of the full scale, so that most
  /// gloves show it with an open hand), else 1023. If it was wrong, a number above 1023 comes later, which is
  /// outside the channel's range: a sensor fault, never a hand that closes four times too far.
  int full_scale = 0;
  double hello_timeout = 3.0;  ///< open() gives up if no line came for so long [s]
  double learn_for = 1.0;      ///< what the glove sends is learnt from the lines of so long [s]
  std::string serial;  ///< the glove's serial number; empty: its USB adapter's, or the port if that has none
};

/// A thread of its own reads the glove's lines, answers each of them with five stops (with force feedback the
/// firmware waits for that), and sends a bare newline where nothing came for 100 ms.
///
/// Channels, fixed by what the glove sent while it was learnt: per digit its three joints if it sends all of
/// them, else its curl; its splay where it is sent. A later line that lacks a number which all of those lines
/// had is a part of one and dropped; a number that only some lines have keeps its value. Nominal gains, full
/// scale s: curl raw / s, splay 2 raw / s - 1, a joint from the hand's smallest to its largest angle (0 .. 90
/// deg without a hand).
///
/// The glove has neither clock nor state: time_us of a sample is the host's clock when its line was complete,
/// `kActive` means that the last command was enabled, `acted_tick` is the tick of the stops that were sent
/// last.
///
/// A stop is a place that a finger cannot close beyond: the glove holds a string that runs out as the finger
/// closes. It can hold a finger or pull it open, and never closes one. 1000 holds the fully open finger, 0
/// lets go. Stops are let go if no command came for 20 ms, if the command is not enabled, and at close().
class OpenGlovesDevice : public Device {
 public:
  /// The wearer's hand: stops and nominal joint gains need its range of motion. Before open(). Without it no
  /// finger is ever stopped.
  virtual void set_hand(const HandParameters& hand) = 0;
  /// Channels with calibrated gains and offsets, in the order of info().channels: a stop stands where the
  /// glove itself reads the curl that is shown. Between open() and the first send().
  /// @throws std::invalid_argument if they are not the glove's channels, or a gain is 0 or not finite.
  virtual void set_calibration(std::vector<DeviceChannel> channels) = 0;
};

/// @param port   "/dev/ttyUSB0"
/// @param baud   115200 for most gloves
/// @param clock  of the process; must outlive the device
/// open() throws DeviceError: no such port, no permission, in use, no line within the time.
[[nodiscard]] std::unique_ptr<OpenGlovesDevice> make_opengloves_device(
    const std::string& port, unsigned baud, const Clock& clock, const OpenGlovesSettings& settings = {});

/// The same on a file descriptor that is open for reading and writing (a pseudo-terminal, a socket); it is
/// made non-blocking, and closed by the device. Once lost it stays lost.
[[nodiscard]] std::unique_ptr<OpenGlovesDevice> make_opengloves_device(
    int file_descriptor, const Clock& clock, const OpenGlovesSettings& settings = {});

}  // namespace phalanx
