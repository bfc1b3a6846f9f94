// SPDX-License-Identifier: Apache-2.0
// Every instruction set that this processor has gives the same bits as the portable one.
#include "phalanx/contact/instruction_set.h"

#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <iostream>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include "contact/search/search_functions.h"
#include "contact/search/views.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "support/count_allocations.h"
#include "support/search_cases.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

/// The best set is in use again when a test ends, however it ends.
class UsedSet {
 public:
  explicit UsedSet(InstructionSet set) { use_instruction_set(set); }
  ~UsedSet() { use_instruction_set(best_instruction_set()); }
  UsedSet(const UsedSet&) = delete;
  UsedSet& operator=(const UsedSet&) = delete;
};

/// Bits of results, one after the other.
class ResultBits {
 public:
  void add(double x) { bits_.push_back(std::bit_cast<std::uint64_t>(x)); }
  void add(std::uint64_t x) { bits_.push_back(x); }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Pose& X) {
    for (int i = 0; i < 9; ++i) add(X.R.data()[i]);
    add(X.p);
  }
  void add(const JointArray& q) {
    for (const double x : q) add(x);
  }
  [[nodiscard]] std::size_t size() const { return bits_.size(); }
  /// The first place at which they differ; size() if they do not.
  [[nodiscard]] std::size_t first_difference(const ResultBits& other) const {
    std::size_t i = 0;
    while (i < std::min(size(), other.size()) && bits_[i] == other.bits_[i]) ++i;
    return size() == other.size() ? i : std::min(i, std::min(size(), other.size()) - 1);
  }

 private:
  std::vector<std::uint64_t> bits_;
};

void expect_same_bits(const ResultBits& portable, const ResultBits& wide) {
  ASSERT_EQ(portable.size(), wide.size());
  EXPECT_EQ(portable.first_difference(wide), portable.size()) << "place of the first different number";
}

/// Adds the candidates near the segment, their distances, and those that a motion may bring near.
void add_candidates(const PlacedSegment& placed, const ObjectModel& object, double found,
                    test::Random& random, ResultBits& out) {
  const search::SegmentView segment = search::view_of(placed, object.tree());
  const search::ObjectView tree = search::view_of(object.tree());
  struct Candidates {
    std::vector<search::PairIndex> pair;
    ResultBits& out;
    double cap;
  } candidates{{}, out, found + 1e-3};
  search::functions().list(
      segment, tree, candidates.cap,
      [](void* self, const search::PairIndex& pair, double bound) {
        auto& list = *static_cast<Candidates*>(self);
        list.pair.push_back(pair);
        list.out.add(bound);
        if (list.pair.size() % 50 == 0) list.cap *= 0.9;
        return list.pair.size() < 300 ? list.cap : -1.0;
      },
      &candidates);
  std::vector<search::PairDistance> distances(candidates.pair.size());
  const int n = static_cast<int>(candidates.pair.size());
  search::functions().measure(segment, tree, candidates.pair.data(), n, distances.data());
  for (const search::PairDistance& p : distances) {
    out.add(static_cast<std::uint64_t>(p.pair.triangle));
    out.add(static_cast<std::uint64_t>(p.pair.slot));
    for (const double x : {p.squared, p.on_segment[0], p.on_segment[1], p.on_segment[2], p.on_object[0]})
      out.add(x);
  }
  SegmentMotion motion;
  motion.angular = test::in_cube(random, 1e-2);
  motion.linear = test::in_cube(random, 1e-3);
  motion.linear_rate = test::in_cube(random, 1e-4);
  motion.jerk = 1e-6;
  const int kept =
      search::functions().sift(segment, tree, search::view_of(motion), 1.0, found, candidates.pair.data(), n);
  for (int i = 0; i < kept; ++i) {
    out.add(static_cast<std::uint64_t>(candidates.pair[idx(i)].triangle));
    out.add(static_cast<std::uint64_t>(candidates.pair[idx(i)].slot));
  }
}

ResultBits searched(std::uint64_t seed, int poses) {
  test::Random random(seed);
  ResultBits out;
  for (const test::SearchCase& shapes : test::search_cases(random)) {
    const ObjectModel object(shapes.object);
    const SegmentTree segment(shapes.segment);
    SearchScratch scratch(segment);
    for (int i = 0; i < poses; ++i) {
      const Pose X = shapes.pose(random);
      const PlacedSegment placed{segment, X, scratch};
      const double found = distance(placed, object.tree(), 1.0);
      out.add(found);
      out.add(distance_bound(placed, object.tree(), 1.0));
      out.add(distance_bound(placed, object.tree(), 0.3 * found));
      out.add(static_cast<std::uint64_t>(crosses(placed, object.tree())));
      const ContactPatch patch = contact_patch(placed, object, found + 1e-4);
      out.add(patch.distance);
      out.add(patch.on_segment);
      out.add(patch.on_object);
      out.add(patch.direction);
      out.add(patch.object_normal);
      out.add(static_cast<std::uint64_t>(patch.pairs));
      add_candidates(placed, object, found, random, out);
    }
  }
  return out;
}

