// SPDX-License-Identifier: Apache-2.0
#include "serve/web/settings.h"

#include <fmt/format.h>

#include "phalanx/serve/reach.h"
#include "serve/web/boost.h"

namespace phalanx::web {
namespace {

constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLargestHeader = 1024 * 1024;  // [bytes]

void require(bool good, const std::string& problem) {
  if (!good) throw WebServerError(problem);
}

bool is_token(const std::string& token) {
  constexpr std::string_view kCharacters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  return token.size() >= kShortestToken && token.find_first_not_of(kCharacters) == std::string::npos;
}

void check_tokens(const WebServerSettings& settings) {
  for (const std::string* token : {&settings.operator_token, &settings.viewer_token}) {
    require(token->empty() || is_token(*token),
            fmt::format("a token has at least {} letters, digits, '-' or '_'", kShortestToken));
  }
  require(settings.viewer_token.empty() || !settings.operator_token.empty(),
          "a viewers' token without the operator's lets everybody operate; give both");
  require(settings.viewer_token.empty() || settings.viewer_token != settings.operator_token,
          "the viewers' token must not be the operator's");
}

void check_address(const WebServerSettings& settings) {
  error_code error;
  net::ip::make_address(settings.address, error);
  require(!error || settings.address == "localhost",
          fmt::format(
              "\"{}\" is no IP address; give one of this machine's, such as 127.0.0.1, or 0.0.0.0 for all",
              settings.address));
  const bool open = settings.certificate.empty() || settings.operator_token.empty();
  require(
      is_loopback(settings.address) || !open,
      fmt::format("{} can be reached from other machines, so a certificate, its key and a token are needed; "
                  "or listen on 127.0.0.1 and come in through SSH",
                  settings.address));
}

}  // namespace

void check(const WebServerSettings& settings) {
  check_tokens(settings);
  check_address(settings);
  require(settings.frame_rate_hz >= 1.0 && settings.frame_rate_hz <= 1000.0,
          fmt::format("a frame rate of {} Hz; give 1 to 1000", settings.frame_rate_hz));
  require(settings.request_timeout > 0.0 && settings.request_timeout <= 3600.0 &&
              settings.idle_timeout > 0.0 && settings.idle_timeout <= 3600.0 &&
              settings.proof_timeout > 0.0 && settings.proof_timeout <= 3600.0,
          "a timeout is above 0 s and at most 3600 s");
  require(settings.message_limit > 0 && settings.messages_per_second > 0 &&
              settings.messages_per_second <= 100000 && settings.queue_limit > 0 &&
              settings.queue_bytes > 0 && settings.connections > 0 && settings.unproven_connections > 0 &&
              settings.unproven_per_address > 0,
          "the limits of a server are at least 1, and messages per second at most 100,000");
  require(settings.header_limit >= 256 && settings.header_limit <= kLargestHeader,
          fmt::format("a limit of {} bytes for a request's head; give 256 to {}", settings.header_limit,
                      kLargestHeader));
}

}  // namespace phalanx::web
