// SPDX-License-Identifier: Apache-2.0
#include "contact/search/search_functions.h"

#if defined(__AVX2__)  // set for this file alone
#define PHALANX_SEARCH_SET avx2
#define PHALANX_DOUBLES 4
#define PHALANX_FLOATS 8
#include "contact/search/search_impl.h"
#endif

namespace phalanx::search {

const SearchFunctions* avx2_functions() noexcept {
#if defined(__AVX2__)
  return &avx2::kFunctions;
#else
  return nullptr;
#endif
}

}  // namespace phalanx::search