void add_snapshot(const Snapshot& s, ResultBits& out) {
  out.add(static_cast<std::uint64_t>(s.status));
  out.add(s.hcp_angle);
  out.add(s.gdp_angle);
  out.add(s.torque);
  for (std::size_t i = 0; i < kSegments; ++i) {
    const SegmentSnapshot& segment = s.segment[i];
    out.add(static_cast<std::uint64_t>(segment.contact));
    for (const double x : {segment.depth, segment.force_raw, segment.force, segment.slid}) out.add(x);
    out.add(segment.point);
    out.add(segment.normal);
    out.add(s.hcp_pose[i]);
    out.add(s.gdp_pose[i]);
  }
}

JointArray any_hand(test::Random& random, const HandParameters& hand, double reach) {
  JointArray q{};
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double target = test::between(random, hand.min_angle[j], hand.max_angle[j]);
    q[j] = hand.open_angle[j] + reach * (target - hand.open_angle[j]);
  }
  return q;
}

/// A hand that grasps and lets go at random.
ResultBits stepped(std::uint64_t seed, const TriangleMesh& object, int grasps, int ticks,
                   ContactMode mode = ContactMode::kStatic) {
  test::Random random(seed);
  test::Setup model(test::simple_hand(), ObjectModel(object));
  model.parameters.contact.mode = mode;
  model.parameters.limits.joint_speed = kInfinity;
  test::Runner runner(model);
  ResultBits out;
  for (int n = 0; n < grasps; ++n) {
    const JointArray from = runner.now().hcp_angle;
    const JointArray to = any_hand(random, model.hand.parameters(), n % 3 == 2 ? 0.0 : 1.0);
    for (int i = 1; i <= ticks; ++i) {
      JointArray q{};
      for (std::size_t j = 0; j < kJoints; ++j) q[j] = from[j] + (to[j] - from[j]) * i / ticks;
      add_snapshot(runner.tick(q), out);
    }
  }
  return out;
}

std::vector<TriangleMesh> grasped_objects() {
  const Pose X = test::at(0.0, -0.03, -0.05);
  return {test::moved(make_sphere(0.03, 2000), X), test::moved(make_box(Vec3(0.3, 0.03, 0.03), 600), X),
          test::moved(test::meridians(300), test::at(0.0, -0.07, -0.05))};
}

class EverySet : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    std::cout << "this processor and this build have:";
    for (const InstructionSet set :
         {InstructionSet::kPortable, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
      if (has_instruction_set(set)) std::cout << " " << instruction_set_name(set);
    }
    std::cout << "\n";
    if (!has_instruction_set(GetParam()))
      GTEST_SKIP() << "no " << instruction_set_name(GetParam()) << " here: not tested";
  }

  template <class Run>
  void expect_same_as_portable(Run&& run) const {
    ResultBits portable;
    {
      const UsedSet used(InstructionSet::kPortable);
      portable = run();
    }
    const UsedSet used(GetParam());
    expect_same_bits(portable, run());
    EXPECT_GT(portable.size(), 1000U);
  }
};

TEST_P(EverySet, IsInUseOnceItIsChosen) {
  const UsedSet used(GetParam());
  EXPECT_EQ(instruction_set(), GetParam());
  switch (GetParam()) {
    case InstructionSet::kPortable:
      EXPECT_EQ(&search::functions(), search::portable_functions());
      break;
    case InstructionSet::kAvx2:
      EXPECT_EQ(&search::functions(), search::avx2_functions());
      break;
    case InstructionSet::kAvx512:
      EXPECT_EQ(&search::functions(), search::avx512_functions());
      break;
  }
}

TEST_P(EverySet, DistancesBoundsAndPatchesAreTheSameBits) {
  std::cout << "seed 31\n";
  expect_same_as_portable([] { return searched(31, 12); });
}

TEST_P(EverySet, WholeStepsAreTheSameBits) {
  std::cout << "seed 32\n";
  for (const TriangleMesh& object : grasped_objects())
    expect_same_as_portable([&] { return stepped(32, object, 6, 20); });
}

