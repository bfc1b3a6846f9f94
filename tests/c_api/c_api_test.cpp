// SPDX-License-Identifier: Apache-2.0
// The C interface seen from C++: no allocation in a step, the same bits as step(), exceptions and threads. The calls themselves are tested from C (calls_test.c).
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/mesh/primitives.h"
#include "phalanx/phalanx.h"
#include "phalanx/step/haptic_step.h"
#include "station/parameter_ramp.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

constexpr int kIndexKnuckle = 4;

/// A slab below the hand of round numbers, as arrays.
TriangleMesh slab() {
  TriangleMesh mesh;
  append(mesh, make_box({0.2, 0.02, 0.3}, 100), {.p = {0.0, -0.03, -0.1}});
  return mesh;
}

/// Handles of one test; they are destroyed with it.
class CApi : public testing::Test {
 protected:
  CApi() {
    const TriangleMesh mesh = slab();
    good(phalanx_model_create_from_mesh(nullptr, mesh.vertices.front().data(), mesh.vertices.size(),
                                        mesh.triangles.front().data(), mesh.triangles.size(), &model_));
  }
  CApi(const CApi&) = delete;
  CApi& operator=(const CApi&) = delete;
  ~CApi() override {
    phalanx_state_destroy(state_);
    phalanx_scene_destroy(scene_);
    phalanx_model_destroy(model_);
  }

  static void good(phalanx_result result) { ASSERT_EQ(result, PHALANX_OK) << phalanx_error_text(); }

  void begin(const char* text) {
    good(phalanx_scene_parse(text, nullptr, &scene_));
    good(phalanx_state_create(model_, scene_, &state_));
  }

  /// Sample `i` of a finger that bends into the slab and out of it.
  static phalanx_sample sample(int i) {
    phalanx_sample out{};
    out.struct_size = sizeof out;
    out.time_s = i / 200.0;
    out.angle[kIndexKnuckle] = 0.6 - 0.6 * std::cos(i / 40.0);
    return out;
  }

  phalanx_model* model_ = nullptr;
  phalanx_scene* scene_ = nullptr;
  phalanx_state* state_ = nullptr;
};

TEST_F(CApi, AStepAndItsResultsAllocateNothing) {
  for (const char* mode : {"", "[contact]\nmode = \"sliding\"\n"}) {
    begin(mode);
    phalanx_snapshot now{};
    now.struct_size = sizeof now;
    phalanx_contact_point point{};
    point.struct_size = sizeof point;
    std::uint64_t contacts = 0;
    std::uint64_t points = 0;
    good(phalanx_state_set(state_, "force.stiffness_n_per_mm", "0.9"));  // its way begins with the first step
    phalanx_step(state_, nullptr, nullptr);  // the text of a failure is there already
    const std::size_t before = test::allocations_of_this_thread();
    for (int i = 0; i < 500; ++i) {
      const phalanx_sample in = sample(i);
      phalanx_result result = phalanx_step(state_, &in, nullptr);
      if (result == PHALANX_OK) result = phalanx_state_get_snapshot(state_, &now);
      for (std::uint64_t k = 0; k < now.contact_points && result == PHALANX_OK; ++k, ++points)
        result = phalanx_state_get_contact_point(state_, static_cast<int32_t>(k), &point);
      phalanx_state_confirm_opening(state_, 1);
      phalanx_state_withdraw_openings(state_);
      if (result != PHALANX_OK) break;
      contacts += now.segment[5].contact;
    }
    EXPECT_EQ(test::allocations_of_this_thread() - before, 0U) << mode;
    EXPECT_EQ(now.tick, 500U);
    EXPECT_GT(contacts, 100U);
    EXPECT_LT(contacts, 400U);
    EXPECT_EQ(points > 0, std::string(mode) != "");
    phalanx_state_destroy(state_);
    phalanx_scene_destroy(scene_);
  }
}

