// SPDX-License-Identifier: Apache-2.0
// Of the tree with ThreadSanitizer. Debian's TBB is not instrumented: the sanitizer does not see that a loop's end waits for
// its tasks, and reports each of their results as a race. So tasks run in the thread that asks for them.
#include <tbb/global_control.h>

namespace {

const tbb::global_control kOneThread(tbb::global_control::max_allowed_parallelism, 1);

}  // namespace
