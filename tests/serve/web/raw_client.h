// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/ssl.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace phalanx {

/// A TCP connection to this machine that says what it is told and takes what comes: no client library between
/// a test and the server. Everything has a generous time limit.
class RawClient {
 public:
  /// @param receive_buffer  of the socket [bytes]; 0: as the system has it
  /// @param address         of this machine
  explicit RawClient(std::uint16_t port, int receive_buffer = 0, const char* address = "127.0.0.1");
  /// With TLS, whatever the certificate says. @throws std::runtime_error  no handshake
  /// @param tls12_suites  an OpenSSL list: at most TLS 1.2, with these suites only; null: as OpenSSL has it
  static std::unique_ptr<RawClient> secure(std::uint16_t port, const char* address = "127.0.0.1",
                                           const char* tls12_suites = nullptr);
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  ~RawClient();

  /// @returns false if the other end does not take it any more
  bool say(std::string_view text);
  /// What comes until the other end closes.
  std::string hear_all();
  /// What comes until that text is in it, or the other end closes.
  std::string hear_until(std::string_view text);
  /// One whole answer with a Content-Length.
  std::string hear_answer(bool with_body = true);
  /// So many bytes, of what was already read or comes.
  std::string hear(std::size_t bytes);
  /// With a reset, as a machine that lost its power does.
  void vanish();
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  bool more();

  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_{nullptr, &SSL_CTX_free};
  std::unique_ptr<SSL, decltype(&SSL_free)> tls_{nullptr, &SSL_free};
  int descriptor_ = -1;
  std::string read_;  ///< and not asked for yet
};

/// "200" of "HTTP/1.1 200 OK..."; 0: no answer.
int status_of(const std::string& answer);
/// A field's value, empty: not there.
std::string field_of(const std::string& answer, const std::string& name);
std::string body_of(const std::string& answer);

/// "GET path HTTP/1.1", Host 127.0.0.1, more fields ("Name: value\r\n" each), closing.
std::string get(const std::string& path, const std::string& fields = "");
/// One request on a connection of its own. @returns all that comes
std::string ask(std::uint16_t port, const std::string& request);
std::string ask_securely(std::uint16_t port, const std::string& request);

}  // namespace phalanx
