// SPDX-License-Identifier: Apache-2.0
// What goes back over HTTP.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"

namespace phalanx::web {

/// An HTTP body that many answers share: a file is in memory once.
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

struct Reply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  Bytes body;
  std::string cache = "no-store";
  std::vector<std::pair<http::field, std::string>> fields;  ///< more of them
};

/// A refusal, or anything else that a sentence says.
[[nodiscard]] Reply sentence(int status, const std::string& text);

/// What of the request its answer depends on.
struct Exchange {
  unsigned version = 11;
  bool keep_alive = false;
  bool head_only = false;
  std::string host;  ///< as the browser named it, found good; empty: not looked at yet
  bool tls = false;
};

/// The fields that every answer carries, whatever it says.
void protect(http::fields& fields, const Exchange& exchange);
[[nodiscard]] Response response_of(const Reply& reply, const Exchange& exchange);

}  // namespace phalanx::web
