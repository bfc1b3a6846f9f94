// SPDX-License-Identifier: Apache-2.0
#include "serve/web/server_context.h"

#include <fmt/format.h>

#include <utility>

#include "phalanx/serve/reach.h"
#include "serve/web/secret_file.h"
#include "serve/web/session/http_session.h"
#include "serve/web/session/page_session.h"

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
            fmt::format("a token needs at least {} letters, digits, '-' or '_'", kShortestToken));
  }
  require(settings.viewer_token.empty() || !settings.operator_token.empty(),
          "with a viewers' token but without the operator's all clients could operate; give both");
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
  require(is_loopback(settings.address) || !open,
          fmt::format("other machines can reach {}, so a certificate, its key and a token are needed; "
                      "or listen on 127.0.0.1 and connect through SSH",
                      settings.address));
}

/// @returns a context for TLS 1.2 and 1.3 with the certificate of the settings; none if they name none.
/// @throws WebServerError if a file cannot be read, the key belongs to another certificate, or others than
/// the owner may read or write the key
std::optional<net::ssl::context> tls_context(const WebServerSettings& settings) {
  if (settings.certificate.empty() && settings.key.empty()) return std::nullopt;
  if (settings.certificate.empty() || settings.key.empty()) {
    throw WebServerError("TLS needs a certificate and its key; only one of them was given");
  }
  std::optional<net::ssl::context> context(std::in_place, net::ssl::context::tls_server);
  context->set_options(net::ssl::context::default_workarounds | net::ssl::context::no_compression |
                       net::ssl::context::no_tlsv1 | net::ssl::context::no_tlsv1_1);
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  // Allows of TLS 1.2 only suites with forward secrecy and authenticated encryption, which excludes CBC. All
  // suites of TLS 1.3 have both.
  if (SSL_CTX_set_cipher_list(context->native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20") != 1)
    throw WebServerError("TLS: this machine's OpenSSL has no suite of TLS 1.2 with AES-GCM or ChaCha20");
  error_code error;
  context->use_certificate_chain_file(settings.certificate.string(), error);
  if (error) {
    throw WebServerError(fmt::format("{}: this is no certificate in PEM that can be read ({})",
                                     settings.certificate.string(), error.message()));
  }
  const std::string key = read_secret_file(settings.key);
  context->use_private_key(net::buffer(key), net::ssl::context::pem, error);
  if (error || SSL_CTX_check_private_key(context->native_handle()) != 1) {
    throw WebServerError(fmt::format("{}: this is no key in PEM that can be read and belongs to {}",
                                     settings.key.string(), settings.certificate.string()));
  }
  return context;
}

}  // namespace

void check(const WebServerSettings& settings) {
  check_tokens(settings);
  check_address(settings);
  require(settings.frame_rate_hz >= 1.0 && settings.frame_rate_hz <= 1000.0,
          fmt::format("the frame rate is {} Hz; give 1 to 1000", settings.frame_rate_hz));
  require(settings.request_timeout > 0.0 && settings.request_timeout <= 3600.0 &&
              settings.idle_timeout > 0.0 && settings.idle_timeout <= 3600.0 &&
              settings.pending_timeout > 0.0 && settings.pending_timeout <= 3600.0,
          "a timeout must be above 0 s and at most 3600 s");
  require(settings.message_limit > 0 && settings.messages_per_second > 0 &&
              settings.messages_per_second <= 100000 && settings.queue_limit > 0 &&
              settings.queue_bytes > 0 && settings.connections > 0 && settings.pending_connections > 0 &&
              settings.pending_per_address > 0,
          "the limits of a server must be at least 1, and messages per second at most 100,000");
  require(settings.header_limit >= 256 && settings.header_limit <= kLargestHeader,
          fmt::format("the limit of a request's head is {} bytes; give 256 to {}", settings.header_limit,
                      kLargestHeader));
}

ServerContext::ServerContext(WebServerSettings given, WebApplication& its_application, net::io_context& io,
                             std::uint16_t port)
    : settings(std::move(given)),
      application(its_application),
      site(settings.site),
      tls(tls_context(settings)),
      host_check(server_names(settings.address)),
      token_check(settings.operator_token, settings.viewer_token, port, tls.has_value()),
      executor(std::make_shared<ServerExecutor>(io)),
      pages(std::in_place, io, settings.frame_rate_hz, application),
      limiter(settings.pending_connections,
              is_loopback(settings.address) ? settings.pending_connections : settings.pending_per_address) {}

ServerContext::~ServerContext() = default;

void ServerContext::release() noexcept {
  pages.reset();
  waiting.clear();
}

}  // namespace phalanx::web
