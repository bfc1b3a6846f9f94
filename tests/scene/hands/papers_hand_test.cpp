// SPDX-License-Identifier: Apache-2.0
// The hand of the papers' experiments and of the stability studies (assets/hands/papers.toml): the published
// numbers were computed with it, so that it keeps its bits while the adult's hand may change.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kThumb = static_cast<int>(Digit::kThumb);

/// Continues an FNV-1a hash (Fowler, Noll & Vo, 64 bits) with a file's lines, without comments and the
/// spaces before them, and without empty lines.
std::uint64_t hash_of_lines(const std::filesystem::path& file, std::uint64_t hash = 0xcbf29ce484222325ULL) {
  std::ifstream in(file);
  EXPECT_TRUE(in) << file;
  for (std::string line; std::getline(in, line);) {
    line.erase(std::min(line.find('#'), line.size()));
    line.erase(line.find_last_not_of(' ') + 1);
    if (line.empty()) continue;
    for (const char c : line + "\n") hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return hash;
}

TEST(PapersHand, KeepsItsNumbersAndMeshesToTheBit) {
  const std::string toml = PHALANX_SOURCE_DIR "/assets/hands/papers.toml";
  EXPECT_EQ(hash_of_lines(toml), 0x1f52c75f7986a585ULL) << "other forces than those of docs/stability.md";
  const auto meshes = read_hand_file("papers").meshes;
  ASSERT_TRUE(meshes.has_value());
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (int s = 0; s < kSegments; ++s)
    hash = hash_of_lines(HandMeshFiles::of_segment(meshes->collision, s), hash);
  EXPECT_EQ(hash, 0xae426902ee6df5e2ULL) << "other forces than those of docs/stability.md";
}

// Everything but the directions and twists of the thumb, its CMC ranges and the coupled rotations.
TEST(PapersHand, IsTheAdultsButForThumbAndCoupledRotations) {
  const HandParameters papers = load_hand_file("papers");
  const HandParameters adult = load_hand_file("adult");
  EXPECT_EQ(papers.name, "papers");
  EXPECT_EQ(papers.segments, adult.segments);
  EXPECT_EQ(papers.palm, adult.palm);
  for (int d = 0; d < kDigits; ++d) {
    SCOPED_TRACE(digit_name(d));
    const DigitParameters& ours = papers.digits[idx(d)];
    const DigitParameters& adults = adult.digits[idx(d)];
    EXPECT_EQ(ours.coupling, DigitCoupling{});
    EXPECT_EQ(ours.base, adults.base);
    if (d == kThumb) continue;
    EXPECT_EQ(ours.distal, adults.distal);
    EXPECT_EQ(ours.dorsal, adults.dorsal);
    EXPECT_EQ(ours.dh, adults.dh);
  }
  for (int j = 0; j < kJointsPerDigit; ++j) {
    const DhRow& row = papers.digits[kThumb].dh[idx(j)];
    EXPECT_EQ(row.a, adult.digits[kThumb].dh[idx(j)].a) << j;
    if (j >= 2) {
      EXPECT_EQ(row.alpha, 0.0) << "parallel hinges";
    }
  }
  for (std::size_t j = 2; j < kJoints; ++j) {
    EXPECT_EQ(papers.min_angle[j], adult.min_angle[j]) << j;
    EXPECT_EQ(papers.max_angle[j], adult.max_angle[j]) << j;
    EXPECT_EQ(papers.open_angle[j], adult.open_angle[j]) << j;
  }
}

// Cooney et al. 1981: 53 deg of flexion and extension, 42 deg of abduction and adduction.
TEST(PapersHand, HasThePublishedArcsOfTheThumb) {
  const HandParameters hand = load_hand_file("papers");
  EXPECT_NEAR(hand.max_angle[0] - hand.min_angle[0], 53.0 * kDegree, 1e-12);
  EXPECT_NEAR(hand.max_angle[1] - hand.min_angle[1], 42.0 * kDegree, 1e-12);
}

// 3,394 triangles, and a skin that a reader takes.
TEST(PapersHand, IsShownWithItsOwnMeshesAndSkin) {
  HandDescription description;
  description.file = "papers";
  const LoadedHand hand = load_hand(description, HandDetail::kAll);
  std::size_t triangles = 0;
  for (const TriangleMesh& mesh : hand.meshes.collision) triangles += mesh.triangles.size();
  EXPECT_EQ(triangles, 3394U);
  ASSERT_TRUE(hand.skin.has_value());
  const auto meshes = read_hand_file("papers").meshes;
  EXPECT_EQ(meshes->skin.parent_path(), meshes->collision.parent_path());
  EXPECT_EQ(meshes->skin.parent_path().filename(), "papers");
}

TEST(PapersHand, IsTheHandOfTheStabilityScenes) {
  for (const char* name : {"stability_press", "stability_grasp"}) {
    const SceneDescription scene = load_scene(name);
    EXPECT_EQ(scene.hand.file, "papers") << name;
    EXPECT_EQ(scene.hand.coupling, HandCoupling::kNone) << name;
  }
}

/// The digits' forces [N] 1.5 s after the start of a scene's motion, within its hold.
std::array<double, kDigits> held(const std::string& name, const Overrides& set) {
  const SceneDescription scene = load_scene(name, set);
  const HapticModel model = build_model(scene);
  const Motion motion = build_motion(scene);
  HapticState state(model, scene.parameters);
  const auto ticks = static_cast<int>(1.5 * scene.parameters.rate_hz);
  for (int tick = 0; tick <= ticks; ++tick) {
    const double time = tick / scene.parameters.rate_hz;
    (void)step(model, scene.parameters, {time, motion.at(time)}, state);
  }
  std::array<double, kDigits> force{};
  for (int s = 0; s < kPalm; ++s) force[idx(digit_of_segment(s))] += state.snapshot().segment[idx(s)].force;
  return force;
}

// Values of the adult's hand of commit e959a5c, from which this hand was taken: its ticks were equal to the bit.
TEST(PapersHand, KeepsTheForcesOfThePapersScenes) {
  const std::vector<std::tuple<std::string, Overrides, std::array<double, kDigits>>> scenes = {
      {"stability_press", {}, {0.0, 1.8259154722779491, 0.0, 0.0, 0.0}},
      {"stability_grasp",
       {},
       {3.03201025203497, 3.356796192824002, 3.1216058771081787, 3.097102537851146, 3.5394333955456654}},
      {"timing_grasp",  // with the triangles of the object that the older values are of
       {{"objects.0.triangles", "4000"}},
       {1.8694794633537775, 1.1509770767257166, 1.321156458392862, 1.068441309119821, 1.5564530636482907}}};
  for (const auto& [name, set, expected] : scenes) {
    const auto force = held(name, set);
    for (std::size_t d = 0; d < kDigits; ++d) EXPECT_NEAR(force[d], expected[d], 1e-9) << name << ", " << d;
  }
}

}  // namespace
}  // namespace phalanx
