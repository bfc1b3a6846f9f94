// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/study_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "phalanx/scene/scene_keys.h"
#include "study/laboratory/expect_refusal.h"
#include "study/laboratory/study_json.h"
#include "study/laboratory/study_limits.h"
#include "study/laboratory/synthetic.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using testing::expect_refusal;
using ::testing::Pair;
using testing::study_of;

TEST(StudyFile, ReadsVariantsAxesAndGrid) {
  const Study study = study_of(testing::kTwelvePoints);
  EXPECT_EQ(study.name, "synthetic");
  EXPECT_EQ(study.title, "twelve points");
  EXPECT_EQ(study.scene, "press_teapot");
  EXPECT_EQ(study.seeds, 5);
  EXPECT_EQ(study.first_seed, 1U);
  EXPECT_EQ(study.stiffness->size(), 40);
  EXPECT_EQ(study.stiffness->n_per_mm(2), 0.3);
  EXPECT_EQ(study.stiffness->at(39), 4000.0);
  ASSERT_EQ(study.variants.size(), 3U);
  EXPECT_EQ(study.variants[2].name, "wall, \"local\"");
  ASSERT_EQ(study.axes.size(), 1U);
  EXPECT_EQ(study.axes[0].label, "friction");
  EXPECT_TRUE(study.axes[0].numeric());
  EXPECT_EQ(point_count(study), 12);
}

TEST(StudyFile, NumbersThePointsWithTheLastAxisFastest) {
  const Study study = study_of(R"(
scene = "a"
set = { x.y = 1, "objects.0.kind" = "sphere" }
[[variant]]
name = "one"
[[variant]]
name = "two"
set = { "stabiliser.method" = "smoothing", limits.on = [1, 2.5] }
[[axis]]
key = "p"
values = ["light", "heavy"]
[[axis]]
key = "q"
from = 0.1
to = 0.3
step = 0.1
)");
  EXPECT_EQ(point_count(study), 12);
  const StudyPoint point = study_point(study, 6 + 3 + 2);
  EXPECT_EQ(point.variant, 1);
  EXPECT_THAT(point.value, ElementsAre(1, 2));
  EXPECT_EQ(point_text(study, point), "two, p heavy, q 0.3");
  EXPECT_FALSE(study.axes[0].numeric());
  EXPECT_THAT(point_overrides(study, point),
              ::testing::UnorderedElementsAre(Pair("x.y", "1"), Pair("objects.0.kind", "\"sphere\""),
                                              Pair("stabiliser.method", "\"smoothing\""),
                                              Pair("limits.on", "[1, 2.5]"), Pair("p", "\"heavy\""),
                                              Pair("q", "0.3")));
  EXPECT_EQ(point_overrides(study, point).back().first, "q");
}

TEST(StudyFile, NeedsNoMoreThanAScene) {
  const Study study = study_of("scene = \"a\"");
  EXPECT_EQ(point_count(study), 1);
  EXPECT_FALSE(study.has_variants());
  EXPECT_FALSE(study.stiffness.has_value());
  EXPECT_EQ(study.seeds, 20);
  EXPECT_EQ(point_text(study, study_point(study, 0)), "the scene as it is");
}

TEST(StudyFile, ResolvesPathsAgainstItsFolderAndLeavesNames) {
  const std::string text = R"(
scene = "scenes/mine.toml"
[[axis]]
key = "hand.file"
values = ["adult", "hands/mine.toml", "/abs/hand.toml"]
)";
  const Study study = parse_study(text, "s.toml", "/studies");
  EXPECT_EQ(scene_of(study), "/studies/scenes/mine.toml");
  const auto hand = [&](int index) {
    return point_overrides(study, study_point(study, index)).back().second;
  };
  EXPECT_EQ(hand(0), "\"adult\"");
  EXPECT_EQ(hand(1), "\"/studies/hands/mine.toml\"");
  EXPECT_EQ(hand(2), "\"/abs/hand.toml\"");
}

// A mesh is never looked for by its name: also a bare one is a file beside the study.
TEST(StudyFile, ResolvesEveryFileOfAnObject) {
  const Study study = parse_study(R"(
scene = "a"
[[axis]]
key = "objects.0.file"
values = ["a.obj", "m/b.obj", "/abs/c.obj", "d", ""]
)",
                                  "s.toml", "/studies");
  std::vector<std::string> files;
  for (int i = 0; i < 5; ++i) files.push_back(point_overrides(study, study_point(study, i)).back().second);
  EXPECT_THAT(files, ElementsAre("\"/studies/a.obj\"", "\"/studies/m/b.obj\"", "\"/abs/c.obj\"",
                                 "\"/studies/d\"", "\"\""));
}

