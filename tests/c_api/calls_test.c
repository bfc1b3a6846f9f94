// SPDX-License-Identifier: Apache-2.0
// calls_test CASE: the C interface from plain C99: names, scenes, models, steps.
#include <math.h>
#include <string.h>

#include "c_api/box.h"
#include "c_api/checks.h"

// ---- names and numbers that programs have compiled in

static void names(void) {
  CHECK(strcmp(phalanx_version(), PHALANX_VERSION) == 0);
  CHECK(strcmp(phalanx_digit_name(0), "thumb") == 0 && strcmp(phalanx_digit_name(4), "little") == 0);
  CHECK(strcmp(phalanx_joint_name(4), "index_mcp_flexion") == 0);
  CHECK(strcmp(phalanx_segment_name(5), "index-finger-phalanx-distal") == 0);
  CHECK(strcmp(phalanx_status_name(4), "start_inside") == 0 &&
        strcmp(phalanx_status_name(13), "oscillating") == 0);
  CHECK(strcmp(phalanx_result_name(PHALANX_ERROR_INTERNAL), "PHALANX_ERROR_INTERNAL") == 0);
  for (int32_t out = -1; out < 50; out += 51) {
    CHECK(phalanx_digit_name(out) == NULL && phalanx_joint_name(out) == NULL);
    CHECK(phalanx_segment_name(out) == NULL && phalanx_status_name(out) == NULL);
    CHECK(strcmp(phalanx_result_name(out), "unknown") == 0);
  }
  CHECK(strcmp(phalanx_error_text(), "") == 0);
}

static void numbers(void) {
  const int results[] = {
      PHALANX_OK,           PHALANX_ERROR_NULL,    PHALANX_ERROR_HANDLE,  PHALANX_ERROR_SIZE,
      PHALANX_ERROR_INDEX,  PHALANX_ERROR_REFUSED, PHALANX_ERROR_NOT_NOW, PHALANX_ERROR_FAILED,
      PHALANX_ERROR_MEMORY, PHALANX_ERROR_INTERNAL};
  for (int i = 0; i < 10; ++i) CHECK(results[i] == i);
  const int bits[] = {PHALANX_STATUS_SAMPLE_NOT_FINITE,  PHALANX_STATUS_SAMPLE_OUT_OF_RANGE,
                      PHALANX_STATUS_SAMPLE_JUMP,        PHALANX_STATUS_TIME_NOT_INCREASING,
                      PHALANX_STATUS_START_INSIDE,       PHALANX_STATUS_SLID,
                      PHALANX_STATUS_SEARCH_EXHAUSTED,   PHALANX_STATUS_FORCE_LIMITED,
                      PHALANX_STATUS_TORQUE_LIMITED,     PHALANX_STATUS_TORQUE_RATE_LIMITED,
                      PHALANX_STATUS_COMMAND_NOT_FINITE, PHALANX_STATUS_TRAJECTORY_EXHAUSTED,
                      PHALANX_STATUS_SAMPLE_STALE,       PHALANX_STATUS_OSCILLATING};
  for (int i = 0; i < 14; ++i) CHECK(bits[i] == 1 << i);
  CHECK(PHALANX_MESH_SEGMENT == 0 && PHALANX_MESH_DISPLAY == 1 && PHALANX_MESH_OBJECTS == 2);
  CHECK(PHALANX_ORIGIN_UNKNOWN == 0 && PHALANX_ORIGIN_MEASURED == 1 && PHALANX_ORIGIN_COMPLETED == 2);
  CHECK(PHALANX_ORIGIN_FIXED == 3 && PHALANX_ORIGIN_SCRIPTED == 4);
  CHECK(PHALANX_OPENING_NONE == 0 && PHALANX_OPENING_UNCONFIRMED == 1);
  CHECK(PHALANX_OPENING_CONFIRMED == 2 && PHALANX_OPENING_NOT_FOLLOWED == 3);
  CHECK(PHALANX_DIGITS == 5 && PHALANX_JOINTS == 20 && PHALANX_SEGMENTS == 16);
}

// ---- scenes

