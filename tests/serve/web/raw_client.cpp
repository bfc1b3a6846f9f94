// SPDX-License-Identifier: Apache-2.0
#include "serve/web/raw_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace phalanx {
namespace {

constexpr int kTimeout = 300'000;  // [ms]

bool await(int descriptor, short what) {
  pollfd one{descriptor, what, 0};
  return ::poll(&one, 1, kTimeout) == 1;
}

std::string small(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

RawClient::RawClient(std::uint16_t port, int receive_buffer, const char* address)
    : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_buffer > 0) {
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  }
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(port);
  const bool known = ::inet_pton(AF_INET, address, &there.sin_addr) == 1;
  if (!known || ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) {
    ::close(descriptor_);
    throw std::runtime_error("cannot connect");
  }
}

RawClient::~RawClient() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::unique_ptr<RawClient> RawClient::secure(std::uint16_t port, const char* address,
                                             const char* tls12_suites) {
  auto client = std::make_unique<RawClient>(port, 0, address);
  client->context_.reset(SSL_CTX_new(TLS_client_method()));
  if (tls12_suites != nullptr &&
      (SSL_CTX_set_max_proto_version(client->context_.get(), TLS1_2_VERSION) != 1 ||
       SSL_CTX_set_cipher_list(client->context_.get(), tls12_suites) != 1))
    throw std::invalid_argument("no such suites");
  client->tls_.reset(SSL_new(client->context_.get()));
  SSL_set_fd(client->tls_.get(), client->descriptor_);
  if (SSL_connect(client->tls_.get()) != 1) throw std::runtime_error("no TLS handshake");
  return client;
}

bool RawClient::send(std::string_view text) {
  if (tls_) return SSL_write(tls_.get(), text.data(), static_cast<int>(text.size())) > 0;
  while (!text.empty()) {
    if (!await(descriptor_, POLLOUT)) return false;
    const ssize_t sent = ::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool RawClient::more() {
  std::array<char, 65536> piece{};
  const bool held = tls_ && SSL_pending(tls_.get()) > 0;
  if (!held && !await(descriptor_, POLLIN)) throw std::runtime_error("no data within 5 minutes");
  const ssize_t got = tls_ ? SSL_read(tls_.get(), piece.data(), static_cast<int>(piece.size()))
                           : ::recv(descriptor_, piece.data(), piece.size(), 0);
  if (got <= 0) return false;
  read_.append(piece.data(), static_cast<std::size_t>(got));
  return true;
}

std::string RawClient::receive_all() {
  while (more()) {
  }
  return std::exchange(read_, {});
}

std::string RawClient::receive_until(std::string_view text) {
  while (read_.find(text) == std::string::npos && more()) {
  }
  const std::size_t at = read_.find(text);
  return receive(at == std::string::npos ? read_.size() : at + text.size());
}

std::string RawClient::receive_response(bool with_body) {
  std::string answer = receive_until("\r\n\r\n");
  const std::string length = field_of(answer, "Content-Length");
  if (with_body && !length.empty()) answer += receive(std::stoul(length));
  return answer;
}

std::string RawClient::receive(std::size_t bytes) {
  while (read_.size() < bytes && more()) {
  }
  const std::string heard = read_.substr(0, bytes);
  read_.erase(0, heard.size());
  return heard;
}

void RawClient::abort() {
  const linger now{1, 0};
  ::setsockopt(descriptor_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
  ::close(std::exchange(descriptor_, -1));
}

int status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.") && answer.size() > 12 ? std::atoi(answer.substr(9, 3).c_str()) : 0;
}

std::string field_of(const std::string& answer, const std::string& name) {
  const std::string head = answer.substr(0, answer.find("\r\n\r\n")) + "\r\n";
  const std::size_t at = small(head).find("\r\n" + small(name) + ": ");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + name.size() + 4;
  return head.substr(begin, head.find("\r\n", begin) - begin);
}

std::string body_of(const std::string& answer) {
  const std::size_t at = answer.find("\r\n\r\n");
  return at == std::string::npos ? "" : answer.substr(at + 4);
}

std::string get(const std::string& path, const std::string& fields) {
  return "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n" + fields + "\r\n";
}

std::string ask(std::uint16_t port, const std::string& request) {
  RawClient client(port);
  client.send(request);
  return client.receive_all();
}

std::string ask_securely(std::uint16_t port, const std::string& request) {
  const auto client = RawClient::secure(port);
  client->send(request);
  return client->receive_all();
}

}  // namespace phalanx