TEST(StudyFile, SurvivesTheJournalsForm) {
  for (const char* text : {testing::kTwelvePoints,
                           "scene = \"a\"\nfirst_seed = 21\nset = { x.y = 1 }\n[[axis]]\nkey = \"p\"\nvalues "
                           "= [\"light\", 2]"}) {
    const OrderedJson json = study_to_json(study_of(text));
    EXPECT_EQ(study_to_json(study_from_json(OrderedJson::parse(json.dump()))), json);
  }
}

TEST(StudyFile, ReadsHowTheLimitIsSearched) {
  const std::string grid =
      "scene = \"a\"\n[stiffness]\nmin_n_per_mm = 1\nmax_n_per_mm = 2\nstep_n_per_mm = 1\n";
  EXPECT_EQ(study_of(grid).stiffness->search, StiffnessSearch::kScan);
  EXPECT_EQ(study_of(grid + "search = \"scan\"").stiffness->search, StiffnessSearch::kScan);
  const Study traced = study_of(grid + "search = \"trace\"");
  EXPECT_EQ(traced.stiffness->search, StiffnessSearch::kTrace);
  const OrderedJson json = study_to_json(traced);
  EXPECT_EQ(study_from_json(json).stiffness->search, StiffnessSearch::kTrace);
  expect_refusal([&] { static_cast<void>(study_of(grid + "search = \"grid\"")); },
                 {"synthetic.toml:6", "stiffness.search", "\"grid\"", "write \"scan\" or \"trace\""});
  OrderedJson other = json;
  other["stiffness"]["search"] = "grid";
  EXPECT_THROW(static_cast<void>(study_from_json(other)), std::out_of_range);
}

TEST(StudyFile, AllowsNoStifferGridThanASceneMayState) {
  EXPECT_EQ(kLargestStiffness, find_scene_key("force.stiffness_n_per_mm")->range.max);
}