static void scenes(void) {
  phalanx_scene* scene = NULL;
  char text[64] = "before";
  size_t needed = 0;
  GOOD(phalanx_scene_load("press_teapot", &scene));
  GOOD(phalanx_scene_set(scene, "force.stiffness_n_per_mm", "0.75"));
  GOOD(phalanx_scene_get(scene, "force.stiffness_n_per_mm", text, sizeof text, &needed));
  CHECK(strcmp(text, "0.75") == 0 && needed == 5);
  FAILS(PHALANX_ERROR_REFUSED, "force.stiffness_n_per_mm",
        phalanx_scene_set(scene, "force.stiffness_n_per_mm", "-1"));
  GOOD(phalanx_scene_get(scene, "force.stiffness_n_per_mm", text, sizeof text, NULL));
  CHECK(strcmp(text, "0.75") == 0);  // as before
  GOOD(phalanx_scene_set(scene, "force.stiffness_n_per_mm", ""));
  GOOD(phalanx_scene_get(scene, "force.stiffness_n_per_mm", text, sizeof text, NULL));
  CHECK(strcmp(text, "0.75") != 0);
  GOOD(phalanx_scene_get(scene, "objects.0.kind", NULL, 0, &needed));
  CHECK(needed == sizeof "\"teapot\"");
  FAILS(PHALANX_ERROR_SIZE, "fit", phalanx_scene_get(scene, "objects.0.kind", text, 3, &needed));
  FAILS(PHALANX_ERROR_REFUSED, "did you mean \"force.law\"",
        phalanx_scene_get(scene, "force.lav", text, 9, NULL));
  FAILS(PHALANX_ERROR_REFUSED, "force.law", phalanx_scene_set(scene, "force.lav", "\"hooke\""));
  FAILS(PHALANX_ERROR_REFUSED, "1 objects", phalanx_scene_get(scene, "objects.7.kind", text, 9, NULL));
  GOOD(phalanx_scene_destroy(scene));
  FAILS(PHALANX_ERROR_HANDLE, "scene", phalanx_scene_destroy(scene));
  FAILS(PHALANX_ERROR_HANDLE, "scene", phalanx_scene_get(scene, "force.law", text, sizeof text, NULL));

  scene = NULL;
  FAILS(PHALANX_ERROR_REFUSED, "there is no", phalanx_scene_load("no_such_scene", &scene));
  FAILS(PHALANX_ERROR_REFUSED, "scene:2", phalanx_scene_parse("rate_hz = 500\nrate_khz = 1\n", NULL, &scene));
  CHECK(scene == NULL);
  GOOD(phalanx_scene_parse("", NULL, &scene));
  GOOD(phalanx_scene_get(scene, "force.law", text, sizeof text, NULL));
  CHECK(strcmp(text, "\"hooke\"") == 0);  // the key's default
  GOOD(phalanx_scene_destroy(scene));
  GOOD(phalanx_scene_destroy(NULL));
}

// ---- models from arrays

