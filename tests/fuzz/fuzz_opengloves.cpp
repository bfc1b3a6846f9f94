// SPDX-License-Identifier: Apache-2.0
// Whatever a glove's serial line holds: numbers stay in range, a line that is usable says so for a reason,
// and an answer made of its numbers reads back.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "phalanx/device/opengloves/opengloves_codec.h"

namespace {

void must(bool holds) {
  if (!holds) std::abort();
}

void check(const phalanx::GloveLine& line) {
  bool any = false;
  for (std::size_t key = 0; key < line.value.size(); ++key) {
    must(line.value[key] >= 0 && line.value[key] <= phalanx::kGloveWide);
    must(line.has[key] || line.value[key] == 0);
    any = any || line.has[key];
  }
  must(line.usable() == (any && !line.damaged));
  must(line.clamped >= 0);
}

void check_answer(const phalanx::GloveLine& line) {
  phalanx::GloveStops stops{};
  for (std::size_t d = 0; d < stops.size(); ++d)
    stops[d] = line.value[phalanx::glove_curl_key(static_cast<int>(d))] % 1001;
  std::array<char, phalanx::kGloveAnswerSize> text{};
  const std::size_t size = phalanx::format_glove_answer(stops, text);
  must(size <= text.size() && text[size - 1] == '\n');
  const phalanx::GloveLine back = phalanx::parse_glove_line({text.data(), size});
  must(back.usable());
  for (std::size_t d = 0; d < stops.size(); ++d)
    must(back.value[phalanx::glove_curl_key(static_cast<int>(d))] == stops[d]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const phalanx::GloveLine line = phalanx::parse_glove_line({reinterpret_cast<const char*>(data), size});
  check(line);
  check_answer(line);
  return 0;
}
