// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include "c_api/objects.h"
#include "c_api/samples.h"
#include "phalanx/scene/build_model.h"

using namespace phalanx::c_api;

phalanx_result phalanx_motion_create(const phalanx_scene* scene, phalanx_motion** motion) {
  const auto* const object = object_of<Scene>(scene);
  if (object == nullptr) return wrong_handle("scene");
  if (motion == nullptr) return null_argument("motion");
  return guarded([&] {
    auto timed = std::make_unique<TimedMotion>();
    timed->motion = phalanx::build_motion(object->read.scene);
    timed->seconds = phalanx::simulation_seconds(object->read.scene, timed->motion);
    make_handle(std::move(timed), motion);
    return PHALANX_OK;
  });
}

phalanx_result phalanx_motion_get_seconds(const phalanx_motion* motion, double* seconds) {
  const auto* const object = object_of<TimedMotion>(motion);
  if (object == nullptr) return wrong_handle("motion");
  if (seconds == nullptr) return null_argument("seconds");
  *seconds = object->seconds;
  return PHALANX_OK;
}

phalanx_result phalanx_motion_get_sample(const phalanx_motion* motion, double time_s,
                                         phalanx_sample* sample) {
  const auto* const object = object_of<TimedMotion>(motion);
  if (object == nullptr) return wrong_handle("motion");
  phalanx_sample full = empty_sample();
  full.has_channels = 1;
  full.time_s = time_s;
  const phalanx::JointArray angle = object->motion.at(time_s);
  std::copy(angle.begin(), angle.end(), full.angle);
  std::transform(object->motion.angle_origin.begin(), object->motion.angle_origin.end(), full.angle_origin,
                 [](phalanx::AngleOrigin origin) { return static_cast<std::uint8_t>(origin); });
  return write_struct(full, kSmallestSample, sample, "phalanx_sample");
}

phalanx_result phalanx_motion_destroy(phalanx_motion* motion) {
  return destroy<TimedMotion>(motion, "motion");
}
