// SPDX-License-Identifier: Apache-2.0
#include "serve/web/tls.h"

#include <fmt/format.h>

#include "serve/web/secret_file.h"

namespace phalanx::web {

std::optional<net::ssl::context> tls_context(const WebServerSettings& settings) {
  if (settings.certificate.empty() && settings.key.empty()) return std::nullopt;
  if (settings.certificate.empty() || settings.key.empty()) {
    throw WebServerError("TLS needs a certificate and its key; only one of them was given");
  }
  std::optional<net::ssl::context> context(std::in_place, net::ssl::context::tls_server);
  context->set_options(net::ssl::context::default_workarounds | net::ssl::context::no_compression |
                       net::ssl::context::no_tlsv1 | net::ssl::context::no_tlsv1_1);
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  // Of TLS 1.2 the suites with forward secrecy and authenticated encryption; those of 1.3 all are such.
  if (SSL_CTX_set_cipher_list(context->native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20") != 1)
    throw WebServerError("TLS: this machine's OpenSSL has no suite of TLS 1.2 with AES-GCM or ChaCha20");
  error_code error;
  context->use_certificate_chain_file(settings.certificate.string(), error);
  if (error) {
    throw WebServerError(fmt::format("{}: no certificate in PEM that can be read ({})",
                                     settings.certificate.string(), error.message()));
  }
  const std::string key = read_secret_file(settings.key);
  context->use_private_key(net::buffer(key), net::ssl::context::pem, error);
  if (error || SSL_CTX_check_private_key(context->native_handle()) != 1) {
    throw WebServerError(fmt::format("{}: no key in PEM that can be read and that belongs to {}",
                                     settings.key.string(), settings.certificate.string()));
  }
  return context;
}

}  // namespace phalanx::web