TEST_P(EverySet, WholeStepsOfSlidingContactsAreTheSameBits) {
  std::cout << "seed 32\n";
  for (const TriangleMesh& object : grasped_objects())
    expect_same_as_portable([&] { return stepped(32, object, 6, 20, ContactMode::kSliding); });
}

TEST_P(EverySet, AllocatesNothingWhereTheListRunsOver) {
  test::Setup model(test::simple_hand(),
                    ObjectModel(test::moved(make_sphere(0.03, 4000), test::at(0.0, -0.03, -0.05))));
  model.parameters.limits.joint_speed = kInfinity;
  test::Random random(33);
  const UsedSet used(GetParam());
  HapticState state(model, model.parameters);
  double time = 0.0;
  int contacts = 0;
  const std::size_t before = test::allocations();
  for (int n = 0; n < 8; ++n) {  // the whole way in one tick, there and back
    const JointArray q = any_hand(random, model.hand.parameters(), n % 2 == 0 ? 1.0 : 0.0);
    step(model, model.parameters, Sample{time += 1.0 / model.parameters.rate_hz, q}, state);
    for (const SegmentSnapshot& segment : state.snapshot().segment) contacts += segment.contact ? 1 : 0;
  }
  EXPECT_EQ(test::allocations() - before, 0U);
  EXPECT_GT(contacts, 2);
}

std::string name_of(const ::testing::TestParamInfo<InstructionSet>& info) {
  return std::string(instruction_set_name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Sets, EverySet,
                         ::testing::Values(InstructionSet::kPortable, InstructionSet::kAvx2,
                                           InstructionSet::kAvx512),
                         name_of);

class SoakEverySet : public EverySet {};

TEST_P(SoakEverySet, SearchesAndStepsAreTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    expect_same_as_portable([&] { return searched(seed, 50); });
    for (const TriangleMesh& object : grasped_objects())
      expect_same_as_portable([&] { return stepped(seed, object, 20, 20); });
  }
}
INSTANTIATE_TEST_SUITE_P(SoakSets, SoakEverySet,
                         ::testing::Values(InstructionSet::kAvx2, InstructionSet::kAvx512), name_of);

struct Available {
  bool avx2 = false;
  bool avx512 = false;  ///< F, DQ, BW and VL
};

/// By the processor's own words: CPUID leaf 7 names its instructions, and XCR0 the registers that the system
/// saves (Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, chapters 14 and 15).
Available available() {
#if defined(__x86_64__)
  unsigned a = 0;
  unsigned b = 0;
  unsigned c = 0;
  unsigned d = 0;
  constexpr unsigned kOsxsave = 1U << 27U;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & kOsxsave) == 0U) return {};
  unsigned saved = 0;
  unsigned upper = 0;
  asm volatile("xgetbv" : "=a"(saved), "=d"(upper) : "c"(0));
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0) return {};
  const auto all = [](unsigned word, unsigned bits) { return (word & bits) == bits; };
  constexpr unsigned kYmm = 0x06;                                              // XMM and YMM
  constexpr unsigned kZmm = 0xe6;                                              // and masks and ZMM
  constexpr unsigned kAvx512 = 1U << 16U | 1U << 17U | 1U << 30U | 1U << 31U;  // F, DQ, BW, VL
  return {.avx2 = all(saved, kYmm) && all(b, 1U << 5U), .avx512 = all(saved, kZmm) && all(b, kAvx512)};
#else
  return {};
#endif
}

// A set that went missing would only be skipped above.
TEST(InstructionSet, ThereAreThoseThatTheProcessorHasAndTheBestIsTheWidest) {
  const auto [avx2, avx512] = available();
  EXPECT_EQ(has_instruction_set(InstructionSet::kAvx2), avx2);
  EXPECT_EQ(has_instruction_set(InstructionSet::kAvx512), avx512);
  EXPECT_EQ(best_instruction_set(), avx512 ? InstructionSet::kAvx512
                                    : avx2 ? InstructionSet::kAvx2
                                           : InstructionSet::kPortable);
}

TEST(InstructionSet, ThePortableOneIsEverywhereAndAnUnknownOneIsRefused) {
  EXPECT_TRUE(has_instruction_set(InstructionSet::kPortable));
  EXPECT_TRUE(has_instruction_set(best_instruction_set()));
  EXPECT_EQ(instruction_set(), best_instruction_set());
  EXPECT_THROW(use_instruction_set(static_cast<InstructionSet>(99)), std::invalid_argument);
  EXPECT_EQ(instruction_set(), best_instruction_set()) << "a refused one changes nothing";
}

}  // namespace
}  // namespace phalanx
