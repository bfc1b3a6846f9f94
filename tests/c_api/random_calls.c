// SPDX-License-Identifier: Apache-2.0 random_calls SEED COUNT: seeded random calls with good and bad
// arguments: null, invented, destroyed and mixed up handles, wrong sizes, numbers that are not finite,
// broken texts. It must not crash, every torque must be finite and within its limit, and every failure must
// have a text.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "c_api/checks.h"

static uint64_t random_state;

static uint64_t any(void) {  // xorshift64*
  random_state ^= random_state >> 12;
  random_state ^= random_state << 25;
  random_state ^= random_state >> 27;
  return random_state * 0x2545f4914f6cdd1du;
}
static uint64_t below(uint64_t count) { return (any() >> 11) % count; }
static int one_in(uint64_t count) { return below(count) == 0; }

static double number(void) {
  static const double kSpecial[] = {0.0, -0.0, 1e-300, -1e300, 1e308, 5.0, -1.0, 1e10};
  switch (below(12)) {
    case 0:
      return (double)NAN;
    case 1:
      return (double)INFINITY;
    case 2:
      return -(double)INFINITY;
    case 3:
      return kSpecial[below(8)];
    default:
      return (double)(int64_t)(any() >> 40) / 1e7;  // 0 .. 1.7
  }
}

static const char* text(void) {
  static const char* kTexts[] = {
      "",
      "force.stiffness_n_per_mm",
      "0.7",
      "objects.0.size_mm",
      "\"none\"",
      "[[[",
      "a = ",
      "nan",
      "\xff\xfe",
      "stabiliser.method",
      "rate_hz",
      "objects",
      "objects.99999999999999999999.kind",
      "[[objects]]\nkind = \"box\"\nsize_mm = [30,30,30]\nposition_mm = [0,-60,-120]\n",
      "1e999",
      "force.law",
      "\"duffing\"",
      "smoothing.max_n_per_s",
      "12",
      ".",
      "..",
      "objects..kind"};
  return one_in(15) ? NULL : kTexts[below(sizeof kTexts / sizeof *kTexts)];
}

enum kind { kScene, kModel, kMotion, kState, kRecorder, kRecording, kKinds };
enum { kKept = 4 };
static void* kept[kKinds][kKept];  // handles, alive or destroyed

// Most times one of this kind.
static void* handle(enum kind kind) {
  switch (below(16)) {
    case 0:
      return NULL;
    case 1:
      return (void*)(uintptr_t)any();
    case 2:
      return kept[below(kKinds)][below(kKept)];
    default:
      return kept[kind][below(kKept)];
  }
}
static void keep(enum kind kind, void* made) {
  if (made != NULL) kept[kind][below(kKept)] = made;
}

// Of a struct whose right size is `right`.
static uint32_t size_like(size_t right) {
  switch (below(6)) {
    case 0:
      return (uint32_t)any();
    case 1:
      return (uint32_t)(right - 8 * below(right / 8));
    case 2:
      return (uint32_t)right + 8;
    default:
      return (uint32_t)right;
  }
}

static void check_snapshot(const phalanx_snapshot* now) {
  for (int j = 0; j < PHALANX_JOINTS; ++j) CHECK(fabs(now->torque[j]) <= 0.5);
}