// The parameters go over in contact, and the results are those of step() with the same parameters.
TEST_F(CApi, GivesTheBitsOfStepWhileParametersChange) {
  begin("");
  const HapticModel model(make_hand_model(straight_hand(), Handedness::kRight, {}, 2250),
                          ObjectModel(slab()));
  HapticParameters wanted;
  ParameterRamp ramp(wanted);
  HapticState state(model, wanted);
  phalanx_snapshot now{};
  now.struct_size = sizeof now;
  double largest = 0.0;
  for (int i = 0; i < 600; ++i) {
    if (i == 90) {
      good(phalanx_state_set(state_, "force.stiffness_n_per_mm", "1.25"));
      wanted.force.stiffness = 1250.0;
      ramp.go_to(wanted);
    }
    if (i == 110) {
      good(phalanx_state_set(state_, "stabiliser.method", "\"smoothing\""));
      wanted.stabiliser.method = Stabiliser::kSmoothing;
      ramp.go_to(wanted);
    }
    const phalanx_sample in = sample(i);
    good(phalanx_step(state_, &in, nullptr));
    good(phalanx_state_get_snapshot(state_, &now));
    Sample same;
    same.time_s = in.time_s;
    std::copy(std::begin(in.angle), std::end(in.angle), same.angle.begin());
    ramp.advance();
    const Status status = step(model, ramp.parameters(), same, state);
    const Snapshot& expected = state.snapshot();
    ASSERT_EQ(now.status, static_cast<std::uint32_t>(status)) << i;
    ASSERT_EQ(now.tick, expected.tick);
    for (std::size_t j = 0; j < kJoints; ++j) {
      ASSERT_EQ(now.torque[j], expected.torque[j]) << i;
      ASSERT_EQ(now.gdp_angle[j], expected.gdp_angle[j]) << i;
      largest = std::max(largest, std::abs(now.torque[j]));
    }
    for (std::size_t s = 0; s < kSegments; ++s) {
      ASSERT_EQ(now.segment[s].force, expected.segment[s].force) << i;
      ASSERT_EQ(now.segment[s].depth, expected.segment[s].depth) << i;
      for (int k = 0; k < 3; ++k) ASSERT_EQ(now.gdp_pose[s].position[k], expected.gdp_pose[s].p[k]) << i;
    }
  }
  EXPECT_EQ(now.stiffness, 1250.0);
  EXPECT_GT(largest, 0.01);
}

TEST_F(CApi, OneThreadSetsAParameterWhileAnotherSteps) {
  begin("");
  std::atomic<bool> stop{false};
  std::atomic<int> sets{0};
  std::thread other([&] {
    while (!stop) {
      for (const char* value : {"0.3", "1.2"})
        if (phalanx_state_set(state_, "force.stiffness_n_per_mm", value) == PHALANX_OK) ++sets;
      std::this_thread::yield();
    }
  });
  phalanx_snapshot now{};
  now.struct_size = sizeof now;
  double least = 1e9;
  double most = 0.0;
  for (int i = 0; i < 3000 || sets < 20; ++i) {
    const phalanx_sample in = sample(i);
    good(phalanx_step(state_, &in, nullptr));
    good(phalanx_state_get_snapshot(state_, &now));
    least = std::min(least, now.stiffness);
    most = std::max(most, now.stiffness);
  }
  stop = true;
  other.join();
  EXPECT_GE(least, 300.0);
  EXPECT_LE(most, 1200.0);
  EXPECT_LT(least, most);
}

// Each allocation of a call fails once: the call fails with PHALANX_ERROR_MEMORY, and works afterwards.
TEST_F(CApi, AFailingAllocationIsAResult) {
  if (!test::kCountsNew) GTEST_SKIP() << "operator new does not fail in this program";
  begin("");
  const TriangleMesh mesh = slab();
  const auto failures_of = [](const auto& call) {
    int failures = 0;
    for (std::size_t number = 1; number < 100'000; number += 1 + number / 16) {
      const test::FailingAllocation one(number);
      const phalanx_result result = call();
      if (result == PHALANX_OK) break;
      EXPECT_EQ(result, PHALANX_ERROR_MEMORY) << phalanx_error_text();
      EXPECT_STREQ(phalanx_error_text(), "out of memory");
      ++failures;
    }
    return failures;
  };
  EXPECT_GT(failures_of([&] {
              phalanx_model* made = nullptr;
              const phalanx_result result =
                  phalanx_model_create_from_mesh(nullptr, mesh.vertices.front().data(), mesh.vertices.size(),
                                                 mesh.triangles.front().data(), mesh.triangles.size(), &made);
              phalanx_model_destroy(made);
              return result;
            }),
            5);
  EXPECT_GT(failures_of([&] {
              phalanx_state* made = nullptr;
              const phalanx_result result = phalanx_state_create(model_, scene_, &made);
              phalanx_state_destroy(made);
              return result;
            }),
            5);
}

TEST_F(CApi, ATextThatIsTooLongIsCutBetweenTwoCharacters) {
  std::string name;
  while (name.size() < 5000) name += "\u00e4";
  phalanx_scene* scene = nullptr;
  EXPECT_EQ(phalanx_scene_load(name.c_str(), &scene), PHALANX_ERROR_REFUSED);
  const std::string text = phalanx_error_text();
  EXPECT_GT(text.size(), 2000U);
  EXPECT_LT(text.size(), 2048U);
  EXPECT_EQ(text.back(), '\xa4');
}

// Each thread has its own text.
TEST_F(CApi, TheTextOfAFailureBelongsToItsThread) {
  double number = 0.0;
  phalanx_state_get_rate(nullptr, &number);
  const std::string here = phalanx_error_text();
  std::string there = "not asked";
  std::thread([&] { there = phalanx_error_text(); }).join();
  EXPECT_NE(here, "");
  EXPECT_EQ(there, "");
}

}  // namespace
}  // namespace phalanx
