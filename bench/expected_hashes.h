// SPDX-License-Identifier: Apache-2.0
// The forces that are known to be right, by scene, number of grasps and libm: bench/expected_hashes.txt.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace phalanx::bench {

class ExpectedHashes {
 public:
  /// @throws std::runtime_error naming the file and line that cannot be read; a file that is not there is
  /// empty.
  explicit ExpectedHashes(std::filesystem::path file);

  /// Nothing if this libm or this number of grasps is not on record.
  [[nodiscard]] std::optional<std::uint64_t> find(const std::string& scene, int grasps) const;

  void set(const std::string& scene, int grasps, std::uint64_t hash);

  /// Writes the file anew. @throws std::runtime_error if that fails.
  void save() const;

 private:
  using Key = std::tuple<std::uint64_t, std::string, int>;  ///< libm, scene, grasps
  std::filesystem::path file_;
  std::uint64_t libm_;
  std::map<Key, std::uint64_t> hash_;
};

}  // namespace phalanx::bench
