// SPDX-License-Identifier: Apache-2.0
// files_test CASE FOLDER: the C interface from plain C99: recordings, trials, and handles that are none.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "c_api/box.h"
#include "c_api/checks.h"

// ---- a closed-loop trial

static void trial(void) {
  phalanx_scene* scene = NULL;
  GOOD(phalanx_scene_load("stability_press", &scene));
  const phalanx_trial stiff = {.struct_size = sizeof stiff, .seed = 3, .stiffness = 3000.0, .press = kNan};
  const phalanx_trial soft = {.struct_size = sizeof soft, .seed = 3, .stiffness = 300.0, .press = kNan};
  phalanx_trial_result first = {.struct_size = sizeof first};
  phalanx_trial_result second = {.struct_size = sizeof second};
  phalanx_trial_result third = {.struct_size = sizeof third};
  GOOD(phalanx_trial_run(scene, &soft, &first));
  GOOD(phalanx_trial_run(scene, &soft, &second));
  GOOD(phalanx_trial_run(scene, &stiff, &third));
  CHECK(memcmp(&first, &second, sizeof first) == 0 && first.valid == 1 && first.stable == 1);
  CHECK(first.mean_force > 0.1 && first.why_invalid[0] == '\0');
  CHECK(third.force_swing > first.force_swing && third.peak_depth < first.peak_depth);

  const double stiffnesses[] = {0.0, -1.0, 1.1e5, kEndless};
  for (size_t i = 0; i < sizeof stiffnesses / sizeof stiffnesses[0]; ++i) {
    const phalanx_trial wrong = {.struct_size = sizeof wrong, .stiffness = stiffnesses[i], .press = kNan};
    FAILS(PHALANX_ERROR_REFUSED, "stiffness: must be > 0", phalanx_trial_run(scene, &wrong, &third));
  }
  const double presses[] = {-1.0, 1001.0, kEndless};
  for (size_t i = 0; i < sizeof presses / sizeof presses[0]; ++i) {
    const phalanx_trial wrong = {.struct_size = sizeof wrong, .stiffness = kNan, .press = presses[i]};
    FAILS(PHALANX_ERROR_REFUSED, "press: must be 0 .. 1000", phalanx_trial_run(scene, &wrong, &third));
  }
  GOOD(phalanx_scene_destroy(scene));
}

// ---- handles that are none

static void handles(void) {
  phalanx_model* model = box_model();
  phalanx_state* state = box_state(model);
  double number = 0.0;
  FAILS(PHALANX_ERROR_HANDLE, "state", phalanx_state_get_rate((phalanx_state*)(void*)model, &number));
  FAILS(PHALANX_ERROR_HANDLE, "model", phalanx_model_destroy((phalanx_model*)(void*)state));
  FAILS(PHALANX_ERROR_HANDLE, "state", phalanx_state_get_rate((phalanx_state*)(void*)&number, &number));
  FAILS(PHALANX_ERROR_HANDLE, "state", phalanx_state_get_rate(NULL, &number));
  GOOD(phalanx_state_destroy(state));
  FAILS(PHALANX_ERROR_HANDLE, "state", phalanx_state_get_rate(state, &number));
  phalanx_state* next = box_state(model);  // perhaps in the same slot
  FAILS(PHALANX_ERROR_HANDLE, "destroyed", phalanx_state_get_rate(state, &number));
  GOOD(phalanx_state_get_rate(next, &number));
  GOOD(phalanx_state_destroy(next));
  GOOD(phalanx_model_destroy(model));

  // All slots, and one more.
  static phalanx_scene* scenes_made[65536];
  int count = 0;
  phalanx_scene* last = NULL;
  while (count < 65536 && phalanx_scene_parse("", NULL, &scenes_made[count]) == PHALANX_OK) ++count;
  CHECK(count == 65536);
  FAILS(PHALANX_ERROR_FAILED, "65536 handles", phalanx_scene_parse("", NULL, &last));
  CHECK(last == NULL);
  for (int i = 0; i < count; ++i) CHECK(phalanx_scene_destroy(scenes_made[i]) == PHALANX_OK);
}

// ---- recordings

