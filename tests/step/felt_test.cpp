// SPDX-License-Identifier: Apache-2.0
// What is felt of an object that the measured hand (HCP) is in: a digit that penetrates has a force, and no
// force jumps. Whether the HCP penetrates is decided without the search: by FCL's collision of the surfaces
// and by winding numbers.
//
// PHALANX_FELT_MOTIONS=FILE.csv[:FILE.csv...] plays recordings of a glove (assets/mappings/cyberglove.toml,
// every trial), before each mesh file of PHALANX_FELT_MESHES=FILE[:FILE...], in several sizes and poses.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <sstream>

#include "contact/containment.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_law.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene.h"
#include "support/human_motion.h"
#include "support/reference/fcl_oracle.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

/// What was felt over one motion, or over several.
struct Felt {
  int runs = 0;
  int ticks = 0;
  int contacts = 0;      ///< ticks of a digit that pushes
  int unfelt = 0;        ///< ticks in which a digit penetrates, and neither is pushed nor started inside
  int start_inside = 0;  ///< ticks in which a digit started inside
  int jumping = 0;       ///< runs with a step of a force above 1 N
  double step = 0.0;     ///< the largest step of a segment's force in one tick [N]
  double excess = 0.0;   ///< the most by which a rise exceeds what the segment's own way explains [N]

  void add(const Felt& other) {
    runs += other.runs;
    ticks += other.ticks;
    contacts += other.contacts;
    unfelt += other.unfelt;
    start_inside += other.start_inside;
    jumping += other.jumping;
    step = std::max(step, other.step);
    excess = std::max(excess, other.excess);
  }
  void print(const std::string& name) const {
    std::printf(
        "%s: %d runs, %d ticks, %d of digits that push, %d unfelt, %d start_inside; %d runs with a step "
        "above "
        "1 N, largest %.2f N, beyond the segment's way %.2f N\n",
        name.c_str(), runs, ticks, contacts, unfelt, start_inside, jumping, step, excess);
  }
};

/// Plays angles through the contacts and the force law of a scene, tick by tick.
class Player {
 public:
  Player(const HapticModel& model, const HapticParameters& parameters)
      : model_(model),
        law_(parameters.force),
        contact_{model.hand, model.trees(), model.object, parameters.contact},
        gdp_(contact_),
        object_(model.object.mesh()),
        containment_(model.object.mesh()) {
    for (int s = 0; s < kPalm; ++s) segment_.emplace_back(model.hand.mesh(s));
    measured_.fill(true);
    felt.runs = 1;
  }

