// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace phalanx {

/// Origin of a result. libm may round differently on another CPU, so every result states where it was made.
struct Made {
  std::string commit;      ///< `git describe` at build time, "-dirty" appended if tracked files differed;
                           ///< "unknown" outside git
  std::string cpu;         ///< model name
  std::string compiler;    ///< name and version
  std::string build_type;  ///< CMake's build type, with the sanitizers if any
  std::string date;        ///< UTC, ISO 8601, to the second
};

/// @returns the origin of this program on this machine, now. It reads the clock and
/// /proc/cpuinfo; not real-time.
[[nodiscard]] Made made_here();

/// @returns a hash of this machine's sine, cosine, arc tangent, exponential, power and hypotenuse at ten thousand
/// numbers: libm may choose other code, and round otherwise, on another CPU, and then forces differ in their last
/// bits. About 1 ms.
[[nodiscard]] std::uint64_t libm_fingerprint() noexcept;

/// @returns the commit alone, as in Made.
[[nodiscard]] const char* built_from_commit() noexcept;

}  // namespace phalanx
