// SPDX-License-Identifier: Apache-2.0
// LucidGloves and other gloves with OpenGloves firmware on a serial port, as a Device.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Settings of an OpenGloves device.
struct OpenGlovesSettings {
  /// Number that the glove sends for a closed finger: 4095, 1023, or 0 (learn it). It is learnt as 4095 if
  /// any number of the first lines is above 1023, else as 1023. Most gloves show 4095 with an open hand
  /// already, since a joystick at rest sends half of the full scale. If 1023 was wrong, a later number above
  /// 1023 is outside the channel's range. That is a sensor fault, and never a hand that closes four
  /// times too far.
  int full_scale = 0;
  double hello_timeout = 3.0;  ///< open() gives up if no line came for this time [s]
  double learn_for = 1.0;      ///< duration of learning from the glove's lines [s]
  std::string serial;          ///< serial number; empty: the USB adapter's, or the port if it has none
};

/// Glove on a serial port. A thread of its own reads the glove's lines and answers each with five stops (with
/// force feedback, the firmware waits for that). If nothing came for 100 ms, it sends a bare newline.
///
/// Learning fixes the channels. A digit has three joint channels if the glove sends all three joints, else a
/// curl; it has a splay if that is sent. A later line that lacks a number which all learnt lines had is a
/// partial line, and is dropped. A number that only some lines have keeps its value. With the full scale s,
/// the nominal values are: curl raw / s; splay 2 raw / s - 1; a joint from the hand's smallest to its largest
/// angle (0 .. 90 deg without a hand).
///
/// The glove has neither clock nor state. time_us of a sample is the host's clock when its line was complete.
/// `kActive` means that the last command was enabled. `acted_tick` is the tick of the stops that
/// were sent last.
///
/// A stop is a position beyond which a finger cannot close: the glove holds a string that runs out as the
/// finger closes. It can hold a finger or pull it open, and never closes one. 1000 holds the fully open
/// finger; 0 releases it.
/// Stops are released if no command came for 20 ms, if the command is not enabled, and at close(). If this
/// process is frozen or killed, the glove holds its last stops, unless its firmware has a watchdog.
class OpenGlovesDevice : public Device {
 public:
  /// Sets the wearer's hand: stops and nominal joint gains need its range of motion. Call it before open().
  /// Without it, no finger is ever stopped.
  virtual void set_hand(const HandParameters& hand) = 0;
  /// Sets DeviceInfo::watchdog of the glove's firmware, which the protocol does not report. Call it before
  /// open(). Without it, the glove counts as having none.
  virtual void set_watchdog(std::optional<double> seconds) = 0;
  /// Sets DeviceInfo::actuated, which the protocol does not report. With false, no finger is ever stopped.
  /// Call it before open().
  virtual void set_force_feedback(bool has_it) = 0;
  /// Sets the channels with calibrated gains and offsets, in the order of info().channels. A stop is placed
  /// where the glove itself reads the displayed curl. Call it between open() and the first send().
  /// @throws std::invalid_argument if they are not the glove's channels, or a gain is 0 or not finite.
  virtual void set_calibration(std::vector<DeviceChannel> channels) = 0;
};

/// Makes a glove on a serial port. Its open() throws DeviceError: no such port, no permission, in use, no
/// line within the time.
/// @param port   "/dev/ttyUSB0"
/// @param baud   115200 for most gloves
/// @param clock  the process's clock; must outlive the device
[[nodiscard]] std::unique_ptr<OpenGlovesDevice> make_opengloves_device(
    const std::string& port, unsigned baud, const Clock& clock, const OpenGlovesSettings& settings = {});

/// Makes a glove on a file descriptor that is open for reading and writing (a pseudo-terminal, a socket). The
/// device makes it non-blocking, and closes it. Once lost it stays lost.
[[nodiscard]] std::unique_ptr<OpenGlovesDevice> make_opengloves_device(
    int file_descriptor, const Clock& clock, const OpenGlovesSettings& settings = {});

}  // namespace phalanx