// A journal may come from elsewhere. Each bad grid has one thing wrong: the least value, the order, the
// largest value, the step's sign, 30,001 values.
TEST(StudyFile, RefusesAJournalWhoseNumbersNoStudyFileMayHold) {
  const OrderedJson good = study_to_json(study_of(testing::kTwelvePoints));
  const auto with_grid = [&](double min, double max, double step) {
    OrderedJson json = good;
    json["stiffness"] = {{"min_n_per_mm", min}, {"max_n_per_mm", max}, {"step_n_per_mm", step}};
    static_cast<void>(study_from_json(json));
  };
  EXPECT_NO_THROW(with_grid(0.1, 0.1, 0.1));
  EXPECT_NO_THROW(with_grid(1.0, 100.0, 1.0));
  EXPECT_THROW(with_grid(0.0, 4.0, 0.1), std::out_of_range);
  EXPECT_THROW(with_grid(0.2, 0.1, 0.1), std::out_of_range);
  EXPECT_THROW(with_grid(1.0, 101.0, 1.0), std::out_of_range);
  EXPECT_THROW(with_grid(1.0, 4.0, -1.0), std::out_of_range);
  EXPECT_THROW(with_grid(1.0, 4.0, 1e-4), std::out_of_range);
  const auto with_number = [&](const char* key, const OrderedJson& number) {
    OrderedJson json = good;
    json[key] = number;
    static_cast<void>(study_from_json(json));
  };
  EXPECT_NO_THROW(with_number("seeds", 1));
  EXPECT_NO_THROW(with_number("seeds", 10'000));
  EXPECT_NO_THROW(with_number("first_seed", 0));
  EXPECT_NO_THROW(with_number("first_seed", 1'000'000'000'000'000));
  EXPECT_THROW(with_number("seeds", 0), std::out_of_range);
  EXPECT_THROW(with_number("seeds", 10'001), std::out_of_range);
  EXPECT_THROW(with_number("seeds", 2.0), std::out_of_range);
  EXPECT_THROW(with_number("first_seed", -1), std::out_of_range);
  EXPECT_THROW(with_number("first_seed", 1'000'000'000'000'001), std::out_of_range);
  EXPECT_THROW(with_number("variants", OrderedJson::array()), std::out_of_range) << "no point at all";
}

struct Refused {
  const char* text;
  std::vector<std::string> words;
};

TEST(StudyFile, RefusesInWords) {
  const std::vector<Refused> cases = {
      {"seeds = 3", {"scene", "is missing"}},
      {"scene = \"a\"\nsedes = 3", {"synthetic.toml:2", "sedes", "nearest known one is seeds"}},
      {"scene = \"a\"\nseeds = 0", {"seeds = 0", ">= 1"}},
      {"scene = \"a\"\nseeds = 2.5", {"whole number"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"\nvalues = []", {"at least one"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"\nvalues = [1, 1]", {"twice"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"", {"axis.0.from", "is missing"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"\nvalues = [1]\nstep = 1", {"beside from"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"\nfrom = 0\nto = 1\nstep = 0.3", {"does not divide"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"\nfrom = 0\nto = 10000\nstep = 1",
       {"makes 10001 values; 10000 are the most"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"\nvalues = [1979-05-27]", {"a date"}},
      {"scene = \"a\"\n[[axis]]\nkey = \"b\"\nvalues = [1]\n[[axis]]\nkey = \"b\"\nvalues = [2]",
       {"two axes"}},
      {"scene = \"a\"\n[[variant]]\nname = \"\"", {"empty"}},
      {"scene = \"a\"\n[[variant]]\nname = \"v\"\n[[variant]]\nname = \"v\"", {"two variants"}},
      {"scene = \"a\"\n[[variant]]\nname = \"v\"\nset = { b = 1 }\n[[axis]]\nkey = \"b\"\nvalues = [1]",
       {"no effect"}},
      {"scene = \"a\"\nset = { seed = 1 }", {"seed", "first_seed"}},
      {"scene = \"a\"\nset = { a = 1979-05-27 }", {"a date"}},
      {"scene = \"a\"\nset = 3", {"a table"}},
      {"scene = \"a\"\n[stiffness]\nmin_n_per_mm = 1\nmax_n_per_mm = 0.5\nstep_n_per_mm = 0.1",
       {"max_n_per_mm", ">= 1"}},
      {"scene = \"a\"\n[stiffness]\nmin_n_per_mm = 1\nmax_n_per_mm = 2\nstep_n_per_mm = 0.3",
       {"does not divide"}},
      {"scene = \"a\"\nset = { force.stiffness_n_per_mm = 1 }\n[stiffness]\nmin_n_per_mm = 1\nmax_n_per_mm = "
       "2\nstep_n_per_mm = 1",
       {"[stiffness] searches"}},
  };
  for (const Refused& refused : cases) {
    SCOPED_TRACE(refused.text);
    expect_refusal([&] { static_cast<void>(study_of(refused.text)); }, refused.words);
  }
}

TEST(StudyFile, RefusesMorePointsThanAnybodyWaitsFor) {
  std::string text = "scene = \"a\"\n";
  for (const char* key : {"a", "b", "c"})
    text += std::string("[[axis]]\nkey = \"") + key + "\"\nfrom = 1\nto = 101\nstep = 1\n";
  expect_refusal([&] { static_cast<void>(study_of(text)); }, {"1030301 points"});
}

// 10,000 values of an axis, 10,000 seeds and a million points are the most.
TEST(StudyFile, TakesAsMuchAsMayBeAndNoMore) {
  const auto axis = [](const std::string& key, int last) {
    return "[[axis]]\nkey = \"" + key + "\"\nfrom = 1\nto = " + std::to_string(last) + "\nstep = 1\n";
  };
  const std::string scene = "scene = \"a\"\n";
  EXPECT_EQ(point_count(study_of(scene + axis("b", 10'000))), 10'000);
  expect_refusal([&] { static_cast<void>(study_of(scene + axis("b", 10'001))); }, {"makes 10001 values"});
  // Divided, these are 9999.999999999998 and 10000.999999999998 steps.
  const std::string stepped = scene + "[[axis]]\nkey = \"b\"\n";
  expect_refusal([&] { static_cast<void>(study_of(stepped + "from = 0\nto = 700\nstep = 0.07")); },
                 {"makes 10001 values"});
  expect_refusal([&] { static_cast<void>(study_of(stepped + "from = 2.7\nto = 1002.8\nstep = 0.1")); },
                 {"makes 10002 values"});
  EXPECT_EQ(study_of(scene + "seeds = 10000").seeds, 10'000);
  expect_refusal([&] { static_cast<void>(study_of(scene + "seeds = 10001")); }, {"<= 10000"});
  EXPECT_EQ(point_count(study_of(scene + axis("b", 1000) + axis("c", 1000))), 1'000'000);
  expect_refusal([&] { static_cast<void>(study_of(scene + axis("b", 1000) + axis("c", 1001))); },
                 {"1001000 points"});
}

// 40 stiffnesses: at most 16 are tried if stability is monotone, and two presses, of 5 seeds.
TEST(StudyFile, EstimatesTheTrials) {
  const TrialEstimate estimate = most_trials(study_of(testing::kTwelvePoints));
  EXPECT_EQ(estimate.per_point, (16 + 2) * 5);
  EXPECT_EQ(estimate.all, 12 * estimate.per_point);
  EXPECT_EQ(most_trials(study_of("scene = \"a\"\nseeds = 7")).all, 3 * 7);
}

}  // namespace
}  // namespace phalanx
