// SPDX-License-Identifier: Apache-2.0
// Markers of other programs by UDP: a computer that gives stimuli, or an electromyograph, sends a text, and the recording
// has it with its time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <thread>

namespace phalanx {

/// A UDP socket with a thread of its own. Each datagram is one marker: its text, up to kLongest bytes.
class MarkerPort {
 public:
  static constexpr std::size_t kLongest = 1000;  ///< of a marker [bytes]

  /// @param address    of this machine, IPv4; 127.0.0.1: programs of this machine alone can reach it
  /// @param on_marker  gets the sender, "127.0.0.1:5000", and the text; on the port's thread
  /// @throws std::runtime_error naming the port and the remedy if it cannot be opened
  MarkerPort(const std::string& address, std::uint16_t port,
             std::function<void(const std::string& from, const std::string& text)> on_marker);
  MarkerPort(const MarkerPort&) = delete;
  MarkerPort& operator=(const MarkerPort&) = delete;
  ~MarkerPort();

 private:
  void serve(const std::stop_token& stop);

  int socket_ = -1;
  std::function<void(const std::string&, const std::string&)> on_marker_;
  std::jthread thread_;
};

}  // namespace phalanx
