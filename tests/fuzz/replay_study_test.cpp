// SPDX-License-Identifier: Apache-2.0
// By itself, in study_test: under AddressSanitizer only `./test --full` compiles the studies.
#include "replay.h"

extern "C" int fuzz_study(const std::uint8_t* data, std::size_t size);

namespace phalanx {
namespace {

TEST(FuzzReplay, StudyFiles) { test::replay("fuzz_study", fuzz_study); }

}  // namespace
}  // namespace phalanx
