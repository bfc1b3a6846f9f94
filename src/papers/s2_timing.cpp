// SPDX-License-Identifier: Apache-2.0
#include "papers/timing.h"

namespace phalanx {

TimingResult run_s2_timing() {
  SceneDescription scene = load_scene("grasp_teapot", {{"motion.repeat", "5"}, {"hand.meshes", "capsules"}});
  scene.hand.triangles = best_request(2248, hand_triangles, scene);
  scene.objects.front().triangles = best_request(992, object_triangles, scene);
  TimingResult result{.name = "s2-timing",
                      .what = "the whole hand grasps a teapot",
                      .paper_triangles = "2,248 of the hand, 992 of the object",
                      .paper_time = "not printed (Core i7 870)",
                      .runs = {}};
  run_timing(scene, result);
  return result;
}

}  // namespace phalanx