  void tick(const JointArray& hcp) {
    const JointArray before = felt.ticks == 0 ? hcp : gdp_.hcp_angle;
    model_.hand.poses(hcp, poses_);
    advance_gdp(contact_, hcp, poses_, measured_, gdp_);
    ++felt.ticks;
    bool started_inside = false;
    for (int d = 0; d < kDigits; ++d) {
      started_inside = started_inside || gdp_.inside[idx(d)];
      double pushed = 0.0;
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        const int s = segment_index(d, k);
        const ContactRecord& record = gdp_.record[idx(s)];
        const double force = record.active && !record.silent ? law_force(law_, record.depth, 0.0) : 0.0;
        const double rise = force - force_[idx(s)];
        force_[idx(s)] = force;
        pushed = std::max(pushed, force);
        felt.step = std::max(felt.step, std::abs(rise));
        if (rise > std::max(felt.excess, 1e-3)) {
          const double explained = kMostSlope * law_.stiffness * way(d, k, before, hcp);
          felt.excess = std::max(felt.excess, rise - explained);
        }
      }
      felt.contacts += pushed > 0.0 ? 1 : 0;
      if (pushed == 0.0 && !gdp_.inside[idx(d)] && penetrates(d)) ++felt.unfelt;
    }
    felt.start_inside += started_inside ? 1 : 0;
    felt.jumping = felt.step > 1.0 ? 1 : 0;
  }

  Felt felt;

 private:
  /// Of the depth, for each length that the segment goes: 1, and 0.2 while a d0 fades, of a depth that is
  /// counted along the way and that 1.25 bounds.
  static constexpr double kMostSlope = 1.2 * 1.25;

  /// Whether a segment of the digit at its measured angles crosses or lies in the object. The shown hand
  /// never does: where it stands at these angles, nothing need be asked.
  [[nodiscard]] bool penetrates(int d) const {
    if (digit_angles(gdp_.angle, d) == digit_angles(gdp_.hcp_angle, d)) return false;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const int s = segment_index(d, k);
      const Pose& X = poses_.digit[idx(d)].segment[idx(k)];
      if (segment_[idx(s)].collides(X, object_) || containment_.with(model_.hand.mesh(s), X)) return true;
    }
    return false;
  }

  /// The way of the segment's fastest vertex between two ticks' measured angles, along eight chords [m].
  [[nodiscard]] double way(int d, int k, const JointArray& from, const JointArray& to) const {
    constexpr int kChords = 8;
    const std::vector<Vec3>& vertices = model_.hand.mesh(segment_index(d, k)).vertices;
    std::vector<double> length(vertices.size(), 0.0);
    DigitPose last;
    model_.hand.digit_pose(d, digit_angles(from, d), last);
    for (int n = 1; n <= kChords; ++n) {
      DigitAngles q = digit_angles(from, d);
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += (digit_angles(to, d)[i] - q[i]) * n / kChords;
      DigitPose now;
      model_.hand.digit_pose(d, q, now);
      for (std::size_t v = 0; v < vertices.size(); ++v)
        length[v] += (now.segment[idx(k)] * vertices[v] - last.segment[idx(k)] * vertices[v]).norm();
      last = now;
    }
    return *std::max_element(length.begin(), length.end());
  }

  const HapticModel& model_;
  const ForceLawParameters& law_;
  ContactModel contact_;
  GdpState gdp_;
  test::FclMesh object_;
  Containment containment_;
  std::vector<test::FclMesh> segment_;
  std::array<bool, kDigits> measured_{};
  std::array<double, kSegments> force_{};
  HandPoses poses_;
};

JointArray clamped(JointArray q, const HandParameters& hand) {
  for (std::size_t j = 0; j < kJoints; ++j) q[j] = std::clamp(q[j], hand.min_angle[j], hand.max_angle[j]);
  return q;
}

std::vector<std::string> split(const char* list) {
  std::vector<std::string> out;
  std::stringstream in(list == nullptr ? "" : list);
  for (std::string item; std::getline(in, item, ':');) out.push_back(item);
  return out;
}

/// The scene's model with its object lowered out of the open hand, as far as it takes; none within 80 mm.
std::optional<HapticModel> clear_of_the_open_hand(SceneDescription scene) {
  const Vec3 at = scene.objects.front().pose.p;
  for (int n = 0; n <= 40; ++n) {
    scene.objects.front().pose.p = at + Vec3(0.0, 2e-3 * n, 0.0);
    HapticModel model = build_model(scene);
    try {
      const GdpState state({model.hand, model.trees(), model.object, scene.parameters.contact});
    } catch (const std::invalid_argument&) {
      continue;
    }
    return model;
  }
  return std::nullopt;
}

/// The motion of the scene, tick by tick.
Felt play(const HapticModel& model, const SceneDescription& scene, const std::string& name) {
  SCOPED_TRACE(name);
  const Motion motion = build_motion(scene);
  Player player(model, scene.parameters);
  const int ticks = static_cast<int>(motion.duration() * scene.parameters.rate_hz);
  for (int n = 0; n <= ticks; ++n)
    player.tick(clamped(motion.at(n / scene.parameters.rate_hz), model.hand.parameters()));
  player.felt.print(name);
  return player.felt;
}

/// How many trials a recording holds.
int trials_of(SceneDescription scene) {
  for (int n = 1;; ++n) {
    scene.motion.trial = n;
    try {
      static_cast<void>(build_motion(scene));
    } catch (const SceneError&) {
      return n - 1;
    }
  }
}

