// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "serve/web/raw_client.h"

namespace phalanx {

/// Client of a WebSocket that sends and receives single frames. It answers nothing by itself.
class PageClient {
 public:
  enum Opcode : int { kMore = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10, kGone = -1 };
  struct Frame {
    int opcode = kGone;  ///< kGone: the connection is closed
    std::string payload;
    /// @returns the status code of a kClose
    [[nodiscard]] int code() const;
    [[nodiscard]] std::string reason() const { return payload.size() > 2 ? payload.substr(2) : ""; }
  };

  /// Connects and sends the handshake of the site's own page.
  explicit PageClient(std::uint16_t port, int receive_buffer = 0);
  /// Uses a connection that is open. @param head  of the handshake, complete
  PageClient(std::unique_ptr<RawClient> connection, const std::string& head);

  [[nodiscard]] const std::string& handshake() const noexcept { return handshake_; }
  void send(std::string_view message, int opcode = kBinary);
  /// Sends many messages with one write.
  void send_at_once(const std::vector<std::string>& messages);
  /// Sends only the head of a frame with this length.
  void begin(std::uint64_t length);
  Frame receive();
  /// @returns the next frame that is no ping
  Frame receive_message();
  /// Answers pings and reads all other frames until the connection is closed. @returns the last frame
  Frame receive_until_closed();
  RawClient& connection() { return *connection_; }

  /// @returns the head of a WebSocket handshake
  static std::string head(const std::string& fields, const std::string& path = "/");
  static std::string good_fields();

 private:
  std::unique_ptr<RawClient> connection_;
  std::string handshake_;
};

}  // namespace phalanx
