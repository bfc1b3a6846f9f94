// SPDX-License-Identifier: Apache-2.0
// What a request says about its server, its sender and its target, checked without a socket: the Host field,
// the token, the origin, the path. http_request.cpp calls the checks in their order.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>

#include "serve/web/response.h"

namespace phalanx::web {

/// Host name of a Host field, in lower case, without port, brackets and final dot: "::1" for "[::1]:8480".
/// @returns none if the field is not a name or an address with or without a port
[[nodiscard]] std::optional<std::string> host_name(std::string_view host);

/// @returns the names by which browsers may address a server that listens on this address: localhost, the
/// loopback addresses and the address itself. If other machines can reach it, the machine's names and its
/// reachable_addresses() as well. A server on loopback does not accept the machine's name in the network:
/// another machine could answer to that name and serve a page that then reaches this server.
[[nodiscard]] std::set<std::string> server_names(const std::string& address);

/// Check of the Host field against DNS rebinding: a page of another site, whose name is made to resolve to
/// this machine, sends that name and is refused.
class HostCheck {
 public:
  explicit HostCheck(std::set<std::string> names) : names_(std::move(names)) {}
  /// @param local_address  of the connection; a Host field may name it
  /// @returns the refusal (421), or none
  [[nodiscard]] std::optional<Reply> refusal(std::string_view host, const std::string& local_address) const;

 private:
  std::set<std::string> names_;
};

/// Check of the token in the address or in the cookie. It decides who may connect, and who may operate.
class TokenCheck {
 public:
  /// The request is accepted.
  struct Accepted {
    bool may_operate = false;
  };
  /// The request is accepted by the token in its address. Later ones are accepted by this cookie.
  struct AcceptedByAddress {
    bool may_operate = false;
    std::string cookie;  ///< value of the Set-Cookie field
  };
  using Result = std::variant<Reply, Accepted, AcceptedByAddress>;

  /// @param operator_token  empty: all requests are accepted, and all clients may operate
  /// @param viewer_token    empty: there are no viewers
  /// @param port            of the server, part of the cookie's name: cookies are not separated by port
  /// @param tls             the cookie is for TLS connections only
  TokenCheck(std::string operator_token, std::string viewer_token, std::uint16_t port, bool tls);
  /// @returns the refusal (403), or how the request is accepted. Compares secrets in constant time.
  [[nodiscard]] Result check(std::string_view query, std::string_view cookies) const;

 private:
  [[nodiscard]] std::optional<Accepted> role_of(std::string_view token) const;

  std::string operator_token_;
  std::string viewer_token_;
  std::string cookie_name_;
  bool tls_;
};

/// @returns true if both texts are equal; takes the same time wherever they differ
[[nodiscard]] bool equal_secrets(std::string_view a, std::string_view b);

/// @returns the refusal (403) of a request whose Origin is not exactly the page's own, or none
[[nodiscard]] std::optional<Reply> origin_refusal(std::string_view origin, std::string_view host, bool tls);

/// @returns true if the text is a Sec-WebSocket-Key as RFC 6455 defines it: 16 bytes in base64
[[nodiscard]] bool is_websocket_key(std::string_view key) noexcept;

/// The target of a request line, in its parts.
struct RequestTarget {
  std::string path;   ///< decoded; begins with '/', and no segment but the last is empty, none is "." or ".."
  std::string query;  ///< after '?', not decoded
};

/// Reads the target of a request line. @returns none if it could be read in two ways: no '/' at its
/// beginning, "//", ".", "..", '\', an encoded '/' or '\', a control character, '%' without two
/// digits, invalid UTF-8
[[nodiscard]] std::optional<RequestTarget> read_target(std::string_view target);

/// Finds a name in a query or, with ';', in a Cookie field. @returns its value, not decoded; none
/// if it is not there
[[nodiscard]] std::optional<std::string_view> value_of(std::string_view list, char separator,
                                                       std::string_view name);
/// @returns the query without the pairs of that name
[[nodiscard]] std::string without(std::string_view query, std::string_view name);
/// @returns true if an Accept-Encoding field accepts gzip
[[nodiscard]] bool accepts_gzip(std::string_view field);

}  // namespace phalanx::web
