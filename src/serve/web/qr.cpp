// SPDX-License-Identifier: Apache-2.0
#include <qrencode.h>

#include <cstddef>
#include <memory>
#include <stdexcept>

#include "phalanx/serve/reach.h"

namespace phalanx {
namespace {

constexpr int kQuietZone = 4;  // [modules]

/// A code with light modules all around it.
class Code {
 public:
  explicit Code(const std::string& text)
      : code_(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_M), &QRcode_free) {
    if (!code_) throw std::runtime_error("this text cannot be shown as a QR code: it is empty or too long");
  }
  [[nodiscard]] int begin() const noexcept { return -kQuietZone; }
  [[nodiscard]] int end() const noexcept { return code_->width + kQuietZone; }
  [[nodiscard]] bool dark(int row, int column) const noexcept {
    const int width = code_->width;
    if (row < 0 || column < 0 || row >= width || column >= width) return false;
    return (code_->data[static_cast<std::size_t>(row * width + column)] & 1U) != 0;
  }

 private:
  std::unique_ptr<QRcode, decltype(&QRcode_free)> code_;
};

const char* half_blocks(bool upper, bool lower) noexcept {
  if (upper) return lower ? "\u2588" : "\u2580";
  return lower ? "\u2584" : " ";
}

}  // namespace

std::string qr_text(const std::string& text) {
  // Black on white of the 256 colours: the first 16 are what the terminal's theme makes of them.
  constexpr const char* kBlackOnWhite = "\x1b[38;5;16;48;5;231m";
  constexpr const char* kAsBefore = "\x1b[0m";
  const Code code(text);
  std::string out;
  for (int row = code.begin(); row < code.end(); row += 2) {
    out += kBlackOnWhite;
    for (int column = code.begin(); column < code.end(); ++column) {
      out += half_blocks(code.dark(row, column), code.dark(row + 1, column));
    }
    out += kAsBefore;
    out += '\n';
  }
  return out;
}

}  // namespace phalanx
