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

/// What the controller gets to know with CONFIGURE: gain and offset of each channel come from `channels` once
/// set_calibration() was called, else they are the device's own.
struct LinkSettings {
  double torque_limit = 0.5;   ///< [Nm]
  double torque_rate = 10.0;   ///< [Nm/s]
  double hello_timeout = 3.0;  ///< open() gives up after so long [s]
  /// Called by the link's thread before anything else, to ask for its scheduling. Must not throw.
  std::function<void()> on_thread_start = {};
};

/// A thread of its own receives samples and repeats the newest command at 1 kHz with its tick (a controller
/// that misses one repetition gets the next; one that gets an old one knows it). A command is not repeated
/// 20 ms after send(), and none is sent while a connection fault is latched.
///
/// After reset() it asks for the session again if the controller has restarted, for as long as hello_timeout,
/// and sends RESET until a sample says that the latch is off, for 200 ms: a cause that goes away later (an
/// emergency stop that is let go) needs another reset(). kDeviceLost stays: close() and make another device.
///
/// open() keeps asking a busy controller for 1.25 s, since a host that was killed holds its session for 1 s.
class LinkDevice : public Device {
 public:
  /// Gains and offsets that the controller evaluates local walls with. Before open().
  virtual void set_calibration(std::vector<DeviceChannel> channels) = 0;
};

/// @param clock  of the process; must outlive the device
[[nodiscard]] std::unique_ptr<LinkDevice> make_link_device(std::unique_ptr<Transport> transport,
                                                           const Clock& clock,
                                                           const LinkSettings& settings = {});

}  // namespace phalanx