static void recordings(const char* folder) {
  char path[512];
  snprintf(path, sizeof path, "%s/c_api.mcap", folder);
  remove(path);
  phalanx_model* model = box_model();
  phalanx_state* state = box_state(model);
  phalanx_recorder* recorder = NULL;
  phalanx_recorder* second = NULL;
  FAILS(PHALANX_ERROR_REFUSED, ".mcap", phalanx_recorder_create(state, "recording.txt", &recorder));
  FAILS(PHALANX_ERROR_FAILED, "cannot be written",
        phalanx_recorder_create(state, "/no/folder/a.mcap", &recorder));
  GOOD(phalanx_recorder_create(state, path, &recorder));
  FAILS(PHALANX_ERROR_NOT_NOW, "recorder already", phalanx_recorder_create(state, path, &second));
  FAILS(PHALANX_ERROR_NOT_NOW, "recorder before", phalanx_state_destroy(state));
  FAILS(PHALANX_ERROR_NOT_NOW, "no step", phalanx_recorder_add(recorder));
  phalanx_sample sample = {.struct_size = sizeof sample, .has_channels = 1};
  for (int j = 0; j < PHALANX_JOINTS; ++j) sample.measured_torque[j] = kNan;
  for (int d = 0; d < PHALANX_DIGITS; ++d) sample.measured_force[d] = kNan;
  double torque = 0.0;
  phalanx_snapshot now = {.struct_size = sizeof now};
  for (int i = 0; i < 300; ++i) {
    sample.time_s = 5.0 + i / 200.0;
    sample.angle[4] = i < 150 ? i / 200.0 : (300 - i) / 200.0;
    sample.angle[0] = i == 77 ? kNan : 0.0;
    if (i == 100) GOOD(phalanx_state_set(state, "force.stiffness_n_per_mm", "0.8"));
    if (i == 120) GOOD(phalanx_state_set(state, "smoothing.max_n_per_s", "30"));
    GOOD(phalanx_step(state, &sample, NULL));
    GOOD(phalanx_recorder_add(recorder));
    if (i == 60) GOOD(phalanx_recorder_event(recorder, "marker", "half \xc3\xa4\xff"));
    if (i == 149) {
      GOOD(phalanx_state_get_snapshot(state, &now));
      torque = now.torque[4];
    }
  }
  CHECK(torque < -0.01);
  GOOD(phalanx_recorder_finish(recorder));
  FAILS(PHALANX_ERROR_NOT_NOW, "finished", phalanx_recorder_event(recorder, "late", ""));
  GOOD(phalanx_step(state, &sample, NULL));
  FAILS(PHALANX_ERROR_NOT_NOW, "finished", phalanx_recorder_add(recorder));
  GOOD(phalanx_recorder_destroy(recorder));
  FAILS(PHALANX_ERROR_NOT_NOW, "first one", phalanx_recorder_create(state, path, &recorder));
  GOOD(phalanx_state_destroy(state));

  phalanx_recording* recording = NULL;
  phalanx_recording_info info = {.struct_size = sizeof info};
  phalanx_recorded_step step = {.struct_size = sizeof step};
  GOOD(phalanx_recording_open(path, 0.0, kEndless, &recording));
  GOOD(phalanx_recording_get_info(recording, &info));
  CHECK(info.exact == 1 && info.steps == 300 && info.compared == 300 && info.different == 0 &&
        info.missing == 0);
  CHECK(info.rate_hz == 200.0 && strcmp(info.scene, "arrays") == 0);
  GOOD(phalanx_recording_get_step(recording, 149, &step));
  CHECK(step.tick == 150 && step.torque[4] == torque && fabs(step.time_s - 149 / 200.0) < 1e-6);
  CHECK(step.stiffness > 700.0 && step.hcp_angle[4] == 149 / 200.0 && step.gdp_angle[4] < step.hcp_angle[4]);
  FAILS(PHALANX_ERROR_INDEX, "steps", phalanx_recording_get_step(recording, 300, &step));
  GOOD(phalanx_recording_destroy(recording));
  GOOD(phalanx_recording_open(path, 0.5, 1.0, &recording));
  GOOD(phalanx_recording_get_info(recording, &info));
  CHECK(info.steps == 100 && info.compared == 300);
  GOOD(phalanx_recording_destroy(recording));
  FAILS(PHALANX_ERROR_FAILED, "", phalanx_recording_open("/no/such.mcap", 0.0, 1.0, &recording));
  recording = NULL;
  FAILS(PHALANX_ERROR_REFUSED, "from_s = nan: must be", phalanx_recording_open(path, kNan, 1.0, &recording));
  FAILS(PHALANX_ERROR_REFUSED, "to_s = nan: must be", phalanx_recording_open(path, 0.0, kNan, &recording));
  CHECK(recording == NULL);

  // Steps that are left out are stated, and are no difference.
  state = box_state(model);
  snprintf(path, sizeof path, "%s/gap.mcap", folder);
  remove(path);
  GOOD(phalanx_recorder_create(state, path, &recorder));
  bend(state, 0, 10);
  GOOD(phalanx_recorder_add(recorder));
  GOOD(phalanx_recorder_finish(recorder));
  GOOD(phalanx_recorder_destroy(recorder));
  GOOD(phalanx_state_destroy(state));
  GOOD(phalanx_recording_open(path, 0.0, kEndless, &recording));
  GOOD(phalanx_recording_get_info(recording, &info));
  CHECK(info.missing == 9 && info.compared == 0 && info.different == 0);
  GOOD(phalanx_recording_destroy(recording));
  GOOD(phalanx_model_destroy(model));
}

int main(int argc, char** argv) {
  const char* name = argc > 1 ? argv[1] : "";
  if (strcmp(name, "trial") == 0)
    trial();
  else if (strcmp(name, "handles") == 0)
    handles();
  else if (strcmp(name, "recordings") == 0 && argc > 2)
    recordings(argv[2]);
  else
    return 2;
  return failures();
}
