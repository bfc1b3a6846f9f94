// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/made.h"

#include <array>
#include <cmath>
#include <ctime>
#include <fstream>

#include "phalanx/core/bit_hash.h"
#include "phalanx_commit.h"

namespace phalanx {
namespace {

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line)) {
    if (!line.starts_with("model name")) continue;
    const std::size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
    if (start != std::string::npos) return line.substr(start);
  }
  return "unknown";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text;
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

std::string compiler_name() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

std::string build_type() {
  const std::string type = PHALANX_BUILD_TYPE;
  const std::string sanitizers = PHALANX_SANITIZERS;
  return sanitizers.empty() ? type : type + "+" + sanitizers;
}

}  // namespace

Made made_here() {
  return {.commit = built_from_commit(),
          .cpu = cpu_name(),
          .compiler = compiler_name(),
          .build_type = build_type(),
          .date = utc_now()};
}

std::uint64_t libm_fingerprint() noexcept {
  BitHash hash;
  for (int i = 0; i < 10000; ++i) {
    const double angle = (i - 5000) * 0.000628318530717;
    for (const double value : {std::sin(angle), std::cos(angle), std::atan2(angle, 1.3), std::exp(angle),
                               std::pow(1.0 + angle * angle, 0.7), std::hypot(angle, 0.9)})
      hash.add(value);
  }
  return hash.value();
}

const char* built_from_commit() noexcept { return PHALANX_COMMIT; }

}  // namespace phalanx
