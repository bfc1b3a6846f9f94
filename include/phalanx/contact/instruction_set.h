// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace phalanx {

/// Instruction set of the contact search. All sets give the same bits; they differ in how many numbers
/// one instruction processes.
enum class InstructionSet {
  kPortable,  ///< available on every processor of the architecture: 2 doubles
  kAvx2,      ///< 4 doubles
  kAvx512,    ///< 8 doubles (F, DQ, BW, VL)
};

/// Returns "portable", "avx2" or "avx512".
[[nodiscard]] std::string_view instruction_set_name(InstructionSet set) noexcept;

/// @returns true if this processor has the set and this program was built with it
[[nodiscard]] bool has_instruction_set(InstructionSet set) noexcept;

/// Returns the widest set that this processor has. Searches use it by default.
[[nodiscard]] InstructionSet best_instruction_set() noexcept;

/// Returns the set that searches use now. Real-time.
[[nodiscard]] InstructionSet instruction_set() noexcept;

/// Selects the set of all later searches. For tests and benchmarks; not while another thread is in step().
/// @throws std::invalid_argument if the processor does not have it.
void use_instruction_set(InstructionSet set);

}  // namespace phalanx