static void models(void) {
  phalanx_model* model = box_model();
  phalanx_model_info info = {.struct_size = sizeof info};
  GOOD(phalanx_model_get_info(model, &info));
  CHECK(info.left == 0 && info.object_triangles == 12 && info.hand_triangles > 1500);
  CHECK(info.max_angle[4] > 1.0 && info.open_angle[4] == 0.0 && info.palm.rotation[0] == 1.0);
  phalanx_mesh mesh = {.struct_size = sizeof mesh};
  GOOD(phalanx_model_get_mesh(model, PHALANX_MESH_OBJECTS, 0, &mesh));
  CHECK(mesh.vertex_count == 8 && mesh.triangle_count == 12);
  CHECK(memcmp(mesh.vertices, kBox, sizeof kBox) == 0);
  CHECK(memcmp(mesh.triangles, kBoxTriangles, sizeof kBoxTriangles) == 0);
  size_t triangles = 0;
  for (int s = 0; s < PHALANX_SEGMENTS; ++s) {
    GOOD(phalanx_model_get_mesh(model, PHALANX_MESH_SEGMENT, s, &mesh));
    triangles += (size_t)mesh.triangle_count;
    for (uint64_t i = 0; i < 3 * mesh.triangle_count; ++i)
      CHECK(mesh.triangles[i] >= 0 && (uint64_t)mesh.triangles[i] < mesh.vertex_count);
  }
  CHECK(triangles == info.hand_triangles);
  FAILS(PHALANX_ERROR_INDEX, "mesh", phalanx_model_get_mesh(model, PHALANX_MESH_SEGMENT, 16, &mesh));
  FAILS(PHALANX_ERROR_INDEX, "mesh", phalanx_model_get_mesh(model, 3, 0, &mesh));
  GOOD(phalanx_model_destroy(model));

  // A left hand, 200 mm long, turned half about z: the finger's tip points to +z of H still, but x and y
  // change sign.
  phalanx_hand hand = {.struct_size = sizeof hand, .left = 1, .length = 0.2};
  hand.pose.rotation[0] = hand.pose.rotation[4] = -1.0;
  hand.pose.rotation[8] = 1.0;
  GOOD(phalanx_model_create_from_mesh(&hand, NULL, 0, NULL, 0, &model));
  GOOD(phalanx_model_get_info(model, &info));
  CHECK(info.left == 1 && info.object_triangles == 0 && info.palm.rotation[0] == -1.0);
  GOOD(phalanx_model_destroy(model));

  const double nan_vertex[] = {0, 0, 0, 1, 0, 0, 0, kNan, 0};
  const int32_t triangle[] = {0, 1, 2};
  const int32_t beyond[] = {0, 1, 3};
  FAILS(PHALANX_ERROR_REFUSED, "finite",
        phalanx_model_create_from_mesh(NULL, nan_vertex, 3, triangle, 1, &model));
  FAILS(PHALANX_ERROR_REFUSED, "", phalanx_model_create_from_mesh(NULL, kBox, 3, beyond, 1, &model));
  FAILS(PHALANX_ERROR_REFUSED, "", phalanx_model_create_from_mesh(NULL, kBox, 8, NULL, 0, &model));
  FAILS(PHALANX_ERROR_NULL, "vertices", phalanx_model_create_from_mesh(NULL, NULL, 8, triangle, 1, &model));
  FAILS(PHALANX_ERROR_REFUSED, "at most",
        phalanx_model_create_from_mesh(NULL, kBox, SIZE_MAX, triangle, 1, &model));
  hand.pose.rotation[8] = 2.0;
  FAILS(PHALANX_ERROR_REFUSED, "rotation", phalanx_model_create_from_mesh(&hand, NULL, 0, NULL, 0, &model));
  hand.pose.rotation[8] = 1.0;
  hand.length = kNan;
  FAILS(PHALANX_ERROR_REFUSED, "length", phalanx_model_create_from_mesh(&hand, NULL, 0, NULL, 0, &model));
}

// ---- the step

