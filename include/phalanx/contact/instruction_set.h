// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace phalanx {

/// The instructions that the contact search is carried out in. All give the same bits; they differ in how
/// many numbers they take at once.
enum class InstructionSet {
  kPortable,  ///< what every processor of the architecture has: 2 doubles
  kAvx2,      ///< 4 doubles
  kAvx512,    ///< 8 doubles (F, DQ, BW, VL)
};

/// "portable", "avx2", "avx512".
[[nodiscard]] std::string_view instruction_set_name(InstructionSet set) noexcept;

/// Whether this processor has them and this program was built with them.
[[nodiscard]] bool has_instruction_set(InstructionSet set) noexcept;

/// The widest that this processor has; what searches use unless told otherwise.
[[nodiscard]] InstructionSet best_instruction_set() noexcept;

/// What searches use now.
[[nodiscard]] InstructionSet instruction_set() noexcept;

/// Lets every later search use `set`. For tests and benchmarks; not while another thread is in step().
/// @throws std::invalid_argument if the processor does not have it.
void use_instruction_set(InstructionSet set);

}  // namespace phalanx
