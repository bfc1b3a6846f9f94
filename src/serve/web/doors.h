// SPDX-License-Identifier: Apache-2.0
// Who gets in. Nothing here reads a socket.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>

#include "serve/web/reply.h"

namespace phalanx::web {

/// A Host field taken apart: "[::1]:8480" is "::1". @returns none if it is no name or address with or without
/// a port. Small letters, no dot at the end, no brackets.
[[nodiscard]] std::optional<std::string> host_name(std::string_view host);

/// The names in a Host field that are accepted. A page of another site whose name resolves to this machine
/// (DNS rebinding) sends its own name and is refused.
class HostDoor {
 public:
  explicit HostDoor(std::set<std::string> names) : names_(std::move(names)) {}
  /// @param reached  our own address of that connection: whoever came by it may say so
  [[nodiscard]] std::optional<Reply> refusal(std::string_view host, const std::string& reached) const;

 private:
  std::set<std::string> names_;
};

/// Who may come in by what.
class TokenDoor {
 public:
  struct Entry {
    bool may_operate = false;
  };
  /// Come in by the token of the address: to go on by this cookie.
  struct Cookie {
    bool may_operate = false;
    std::string field;  ///< of Set-Cookie
  };
  using Verdict = std::variant<Reply, Entry, Cookie>;

  /// @param operator_token  empty: everybody may come in, and operate
  /// @param port  ours: a browser's cookies are not told apart by it, so their names are
  TokenDoor(std::string operator_token, std::string viewer_token, std::uint16_t port, bool tls);
  [[nodiscard]] Verdict judge(std::string_view query, std::string_view cookies) const;

 private:
  std::optional<Entry> entry(std::string_view token) const;

  std::string operator_token_;
  std::string viewer_token_;
  std::string cookie_;
  bool tls_;
};

/// Whether two texts are the same, in a time that does not tell where they differ.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

/// A Sec-WebSocket-Key as RFC 6455 has it: 16 bytes in base64. @returns true if it is one
[[nodiscard]] bool is_websocket_key(std::string_view key) noexcept;

/// Exactly the page's own origin.
[[nodiscard]] std::optional<Reply> origin_refusal(std::string_view origin, std::string_view host, bool tls);

}  // namespace phalanx::web