static void step(void) {
  phalanx_model* model = box_model();
  phalanx_state* state = box_state(model);
  GOOD(phalanx_model_destroy(model));  // the state keeps what it needs
  phalanx_snapshot now = {.struct_size = sizeof now};
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.tick == 0 && now.torque[4] == 0.0);
  bend(state, 0, 160);
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.tick == 160 && now.time_s == 159 / 200.0 && now.hcp_angle[4] == 159 / 200.0);
  CHECK(now.gdp_angle[4] < now.hcp_angle[4] - 0.1);  // the box holds the shown finger back
  CHECK(now.torque[4] < -0.01);                      // and pushes it open
  const phalanx_segment* tip = &now.segment[5];
  CHECK(tip->contact == 1 && tip->force > 0.1 && fabs(tip->normal[1] - 1.0) < 0.02);  // the top faces +y
  CHECK(fabs(tip->point[1] + 0.02) < 0.2e-3);                                         // within the margin
  CHECK(now.digit_force[1][1] == tip->force * tip->normal[1] + tip->friction[1] ||
        now.segment[4].contact == 1);
  CHECK(now.digit_force[0][1] == 0.0 && now.contact_points == 0 && now.stiffness == 500.0);
  CHECK(isnan(now.measured_torque[0]) && now.angle_origin[4] == PHALANX_ORIGIN_UNKNOWN);
  double q[4];
  GOOD(phalanx_pose_get_quaternion(&now.gdp_pose[5], q));
  CHECK(fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0) < 1e-12 && q[3] >= 0.0);

  // A smaller struct of an older program: only its part is written.
  phalanx_snapshot old;
  memset(&old, 0x5a, sizeof old);
  old.struct_size = 184;
  GOOD(phalanx_state_get_snapshot(state, &old));
  CHECK(memcmp(old.torque, now.torque, sizeof old.torque) == 0 && old.struct_size == 184);
  const unsigned char* after = (const unsigned char*)old.hcp_angle;
  for (size_t i = 0; i < sizeof old - 184; ++i) CHECK(after[i] == 0x5a);
  for (uint32_t size = 0; size < 10000; size += size < 200 || size > 7700 ? 1 : 8) {
    const int allowed = size >= 184 && size <= sizeof old && size % 8 == 0;
    old.struct_size = size;
    CHECK(phalanx_state_get_snapshot(state, &old) == (allowed ? PHALANX_OK : PHALANX_ERROR_SIZE));
  }

  // An older sample has no channels; a step with them reports them.
  phalanx_sample sample = {.struct_size = 176, .has_channels = 1, .time_s = 1.0};
  sample.measured_force[1] = 3.0;
  GOOD(phalanx_step(state, &sample, NULL));
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(isnan(now.measured_force[1]));
  sample.struct_size = sizeof sample;
  sample.time_s = 1.1;
  sample.angle_origin[4] = PHALANX_ORIGIN_MEASURED;
  sample.angle_origin[5] = 99;
  uint32_t status = 0;
  GOOD(phalanx_step(state, &sample, &status));
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.measured_force[1] == 3.0 && now.angle_origin[4] == 1 && now.angle_origin[5] == 0);
  CHECK(status == now.status);
  GOOD(phalanx_step(state, &sample, &status));
  CHECK((status & PHALANX_STATUS_TIME_NOT_INCREASING) != 0);
  sample.struct_size = sizeof sample + 8;
  FAILS(PHALANX_ERROR_SIZE, "struct_size is 408", phalanx_step(state, &sample, NULL));
  GOOD(phalanx_state_destroy(state));

  model = NULL;
  const double closed[] = {-0.02, -0.03, -0.2, 0.06, -0.03, -0.2, 0.02, 0.05, -0.12};  // through the fingers
  const int32_t triangle[] = {0, 1, 2};
  GOOD(phalanx_model_create_from_mesh(NULL, closed, 3, triangle, 1, &model));
  FAILS(PHALANX_ERROR_REFUSED, "open hand", phalanx_state_create(model, NULL, &state));
  GOOD(phalanx_model_destroy(model));
}

// ---- parameters that change in contact, and others

static void parameters(void) {
  phalanx_model* model = box_model();
  phalanx_state* state = box_state(model);
  char text[64];
  phalanx_snapshot now = {.struct_size = sizeof now};
  GOOD(phalanx_state_set(state, "force.stiffness_n_per_mm", "1.0"));
  GOOD(phalanx_state_get(state, "force.stiffness_n_per_mm", text, sizeof text, NULL));
  CHECK(strcmp(text, "1.0") == 0 || strcmp(text, "1") == 0);
  bend(state, 0, 20);  // 0.1 s: half of the way
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.stiffness > 600.0 && now.stiffness < 900.0);
  bend(state, 20, 40);
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.stiffness == 1000.0);
  GOOD(phalanx_state_set(state, "stabiliser.method", "\"none\""));
  FAILS(PHALANX_ERROR_NOT_NOW, "new state", phalanx_state_set(state, "stabiliser.method", "\"passivity\""));
  FAILS(PHALANX_ERROR_NOT_NOW, "new state", phalanx_state_set(state, "force.law", "\"duffing\""));
  FAILS(PHALANX_ERROR_NOT_NOW, "new state", phalanx_state_set(state, "limits.joint_torque_nm", "0.1"));
  FAILS(PHALANX_ERROR_REFUSED, "force.stiffness_n_per_mm",
        phalanx_state_set(state, "force.stiffness_n_per_mm", "nan"));
  GOOD(phalanx_state_get(state, "force.law", text, sizeof text, NULL));
  CHECK(strcmp(text, "\"hooke\"") == 0);
  GOOD(phalanx_state_destroy(state));
  phalanx_scene* scene = NULL;
  double rate = 0.0;
  GOOD(phalanx_scene_parse("rate_hz = 1000\n[limits]\njoint_torque_nm = 0.02\n", NULL, &scene));
  GOOD(phalanx_state_create(model, scene, &state));
  GOOD(phalanx_state_get_rate(state, &rate));
  CHECK(rate == 1000.0);
  GOOD(phalanx_state_destroy(state));
  GOOD(phalanx_scene_destroy(scene));
  GOOD(phalanx_model_destroy(model));
}

