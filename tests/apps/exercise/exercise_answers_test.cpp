// SPDX-License-Identifier: Apache-2.0
// Feel and find, and the object in the hand, on a station.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/exercise/exercise_program.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

class CliExerciseAnswers : public testing::ExerciseProgram {
 protected:
  /// Gives the scene of sponges a stabiliser, in a copy of the scenes, and writes an exercise of ten
  /// pairs on it.
  void write_sponges(const std::string& stabiliser) {
    namespace fs = std::filesystem;
    const fs::path source = PHALANX_SOURCE_DIR;
    const fs::path copy = folder / stabiliser;
    fs::create_directories(copy);
    fs::create_directory_symlink(source / "assets", copy / "assets");
    fs::copy(source / "scenes", copy / "scenes", fs::copy_options::recursive);
    testing::write_file(copy / "scenes/sponge.toml",
                        testing::read_file(source / "scenes/sponge.toml") +
                            fmt::format("\n[stabiliser]\nmethod = \"{}\"\n", stabiliser));
    scenes_and_assets = copy.string();
    testing::write_file(
        folder / "feel.toml",
        "format = 1\ntitle = \"Feel\"\nkind = \"assessment\"\nmeasure = \"feel_and_find\"\nscene = "
        "\"sponge\"\ndigits = \"index\"\ninstruction = \"Press slowly.\"\ntrials = 10\ntrial_s = 5\n"
        "rest_s = 1.5\n");
  }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(run("exercise results --json " + recordings().back()).out);
  }
};

/// Runs ten pairs, and checks that each pair that counts was sent within 10 % of what was commanded.
void expect_counted_within_ten_percent(const nlohmann::json& result, int& counted) {
  for (const auto& trial : result["trials"]) {
    if (trial.contains("invalid") && !trial["invalid"].get<std::string>().empty()) continue;
    ++counted;
    for (const char* which : {"first", "second"}) {
      double commanded = std::nan("");
      double sent = std::nan("");
      for (const auto& score : trial["scores"]) {
        if (!score.contains("value")) continue;
        if (score["name"] == fmt::format("commanded_{}_n_per_mm", which))
          commanded = score["value"].get<double>();
        if (score["name"] == fmt::format("sent_{}_n_per_mm", which)) sent = score["value"].get<double>();
      }
      EXPECT_LE(std::abs(sent - commanded), 0.1 * commanded) << trial.dump();
    }
  }
}

TEST_F(CliExerciseAnswers, OnAStationThatSmoothsAPairCountsOnlyAsItWasSent) {
  for (const char* stabiliser : {"rise_only", "smoothing"}) {
    SCOPED_TRACE(stabiliser);
    write_sponges(stabiliser);
    const auto shown = exercise("./feel.toml --demo healthy --seed 5");
    ASSERT_EQ(shown.exit_code, 0) << shown.err;
    int counted = 0;
    const nlohmann::json found = result();
    expect_counted_within_ten_percent(found, counted);
    EXPECT_FALSE(found["interrupted"].get<bool>());
    if (std::string(stabiliser) == "rise_only") {
      EXPECT_EQ(counted, 10) << "which does not lower a force that rises slowly";
    }
    RecordProperty(stabiliser, counted);
  }
}

TEST_F(CliExerciseAnswers, ObjectsAreExchangedAtZeroTorque) {
  const auto shown = exercise("object_in_hand --demo healthy --seed 2");
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("all trials are done, 18 trials"));
  const nlohmann::json found = result();
  ASSERT_THAT(found["trials"], SizeIs(18));
}

}  // namespace
}  // namespace phalanx
