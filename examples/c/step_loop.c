// SPDX-License-Identifier: Apache-2.0
// step_loop [SCENE]: plays the motion of a scene through the step. It prints forces, and hashes of all results.
//   cc -std=c99 step_loop.c $(pkg-config --cflags --libs phalanx) -o step_loop
#include <inttypes.h>
#include <phalanx/phalanx.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check(phalanx_result result) {
  if (result == PHALANX_OK) return;
  fprintf(stderr, "step_loop: %s: %s\n", phalanx_result_name(result), phalanx_error_text());
  exit(1);
}

// FNV-1a with 64 bits, over the bytes of numbers.
static uint64_t add(uint64_t hash, const void* bytes, size_t size) {
  for (size_t i = 0; i < size; ++i) hash = (hash ^ ((const unsigned char*)bytes)[i]) * 0x100000001b3u;
  return hash;
}

int main(int argc, char** argv) {
  phalanx_scene* scene = NULL;
  phalanx_model* model = NULL;
  phalanx_motion* motion = NULL;
  phalanx_state* state = NULL;
  check(phalanx_scene_load(argc > 1 ? argv[1] : "press_teapot", &scene));
  check(phalanx_model_create(scene, &model));
  check(phalanx_motion_create(scene, &motion));
  check(phalanx_state_create(model, scene, &state));
  double seconds = 0.0, rate = 0.0;
  check(phalanx_motion_get_seconds(motion, &seconds));
  check(phalanx_state_get_rate(state, &rate));
  const long steps = (long)(seconds * rate + 0.5);
  phalanx_sample sample = {.struct_size = sizeof sample};
  phalanx_snapshot now = {.struct_size = sizeof now};
  uint64_t forces = 0xcbf29ce484222325u, all = forces;
  for (long i = 0; i < steps; ++i) {
    check(phalanx_motion_get_sample(motion, (double)i / rate, &sample));  // a device measures this
    check(phalanx_step(state, &sample, NULL));
    check(phalanx_state_get_snapshot(state, &now));  // now.torque goes to the motors
    forces = add(forces, now.torque, sizeof now.torque);
    for (int s = 0; s < PHALANX_SEGMENTS; ++s) {
      forces = add(forces, &now.segment[s].force, sizeof(double));
      forces = add(forces, now.segment[s].point, sizeof now.segment[s].point);
      forces = add(forces, now.segment[s].normal, sizeof now.segment[s].normal);
    }
    all = add(all, &now.status, sizeof now - sizeof now.struct_size);
    if (i % (long)(rate / 4) == 0)
      printf("%5.2f s  index: tip %7.3f N, knuckle %8.4f Nm\n", now.time_s, now.segment[5].force,
             now.torque[4]);
  }
  printf("%ld steps, forces %016" PRIx64 ", snapshots %016" PRIx64 "\n", steps, forces, all);
  check(phalanx_state_destroy(state));
  check(phalanx_motion_destroy(motion));
  check(phalanx_model_destroy(model));
  check(phalanx_scene_destroy(scene));
  return 0;
}
