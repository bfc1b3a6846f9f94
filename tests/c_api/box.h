// SPDX-License-Identifier: Apache-2.0
// A model without any file, and a finger that bends into it.
#ifndef PHALANX_TESTS_C_API_BOX_H
#define PHALANX_TESTS_C_API_BOX_H

#include <math.h>

#include "c_api/checks.h"

static const double kNan = (double)NAN;
static const double kEndless = (double)INFINITY;

// A box of 200 x 30 x 200 mm below the built-in hand, which is 180 mm long. Its top is at y = -20 mm.
static const double kBox[] = {-0.1, -0.05, -0.2, 0.1, -0.05, -0.2, 0.1, -0.02, -0.2, -0.1, -0.02, -0.2,
                              -0.1, -0.05, 0.0,  0.1, -0.05, 0.0,  0.1, -0.02, 0.0,  -0.1, -0.02, 0.0};
static const int32_t kBoxTriangles[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                        3, 7, 6, 3, 6, 2, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5};

static inline phalanx_model* box_model(void) {
  phalanx_model* model = NULL;
  GOOD(phalanx_model_create_from_mesh(NULL, kBox, 8, kBoxTriangles, 12, &model));
  return model;
}

static inline phalanx_state* box_state(phalanx_model* model) {
  phalanx_state* state = NULL;
  GOOD(phalanx_state_create(model, NULL, &state));
  return state;
}

// Bends the index finger for `steps` steps from `first` on, at 1 rad/s.
static inline void bend(phalanx_state* state, int first, int steps) {
  phalanx_sample sample = {.struct_size = sizeof sample};
  for (int i = first; i < first + steps; ++i) {
    sample.time_s = i / 200.0;
    sample.angle[4] = i / 200.0;
    GOOD(phalanx_step(state, &sample, NULL));
  }
}

#endif  // PHALANX_TESTS_C_API_BOX_H
