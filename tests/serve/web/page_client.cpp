// SPDX-License-Identifier: Apache-2.0
#include "serve/web/page_client.h"

#include <array>
#include <cstddef>
#include <utility>

namespace phalanx {
namespace {

constexpr std::array<unsigned char, 4> kMask{0x12, 0x34, 0x56, 0x78};

unsigned byte_at(const std::string& text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

std::string frame_head(int opcode, std::uint64_t length) {
  std::string head(1, static_cast<char>(0x80 | opcode));
  const int extra = length < 126 ? 0 : length < 65536 ? 2 : 8;
  const auto small = static_cast<unsigned>(extra == 0 ? length : extra == 2 ? 126 : 127);
  head += static_cast<char>(0x80U | small);
  for (int i = extra - 1; i >= 0; --i) head += static_cast<char>((length >> (8 * i)) & 0xFFU);
  for (const unsigned char c : kMask) head += static_cast<char>(c);
  return head;
}

std::string frame_of(int opcode, std::string_view message) {
  std::string frame = frame_head(opcode, message.size());
  for (std::size_t i = 0; i < message.size(); ++i) frame += static_cast<char>(message[i] ^ kMask[i % 4]);
  return frame;
}

}  // namespace

int PageClient::Frame::code() const {
  return payload.size() < 2 ? 0 : static_cast<int>(byte_at(payload, 0) * 256 + byte_at(payload, 1));
}

std::string PageClient::good_fields() {
  return "Host: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
}

std::string PageClient::head(const std::string& fields, const std::string& path) {
  return "GET " + path + " HTTP/1.1\r\n" + fields + "\r\n";
}

PageClient::PageClient(std::uint16_t port, int receive_buffer)
    : PageClient(std::make_unique<RawClient>(port, receive_buffer), head(good_fields())) {}

PageClient::PageClient(std::unique_ptr<RawClient> connection, const std::string& head)
    : connection_(std::move(connection)) {
  connection_->send(head);
  handshake_ = connection_->receive_until("\r\n\r\n");
}

void PageClient::send(std::string_view message, int opcode) { connection_->send(frame_of(opcode, message)); }

void PageClient::send_at_once(const std::vector<std::string>& messages) {
  std::string frames;
  for (const std::string& message : messages) frames += frame_of(kBinary, message);
  connection_->send(frames);
}

void PageClient::begin(std::uint64_t length) { connection_->send(frame_head(kBinary, length)); }

PageClient::Frame PageClient::receive() {
  const std::string head = connection_->receive(2);
  if (head.size() < 2) return {};
  std::uint64_t length = byte_at(head, 1) & 0x7FU;
  if (length >= 126) {
    const std::string longer = connection_->receive(length == 126 ? 2 : 8);
    length = 0;
    for (std::size_t i = 0; i < longer.size(); ++i) length = length * 256 + byte_at(longer, i);
  }
  Frame frame{static_cast<int>(byte_at(head, 0) & 0x0FU), connection_->receive(length)};
  if (frame.payload.size() < length) return {};
  return frame;
}

PageClient::Frame PageClient::receive_message() {
  Frame frame = receive();
  while (frame.opcode == kPing) frame = receive();
  return frame;
}

PageClient::Frame PageClient::receive_until_closed() {
  Frame last;
  for (Frame frame = receive(); frame.opcode != kGone; frame = receive()) {
    if (frame.opcode == kPing) send(frame.payload, kPong);
    last = frame;
    if (frame.opcode == kClose) send(frame.payload.substr(0, 2), kClose);
  }
  return last;
}

}  // namespace phalanx
