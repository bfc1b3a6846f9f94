// SPDX-License-Identifier: Apache-2.0
// Checks for the test programs in C. A failed check is printed, and the program goes on; failures() is its status.
#ifndef PHALANX_TESTS_C_API_CHECKS_H
#define PHALANX_TESTS_C_API_CHECKS_H

#include <stdio.h>
#include <string.h>

#include "phalanx/phalanx.h"

static int failed_checks = 0;

#define CHECK(condition)                                                        \
  do {                                                                          \
    if (!(condition)) {                                                         \
      ++failed_checks;                                                          \
      fprintf(stderr, "%s:%d: not true: %s\n", __FILE__, __LINE__, #condition); \
    }                                                                           \
  } while (0)

// The call gives this result; a failure has a text, in which `part` stands.
static inline void check_result(int line, const char* call, phalanx_result wanted, phalanx_result result,
                                const char* part) {
  const int told = result == PHALANX_OK || strstr(phalanx_error_text(), part) != NULL;
  if (result == wanted && told) return;
  ++failed_checks;
  fprintf(stderr, "line %d: %s: %s, wanted %s with \"%s\"; text: %s\n", line, call,
          phalanx_result_name(result), phalanx_result_name(wanted), part, phalanx_error_text());
}
#define GOOD(call) check_result(__LINE__, #call, PHALANX_OK, (call), "")
#define FAILS(result, part, call) check_result(__LINE__, #call, result, (call), part)

static inline int failures(void) {
  if (failed_checks > 0) fprintf(stderr, "%d checks failed\n", failed_checks);
  return failed_checks > 0;
}

#endif  // PHALANX_TESTS_C_API_CHECKS_H