// ---- openings: a first sample with the finger in the box

static void openings(void) {
  phalanx_model* model = box_model();
  phalanx_state* state = box_state(model);
  phalanx_snapshot now = {.struct_size = sizeof now};
  phalanx_sample sample = {.struct_size = sizeof sample};
  FAILS(PHALANX_ERROR_NOT_NOW, "inside", phalanx_state_confirm_opening(state, 1));
  for (int i = 0; i < 4; ++i) {
    sample.time_s = i / 200.0;
    sample.angle[4] = 0.8;
    GOOD(phalanx_step(state, &sample, NULL));
  }
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK((now.status & PHALANX_STATUS_START_INSIDE) != 0 && now.torque[4] == 0.0);
  CHECK(now.opening[1].phase == PHALANX_OPENING_UNCONFIRMED && now.opening[1].way > 1e-3);
  CHECK(now.opening[0].phase == PHALANX_OPENING_NONE);
  GOOD(phalanx_state_confirm_opening(state, 1));
  for (int i = 4; i < 60; ++i) {
    sample.time_s = i / 200.0;
    GOOD(phalanx_step(state, &sample, NULL));
  }
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.opening[1].phase == PHALANX_OPENING_CONFIRMED && now.torque[4] < 0.0 &&
        now.opening[1].force <= 1.0);
  GOOD(phalanx_state_withdraw_openings(state));
  sample.time_s = 60 / 200.0;
  GOOD(phalanx_step(state, &sample, NULL));
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.opening[1].phase == PHALANX_OPENING_UNCONFIRMED && now.segment[5].force == 0.0);
  FAILS(PHALANX_ERROR_INDEX, "0 .. 4", phalanx_state_confirm_opening(state, 5));
  GOOD(phalanx_state_destroy(state));
  GOOD(phalanx_model_destroy(model));
}

// ---- sliding mode: contact points

static void contact_points(void) {
  phalanx_model* model = box_model();
  phalanx_scene* scene = NULL;
  phalanx_state* state = NULL;
  GOOD(phalanx_scene_parse("[contact]\nmode = \"sliding\"\n", NULL, &scene));
  GOOD(phalanx_state_create(model, scene, &state));
  bend(state, 0, 160);
  phalanx_snapshot now = {.struct_size = sizeof now};
  GOOD(phalanx_state_get_snapshot(state, &now));
  CHECK(now.contact_points > 0);
  phalanx_contact_point point = {.struct_size = sizeof point};
  double along_y = 0.0;
  for (uint64_t i = 0; i < now.contact_points; ++i) {
    GOOD(phalanx_state_get_contact_point(state, (int32_t)i, &point));
    CHECK(point.segment >= 3 && point.segment <= 5 && point.normal[1] > 0.9 && point.force >= 0.0);
    along_y += point.force * point.normal[1] + point.friction[1];
  }
  CHECK(fabs(along_y - now.digit_force[1][1]) < 1e-6);  // the shares add up
  FAILS(PHALANX_ERROR_INDEX, "contact_points",
        phalanx_state_get_contact_point(state, (int32_t)now.contact_points, &point));
  FAILS(PHALANX_ERROR_INDEX, "contact_points", phalanx_state_get_contact_point(state, -1, &point));
  GOOD(phalanx_state_destroy(state));
  GOOD(phalanx_scene_destroy(scene));
  GOOD(phalanx_model_destroy(model));
}

int main(int argc, char** argv) {
  const char* name = argc > 1 ? argv[1] : "";
  if (strcmp(name, "names") == 0)
    names();
  else if (strcmp(name, "numbers") == 0)
    numbers();
  else if (strcmp(name, "scenes") == 0)
    scenes();
  else if (strcmp(name, "models") == 0)
    models();
  else if (strcmp(name, "step") == 0)
    step();
  else if (strcmp(name, "parameters") == 0)
    parameters();
  else if (strcmp(name, "openings") == 0)
    openings();
  else if (strcmp(name, "contact_points") == 0)
    contact_points();
  else
    return 2;
  return failures();
}
