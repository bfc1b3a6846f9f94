// SPDX-License-Identifier: Apache-2.0
// The host's side of the link: an exoskeleton's controller on a wire, as a Device.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/device/link/transport.h"

namespace phalanx {

/// Settings of the link. CONFIGURE sends the limits to the controller, with gain and offset of each channel.
/// After set_calibration(), these are those of its `channels`, else the device's own.
struct LinkSettings {
  double torque_limit = 0.5;   ///< [Nm]
  double torque_rate = 10.0;   ///< [Nm/s]
  double hello_timeout = 3.0;  ///< open() gives up after this time [s]
  /// Callback of the link's thread before anything else, to request its scheduling. It must not throw.
  std::function<void()> on_thread_start = {};
};

/// Exoskeleton on a wire. A thread of its own receives samples, and repeats the newest command at 1 kHz with
/// its tick. A controller that misses one repetition gets the next; it recognises an old one by its tick. A
/// command is not repeated later than 20 ms after send(), and none is sent while a connection
/// fault is latched.
///
/// If the controller has restarted, reset() makes the thread ask for the session again, for hello_timeout.
/// The thread also sends RESET until a sample shows that the latch is off, at most for 200 ms. If the cause
/// goes away later (an emergency stop that is released), another reset() is needed. kDeviceLost stays:
/// close() and make another device.
///
/// open() asks a busy controller for 1.25 s, since a host that was killed holds its session for 1 s.
class LinkDevice : public Device {
 public:
  /// Sets the gains and offsets with which the controller evaluates local walls. Call it before open().
  virtual void set_calibration(std::vector<DeviceChannel> channels) = 0;
};

/// Makes the device; it is not open yet.
/// @param clock  the process's clock; must outlive the device
[[nodiscard]] std::unique_ptr<LinkDevice> make_link_device(std::unique_ptr<Transport> transport,
                                                           const Clock& clock,
                                                           const LinkSettings& settings = {});

}  // namespace phalanx
