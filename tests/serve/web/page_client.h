// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "serve/web/raw_client.h"

namespace phalanx {

/// A page's end of a WebSocket, frame by frame; answers nothing by itself.
class PageClient {
 public:
  enum Opcode : int { kMore = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10, kGone = -1 };
  struct Frame {
    int opcode = kGone;  ///< kGone: the line is closed
    std::string payload;
    /// Of a kClose.
    [[nodiscard]] int code() const;
    [[nodiscard]] std::string reason() const { return payload.size() > 2 ? payload.substr(2) : ""; }
  };

  /// Asks to be a page, as the site's own page does.
  explicit PageClient(std::uint16_t port, int receive_buffer = 0);
  /// Over a line that is there. @param head  the whole request
  PageClient(std::unique_ptr<RawClient> line, const std::string& head);

  [[nodiscard]] const std::string& welcome() const noexcept { return welcome_; }
  void say(std::string_view message, int opcode = kBinary);
  /// Many in one go.
  void say_at_once(const std::vector<std::string>& messages);
  /// Only the beginning of a frame that says it is so long.
  void begin(std::uint64_t length);
  Frame hear();
  /// The next one that is no ping.
  Frame hear_message();
  /// Answers pings and takes all else in until the line is closed. @returns the last frame
  Frame hear_end();
  RawClient& line() { return *line_; }

  /// The head of a request to become a page.
  static std::string head(const std::string& fields, const std::string& path = "/");
  static std::string good_fields();

 private:
  std::unique_ptr<RawClient> line_;
  std::string welcome_;
};

}  // namespace phalanx
