// SPDX-License-Identifier: Apache-2.0
#define PHALANX_SEARCH_SET portable
#define PHALANX_DOUBLES 2
#define PHALANX_FLOATS 4
#include "contact/search/search_impl.h"

namespace phalanx::search {

const SearchFunctions* portable_functions() noexcept { return &portable::kFunctions; }

}  // namespace phalanx::search