void expect_felt(const Felt& all) {
  all.print("all");
  EXPECT_GT(all.contacts, 1000) << "the motions are there to touch something";
  EXPECT_EQ(all.unfelt, 0);
  EXPECT_LE(all.excess, 1e-6) << "a force jumped";
}

TEST(GdpFelt, WhatPenetratesIsFeltAndNoForceJumpsOverRecordingsGivenByHand) {
  const std::vector<std::string> motions = split(std::getenv("PHALANX_FELT_MOTIONS"));
  const std::vector<std::string> meshes = split(std::getenv("PHALANX_FELT_MESHES"));
  if (motions.empty() || meshes.empty())
    GTEST_SKIP() << "PHALANX_FELT_MOTIONS or PHALANX_FELT_MESHES names no file";
  Felt all;
  for (const std::string& mesh : meshes) {
    for (const int size : {60, 90, 120}) {
      for (const char* turned : {"[0, 0, 0]", "[90, 0, 40]", "[90, 0, 200]"}) {
        SceneDescription scene = load_scene("grasp_cup", {{"objects", "[{ kind = \"file\", size_mm = 60 }]"},
                                                          {"objects.0.file", "\"" + mesh + "\""},
                                                          {"objects.0.size_mm", std::to_string(size)},
                                                          {"objects.0.rotation_deg", turned},
                                                          {"motion.mapping", "\"cyberglove\""},
                                                          {"grasp.type", "\"none\""}});
        const std::optional<HapticModel> model = clear_of_the_open_hand(scene);
        if (!model) continue;
        for (const std::string& file : motions) {
          scene.motion.file = file;
          const int trials = trials_of(scene);
          EXPECT_GT(trials, 0) << file;
          for (int trial = 1; trial <= trials; ++trial) {
            scene.motion.trial = trial;
            all.add(play(*model, scene,
                         mesh + " of " + std::to_string(size) + " mm at " + turned + ", " + file +
                             ", trial " + std::to_string(trial)));
          }
        }
      }
    }
  }
  expect_felt(all);
}

constexpr std::array<const char*, 4> kScenes = {"grasp_teapot", "grasp_mug", "grasp_torus", "grasp_cup"};

TEST(GdpFelt, WhatPenetratesIsFeltAndNoForceJumpsOverTheScenesMotionsAndAGlove) {
  Felt all;
  for (const char* name : kScenes) {
    SceneDescription scene = load_scene(name, {{"objects.0.triangles", "1000"}, {"grasp.type", "none"}});
    const HapticModel model = build_model(scene);
    all.add(play(model, scene, name));
    scene.motion.file = data_folder() / "assets/motions/glove_two_trials.csv";
    scene.motion.mapping = "cyberglove";
    for (const int trial : {1, 2}) {
      scene.motion.trial = trial;
      all.add(play(model, scene, std::string(name) + ", glove, trial " + std::to_string(trial)));
    }
  }
  expect_felt(all);
}

TEST(GdpFelt, WhatPenetratesIsFeltAndNoForceJumpsOverHumanMotions) {
  Felt all;
  for (const char* name : kScenes) {
    const SceneDescription scene =
        load_scene(name, {{"objects.0.triangles", "1000"}, {"grasp.type", "none"}});
    const HapticModel model = build_model(scene);
    for (int seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(::testing::Message() << name << " seed " << seed);
      Player player(model, scene.parameters);
      test::HumanMotion motion(model.hand.parameters(), static_cast<std::uint64_t>(seed));
      const int ticks = test::kSlowBuild ? 200 : 2000;
      for (int n = 0; n < ticks; ++n) player.tick(motion.next(scene.parameters.period()));
      player.felt.print(std::string(name) + " human, seed " + std::to_string(seed));
      all.add(player.felt);
    }
  }
  expect_felt(all);
}

}  // namespace
}  // namespace phalanx
