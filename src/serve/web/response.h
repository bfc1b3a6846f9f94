// SPDX-License-Identifier: Apache-2.0
// HTTP responses: the reply that a check or the application decides on, and the message that Beast sends.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"

namespace phalanx::web {

/// HTTP body that many responses share, so that a file is in memory once. Meets Beast's Body requirements.
struct SharedBody {
  using value_type = Bytes;
  static std::uint64_t size(const value_type& bytes) noexcept { return bytes ? bytes->size() : 0; }

  class writer {
   public:
    using const_buffers_type = net::const_buffer;
    template <bool request, class Fields>
    writer(const http::header<request, Fields>& /*header*/, const value_type& bytes) noexcept
        : bytes_(bytes) {}
    void init(error_code& error) noexcept { error = {}; }
    boost::optional<std::pair<const_buffers_type, bool>> get(error_code& error) noexcept {
      error = {};
      if (!bytes_ || bytes_->empty()) return boost::none;
      return std::make_pair(const_buffers_type(bytes_->data(), bytes_->size()), false);
    }

   private:
    const value_type& bytes_;
  };
};
using Response = http::response<SharedBody>;

/// Content of a response: what does not depend on the connection.
struct Reply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  Bytes body;
  std::string cache = "no-store";
  std::vector<std::pair<http::field, std::string>> fields;  ///< further fields
};

/// @returns a reply with one line of text, such as a refusal
[[nodiscard]] Reply text_reply(int status, const std::string& text);

/// Properties of the connection and the request that a response depends on.
struct ResponseContext {
  unsigned version = 11;  ///< of HTTP, as Beast counts: 11 is HTTP/1.1
  bool keep_alive = false;
  bool head_only = false;  ///< the request is HEAD: the response has no body
  std::string host;        ///< the request's Host field once it has passed the host check; empty before
  bool tls = false;
};

/// Sets the security fields that every response carries.
void set_security_fields(http::fields& fields, const ResponseContext& context);
[[nodiscard]] Response make_response(const Reply& reply, const ResponseContext& context);

}  // namespace phalanx::web
