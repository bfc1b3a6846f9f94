// SPDX-License-Identifier: Apache-2.0
#include "contact/search/search_functions.h"

#if defined(__AVX512DQ__)  // set for this file alone
#define PHALANX_SEARCH_SET avx512
#define PHALANX_DOUBLES 8
#define PHALANX_FLOATS 8
#include "contact/search/search_impl.h"
#endif

namespace phalanx::search {

const SearchFunctions* avx512_functions() noexcept {
#if defined(__AVX512DQ__)
  return &avx512::kFunctions;
#else
  return nullptr;
#endif
}

}  // namespace phalanx::search
