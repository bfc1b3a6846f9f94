// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace phalanx::testing {

using Bytes = std::vector<std::uint8_t>;

/// Stands between host and controller, passes everything on, and can speak to each with the other's voice.
class UdpMiddle {
 public:
  /// @param controller_port  on 127.0.0.1
  explicit UdpMiddle(std::uint16_t controller_port);
  ~UdpMiddle();
  UdpMiddle(const UdpMiddle&) = delete;
  UdpMiddle& operator=(const UdpMiddle&) = delete;

  /// Where the host finds the controller.
  [[nodiscard]] std::uint16_t port() const { return port_; }
  void to_controller(std::span<const std::uint8_t> bytes) const;
  void to_host(std::span<const std::uint8_t> bytes) const;
  /// The newest COMMAND of the host and the newest SAMPLE of the controller that went by; empty: none yet.
  [[nodiscard]] Bytes last_command() const;
  [[nodiscard]] Bytes last_sample() const;
  /// Of the thread that passes on, as of gettid().
  [[nodiscard]] std::int32_t thread_id() const;

 private:
  void work();
  void pass_on(int from, bool from_host);

  int host_side_ = -1;
  int controller_side_ = -1;
  std::uint16_t port_ = 0;
  sockaddr_in controller_{};
  mutable std::mutex mutex_;  ///< of what follows
  sockaddr_in host_{};
  Bytes command_;
  Bytes sample_;
  std::atomic<bool> ending_{false};
  std::atomic<std::int32_t> thread_id_{0};
  std::thread thread_;
};

/// Sends datagrams to 127.0.0.1:`port` from a socket that nobody knows.
void send_from_a_stranger(std::uint16_t port, const std::vector<Bytes>& datagrams);

}  // namespace phalanx::testing
