// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

/// 64-bit FNV-1a hash (http://www.isthe.com/chongo/tech/comp/fnv/). It detects changes, but is not a
/// protection against an attack.
class Fingerprint {
 public:
  void add(std::string_view bytes) noexcept;
  /// @returns the hash as 16 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Computes the fingerprint of the names and contents of files. It depends neither on their order nor on
/// their folders. Each file is read once.
/// @throws std::runtime_error naming the file if one cannot be read.
[[nodiscard]] std::string fingerprint_of_files(std::vector<std::filesystem::path> files);

/// @returns libm_fingerprint() as 16 hexadecimal digits.
[[nodiscard]] std::string libm_text();

}  // namespace phalanx
