// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/ssl.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace phalanx {

/// TCP client that sends and receives bytes as they are, without an HTTP library. Each wait ends
/// after 5 minutes.
class RawClient {
 public:
  /// @param receive_buffer  of the socket [bytes]; 0: the system's default
  /// @param address         of this machine
  explicit RawClient(std::uint16_t port, int receive_buffer = 0, const char* address = "127.0.0.1");
  /// Connects with TLS and does not verify the certificate. @throws std::runtime_error if the handshake fails
  /// @param tls12_suites  an OpenSSL list: at most TLS 1.2, with these suites only; null: OpenSSL's defaults
  static std::unique_ptr<RawClient> secure(std::uint16_t port, const char* address = "127.0.0.1",
                                           const char* tls12_suites = nullptr);
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  ~RawClient();

  /// @returns false if the server has closed the connection
  bool send(std::string_view text);
  /// Reads until the server closes.
  std::string receive_all();
  /// Reads until the text arrives or the server closes.
  std::string receive_until(std::string_view text);
  /// Reads one response with a Content-Length.
  std::string receive_response(bool with_body = true);
  /// Reads this number of bytes.
  std::string receive(std::size_t bytes);
  /// Resets the connection.
  void abort();
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  bool more();

  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_{nullptr, &SSL_CTX_free};
  std::unique_ptr<SSL, decltype(&SSL_free)> tls_{nullptr, &SSL_free};
  int descriptor_ = -1;
  std::string read_;  ///< bytes that were read and not returned yet
};

/// @returns the status of a response: 200 for "HTTP/1.1 200 OK..."; 0 without a response
int status_of(const std::string& answer);
/// @returns a field's value; empty if it is not there
std::string field_of(const std::string& answer, const std::string& name);
std::string body_of(const std::string& answer);

/// @returns a GET request with Host 127.0.0.1, Connection: close and further fields ("Name: value\r\n" each)
std::string get(const std::string& path, const std::string& fields = "");
/// Sends one request on a new connection. @returns the response
std::string ask(std::uint16_t port, const std::string& request);
std::string ask_securely(std::uint16_t port, const std::string& request);

}  // namespace phalanx
