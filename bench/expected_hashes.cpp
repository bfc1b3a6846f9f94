// SPDX-License-Identifier: Apache-2.0
#include "expected_hashes.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "force_hash.h"

namespace phalanx::bench {

namespace {

/// @returns a hash of this machine's sine and cosine at ten thousand angles: libm may choose other code, and round
/// otherwise, on another CPU, and then forces differ in their last bits
std::uint64_t sine_fingerprint() {
  Hash hash;
  for (int i = 0; i < 10000; ++i) {
    const double angle = (i - 5000) * 0.000628318530717;
    hash.add(std::sin(angle));
    hash.add(std::cos(angle));
  }
  return hash.value();
}

}  // namespace

ExpectedHashes::ExpectedHashes(std::filesystem::path file)
    : file_(std::move(file)), libm_(sine_fingerprint()) {
  std::ifstream in(file_);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string scene;
    int grasps = 0;
    std::uint64_t libm = 0;
    std::uint64_t hash = 0;
    if (!(words >> scene >> grasps >> std::hex >> libm >> hash)) {
      throw std::runtime_error(
          fmt::format("{}:{}: \"{}\" is not SCENE GRASPS LIBM HASH; mend it, or delete the file and run with "
                      "--record",
                      file_.string(), number, line));
    }
    hash_[{libm, scene, grasps}] = hash;
  }
}

std::optional<std::uint64_t> ExpectedHashes::find(const std::string& scene, int grasps) const {
  const auto it = hash_.find({libm_, scene, grasps});
  return it == hash_.end() ? std::nullopt : std::optional(it->second);
}

void ExpectedHashes::set(const std::string& scene, int grasps, std::uint64_t hash) {
  hash_[{libm_, scene, grasps}] = hash;
}

void ExpectedHashes::save() const {
  std::ofstream out(file_);
  out << "# SPDX-License-Identifier: Apache-2.0\n"
         "# Hashes of all forces and torques: scene, grasps, fingerprint of sin and cos, hash.\n"
         "# Written by phalanx_bench --record; a change here is a change of forces.\n";
  for (const auto& [key, hash] : hash_) {
    const auto& [libm, scene, grasps] = key;
    out << fmt::format("{} {} {:016x} {:016x}\n", scene, grasps, libm, hash);
  }
  if (!out.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file_.string()));
}

}  // namespace phalanx::bench
