// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/mesh/isolation/isolation_helper.h"

namespace phalanx::test {

/// From now on this program's mesh files are read by a helper process, as those of `phalanx run`. Each fork of
/// a sanitized program that has grown takes tenths of a second. Call it in SetUpTestSuite().
inline void read_meshes_in_helper() { static const mesh::IsolationHelper helper; }

}  // namespace phalanx::test
