// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/instruction_set.h"

#include <atomic>
#include <stdexcept>
#include <string>

#include "contact/search/search_functions.h"

namespace phalanx {
namespace {

bool processor_has(InstructionSet set) noexcept {
#if defined(__x86_64__)
  __builtin_cpu_init();
  switch (set) {
    case InstructionSet::kPortable:
      return true;
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::kAvx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512vl") != 0;
  }
  return false;
#else
  return set == InstructionSet::kPortable;
#endif
}

const search::SearchFunctions* functions_of(InstructionSet set) noexcept {
  switch (set) {
    case InstructionSet::kPortable:
      return search::portable_functions();
    case InstructionSet::kAvx2:
      return search::avx2_functions();
    case InstructionSet::kAvx512:
      return search::avx512_functions();
  }
  return search::portable_functions();
}

std::atomic<InstructionSet>& chosen() noexcept {
  static std::atomic<InstructionSet> set{best_instruction_set()};
  return set;
}

}  // namespace

std::string_view instruction_set_name(InstructionSet set) noexcept {
  switch (set) {
    case InstructionSet::kPortable:
      return "portable";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvx512:
      return "avx512";
  }
  return "portable";
}

bool has_instruction_set(InstructionSet set) noexcept {
  return processor_has(set) && functions_of(set) != nullptr;
}

InstructionSet best_instruction_set() noexcept {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2}) {
    if (has_instruction_set(set)) return set;
  }
  return InstructionSet::kPortable;
}

InstructionSet instruction_set() noexcept { return chosen().load(std::memory_order_relaxed); }

void use_instruction_set(InstructionSet set) {
  if (!has_instruction_set(set)) {
    throw std::invalid_argument("this processor (or this build) has no " +
                                std::string(instruction_set_name(set)) + "; the widest it has is " +
                                std::string(instruction_set_name(best_instruction_set())));
  }
  chosen().store(set, std::memory_order_relaxed);
}

namespace search {

const SearchFunctions& functions() noexcept { return *functions_of(instruction_set()); }

}  // namespace search
}  // namespace phalanx
