// SPDX-License-Identifier: Apache-2.0
#include "study/made_json.h"

namespace phalanx {

nlohmann::ordered_json made_json(const Made& made) {
  return {{"commit", made.commit},
          {"cpu", made.cpu},
          {"compiler", made.compiler},
          {"build_type", made.build_type},
          {"date", made.date}};
}

}  // namespace phalanx