static phalanx_result call(void) {
  double numbers[60];
  int32_t indices[60];
  for (int i = 0; i < 60; ++i) numbers[i] = number() * 0.1;
  for (int i = 0; i < 60; ++i) indices[i] = one_in(20) ? (int32_t)any() : (int32_t)below(20);
  char buffer[40];
  size_t needed = 0;
  uint32_t status = 0;
  void* made = NULL;
  enum kind kind = kScene;  // of `made`
  phalanx_result result = PHALANX_OK;
  switch (below(38)) {
    case 26:
    case 27:
      // Without mesh files: reading one takes a process.
      result =
          phalanx_scene_parse(one_in(2) ? "[hand]\nmeshes = \"capsules\"\n"
                                        : "[hand]\nmeshes = \"capsules\"\n[contact]\nmode = \"sliding\"\n",
                              NULL, (phalanx_scene**)&made);
      break;
    case 28:
    case 29:
      kind = kModel;
      result = phalanx_model_create_from_mesh(NULL, NULL, 0, NULL, 0, (phalanx_model**)&made);
      break;
    case 30:
    case 31:
    case 32:
      kind = kState;
      result = phalanx_state_create(kept[kModel][below(kKept)], NULL, (phalanx_state**)&made);
      break;
    case 0:
      result = phalanx_scene_load(text(), (phalanx_scene**)&made);
      break;
    case 1:
    case 2:
      result = phalanx_scene_parse(text(), text(), (phalanx_scene**)&made);
      break;
    case 3:
    case 4:
      result = phalanx_scene_set(handle(kScene), text(), text());
      break;
    case 5:
      result = phalanx_scene_get(handle(kScene), text(), one_in(5) ? NULL : buffer, below(sizeof buffer + 1),
                                 one_in(3) ? NULL : &needed);
      break;
    case 6:
      kind = kModel;
      result = phalanx_model_create(handle(kScene), one_in(9) ? NULL : (phalanx_model**)&made);
      break;
    case 7: {
      kind = kModel;
      phalanx_hand hand = {.struct_size = size_like(sizeof hand),
                           .left = (uint32_t)below(3),
                           .length = number(),
                           .breadth = number()};
      hand.triangles = one_in(3) ? (uint32_t)any() : 0;
      if (hand.triangles > 20000) hand.triangles = 0xffffffffu;  // keep the time short
      const size_t vertices = below(20), triangles = below(12);
      result = phalanx_model_create_from_mesh(
          one_in(2) ? NULL : &hand, one_in(9) ? NULL : numbers, vertices, one_in(9) ? NULL : indices,
          one_in(30) ? SIZE_MAX / 3 : triangles, one_in(9) ? NULL : (phalanx_model**)&made);
      break;
    }
    case 8: {
      phalanx_mesh mesh = {.struct_size = size_like(sizeof mesh)};
      result = phalanx_model_get_mesh(handle(kModel), (int32_t)below(4), (int32_t)any() % 20,
                                      one_in(9) ? NULL : &mesh);
      break;
    }
    case 9: {
      phalanx_model_info info = {.struct_size = size_like(sizeof info)};
      result = phalanx_model_get_info(handle(kModel), one_in(9) ? NULL : &info);
      break;
    }
    case 10:
      kind = kMotion;
      result = phalanx_motion_create(handle(kScene), (phalanx_motion**)&made);
      break;
    case 11: {
      phalanx_sample sample = {.struct_size = size_like(sizeof sample)};
      result = phalanx_motion_get_sample(handle(kMotion), number(), one_in(9) ? NULL : &sample);
      break;
    }
    case 12:
    case 13:
      kind = kState;
      result =
          phalanx_state_create(handle(kModel), one_in(3) ? NULL : handle(kScene), (phalanx_state**)&made);
      break;
    case 14:
      result = phalanx_state_set(handle(kState), text(), text());
      break;
    case 15:
      result = phalanx_state_get(handle(kState), text(), buffer, below(sizeof buffer + 1), &needed);
      break;
    case 16:
      result = phalanx_state_confirm_opening(handle(kState), (int32_t)below(7) - 1);
      break;
    case 17:
      result = phalanx_state_withdraw_openings(handle(kState));
      break;
    case 18: {
      phalanx_contact_point point = {.struct_size = size_like(sizeof point)};
      result =
          phalanx_state_get_contact_point(handle(kState), (int32_t)any() % 90, one_in(9) ? NULL : &point);
      break;
    }
    case 19: {
      phalanx_pose pose;
      for (int i = 0; i < 9; ++i) pose.rotation[i] = number();
      result = phalanx_pose_get_quaternion(one_in(9) ? NULL : &pose, one_in(9) ? NULL : numbers);
      break;
    }
    case 20:
      kind = kRecorder;
      result = phalanx_recorder_create(handle(kState), one_in(4) ? "/dev/null/a.mcap" : text(),
                                       (phalanx_recorder**)&made);
      break;
    case 21:
      kind = kRecording;
      result = phalanx_recording_open(text(), number(), number(), (phalanx_recording**)&made);
      break;
    case 22:
      result = phalanx_recorder_add(handle(kRecorder));
      break;
    case 23: {
      phalanx_recorded_step recorded = {.struct_size = size_like(sizeof recorded)};
      result = phalanx_recording_get_step(handle(kRecording), any(), &recorded);
      break;
    }
    case 24:
      result = one_in(2) ? phalanx_state_destroy(handle(kState)) : phalanx_scene_destroy(handle(kScene));
      break;
    case 25:
      result = one_in(2) ? phalanx_model_destroy(handle(kModel)) : phalanx_motion_destroy(handle(kMotion));
      break;
    default: {
      void* const state = handle(kState);
      for (int i = 0; i < 8; ++i) {
        phalanx_sample sample = {
            .struct_size = size_like(sizeof sample), .has_channels = (uint32_t)below(2), .time_s = number()};
        for (int j = 0; j < PHALANX_JOINTS; ++j) sample.angle[j] = number();
        for (int j = 0; j < PHALANX_JOINTS; ++j) sample.measured_torque[j] = number();
        memset(sample.angle_origin, (int)below(256), sizeof sample.angle_origin);
        result = phalanx_step(state, one_in(20) ? NULL : &sample, one_in(2) ? NULL : &status);
      }
      phalanx_snapshot now = {.struct_size = sizeof now};
      if (phalanx_state_get_snapshot(state, &now) == PHALANX_OK) check_snapshot(&now);
      now.struct_size = size_like(sizeof now);
      result = phalanx_state_get_snapshot(state, one_in(9) ? NULL : &now);
    }
  }
  keep(kind, made);
  return result;
}

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  random_state = strtoull(argv[1], NULL, 10) * 2 + 1;
  const long count = strtol(argv[2], NULL, 10);
  long results[10] = {0};
  for (long i = 0; i < count; ++i) {
    const phalanx_result result = call();
    CHECK(result >= PHALANX_OK && result < PHALANX_ERROR_INTERNAL);
    if (result >= PHALANX_OK && result <= PHALANX_ERROR_INTERNAL) ++results[result];
    if (result != PHALANX_OK) CHECK(strlen(phalanx_error_text()) > 3 && strlen(phalanx_error_text()) < 2048);
  }
  for (int r = 0; r < 10; ++r) printf("%-24s %ld\n", phalanx_result_name(r), results[r]);
  // The calls reach what they are meant to reach.
  for (int r = PHALANX_OK; r <= PHALANX_ERROR_NOT_NOW; ++r) CHECK(results[r] > 0);
  return failures();
}
