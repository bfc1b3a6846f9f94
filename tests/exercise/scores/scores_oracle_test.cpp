// SPDX-License-Identifier: Apache-2.0
// Scores against scores.py, which calculates them with NumPy from the formulas of docs/exercises.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "exercise/scores/generated_trial.h"
#include "exercise/scores/observation_file.h"
#include "record/temporary_folder.h"

namespace phalanx::test {
namespace {

namespace fs = std::filesystem;

constexpr double kAgreement = 1e-9;  ///< of max(1, |value|)

/// Tables of steps with their tasks, which both programs score.
class Comparison {
 public:
  void add(std::string name, std::vector<Observation> steps, std::vector<ScoredTask> tasks) {
    const std::string number = std::to_string(tables_.size());
    const double begin = steps.front().time;
    for (Observation& step : steps) step.time -= begin;  // as of an exercise, which begins at 0
    write_observations(folder_ / ("t" + number + ".csv"), steps);
    std::ofstream list(folder_ / ("t" + number + ".json"));
    for (std::size_t i = 0; i < tasks.size(); ++i) list << (i == 0 ? "[" : ",\n") << tasks[i].json;
    list << "]\n";
    arguments_.append(" t").append(number).append(".csv t").append(number).append(".json");
    tables_.push_back({std::move(name), std::move(steps), std::move(tasks)});
  }

  /// Runs scores.py and compares each of its lines with the score of the same name.
  void expect_agreement() {
    const std::string command = "cd '" + folder_.path().string() +
                                "' && /usr/bin/python3 '" PHALANX_SOURCE_DIR "/tests/exercise/scores.py'" +
                                arguments_ + " >scores.csv 2>errors";
    ASSERT_EQ(std::system(command.c_str()), 0)  // NOLINT(cert-env33-c): the command is the test's own
        << ::phalanx::testing::read_file(folder_ / "errors");
    std::ifstream lines(folder_ / "scores.csv");
    std::string line;
    std::getline(lines, line);
    ASSERT_EQ(line, "table,trial,score,value,origin,reason");
    for (std::size_t t = 0; t < tables_.size(); ++t)
      for (std::size_t k = 0; k < tables_[t].tasks.size(); ++k)
        for (const Score& score : tables_[t].tasks[k].scores(tables_[t].steps)) {
          ASSERT_TRUE(std::getline(lines, line)) << "scores.py has too few scores";
          compare(score, line, fmt::format("{},{},{},", t, k, score.name), tables_[t].name);
        }
    EXPECT_FALSE(std::getline(lines, line)) << "scores.py has one more: " << line;
  }

  [[nodiscard]] int valid() const { return valid_; }
  [[nodiscard]] int invalid() const { return invalid_; }
  [[nodiscard]] double largest() const { return largest_; }
  /// Returns how many values of scores whose name begins so were compared.
  [[nodiscard]] int valid_of(std::string_view begin) const {
    int sum = 0;
    for (const auto& [name, number] : by_name_)
      if (name.starts_with(begin)) sum += number;
    return sum;
  }
  [[nodiscard]] std::string summary() const {
    return fmt::format("{} values agree to {:.2g} ({}), {} are invalid in both", valid_, largest_, worst_,
                       invalid_);
  }

 private:
  struct Table {
    std::string name;
    std::vector<Observation> steps;
    std::vector<ScoredTask> tasks;
  };

  void compare(const Score& score, const std::string& line, const std::string& begin,
               const std::string& table) {
    ASSERT_TRUE(line.starts_with(begin)) << line << " instead of " << begin;
    const std::size_t end = line.find(',', begin.size());
    const std::string value = line.substr(begin.size(), end - begin.size());
    EXPECT_EQ(score.valid(), !value.empty())
        << table << ": " << line << "; here: " << score.value << ' ' << score.invalid;
    if (!score.valid() || value.empty()) {
      ++invalid_;
      return;
    }
    ++valid_;
    ++by_name_[score.name];
    const double difference = std::abs(score.value - std::stod(value)) / std::max(1.0, std::abs(score.value));
    EXPECT_LE(difference, kAgreement)
        << table << ": " << line << "; here: " << fmt::format("{:.17g}", score.value);
    EXPECT_EQ(line.substr(end + 1, line.find(',', end + 1) - end - 1), score_origin_name(score.origin))
        << line;
    if (difference > largest_) worst_ = score.name;
    largest_ = std::max(largest_, difference);
  }

  ::phalanx::testing::TemporaryFolder folder_;
  std::vector<Table> tables_;
  std::string arguments_;
  int valid_ = 0;
  int invalid_ = 0;
  double largest_ = 0.0;
  std::string worst_;
  std::map<std::string, int> by_name_;
};

TEST(ScoresOracle, FiftyGeneratedTablesHaveTheSameScoresWithNumPy) {
  Comparison comparison;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto steps = generated_steps(seed);
    comparison.add(fmt::format("seed {}", seed), steps, generated_tasks(seed, steps));
  }
  comparison.expect_agreement();
  RecordProperty("agreement", comparison.summary());
  EXPECT_GT(comparison.valid(), 1000) << "most of what is compared are values";
  EXPECT_GT(comparison.invalid(), 100);
  for (const char* name : {"rom_",
                           "max_",
                           "min_",
                           "tam_",
                           "flexion_",
                           "deficit_",
                           "mean_force_n",
                           "sd_force_n",
                           "cv",
                           "rise_time_s",
                           "rmse_n",
                           "rrmse",
                           "time_in_target_s",
                           "time_in_target_share",
                           "lag_s",
                           "correlation",
                           "peak_force_n",
                           "release_time_s",
                           "release_delay_s",
                           "hold_time_s",
                           "grip_force_n",
                           "force_ratio",
                           "slips",
                           "opposition_",
                           "instructed_range_deg",
                           "enslaving_",
                           "individuation_index",
                           "sparc",
                           "movement_time_s",
                           "peak_speed_deg_per_s",
                           "speed_peaks"})
    EXPECT_GT(comparison.valid_of(name), 9) << name;
}

/// Column of the recordings for each joint. Of the thumb's rotation no joint is left out; wrist and palm are.
constexpr std::array<const char*, kJoints> kGloveColumns = {
    "thumb_rotation",  "thumb_abduction", "thumb_mcp",        "thumb_ip",       "index_mcp",
    "index_abduction", "index_pip",       "index_dip",        "middle_mcp",     "middle_abduction",
    "middle_pip",      "middle_dip",      "ring_mcp",         "ring_abduction", "ring_pip",
    "ring_dip",        "little_mcp",      "little_abduction", "little_pip",     "little_dip"};

/// Returns the folder of recordings of real hands, an empty path where there is none.
fs::path glove_folder() {
  if (const char* named = std::getenv("PHALANX_GLOVE_DATA"); named != nullptr) return named;
  for (const char* place : {"/shared/data/glove", "/../shared/data/glove"})
    if (const fs::path folder = std::string(PHALANX_SOURCE_DIR).append(place); fs::is_directory(folder))
      return folder;
  return {};
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

/// Returns a recording's steps. Forces and pads, which the glove has not, follow from the angles: 4 N/rad of
/// flexion, and a chain in a plane. The origin counts as measured.
std::vector<Observation> glove_steps(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const auto head = cells_of(line);
  std::vector<Observation> steps;
  while (std::getline(in, line)) {
    const auto cells = cells_of(line);
    Observation step = running_step(std::stod(cells.at(0)));
    step.tick = steps.size();
    for (std::size_t joint = 0; joint < kJoints; ++joint) {
      const auto column = std::find(head.begin(), head.end(), kGloveColumns[joint]) - head.begin();
      step.angle[joint] = -std::stod(cells.at(static_cast<std::size_t>(column)));
    }
    for (int digit = 0; digit < kDigits; ++digit) {
      double turned = 0.0;
      Vec3 pad(0.0, 0.02 * digit, 0.0);
      for (const int i : {0, 2, 3}) {
        turned += step.angle[idx(joint_index(digit, i))];
        pad += 0.03 * Vec3(std::cos(turned), 0.0, std::sin(turned));
      }
      step.pad[idx(digit)] = pad;
      step.force[idx(digit)] = std::max(0.0, 4.0 * turned);
      step.touching[idx(digit)] = turned > 0.0;
    }
    steps.push_back(step);
  }
  return steps;
}

TEST(ScoresOracle, RecordingsOfRealHandsHaveTheSameScoresWithNumPy) {
  const fs::path folder = glove_folder();
  if (folder.empty())
    GTEST_SKIP() << "there are no recordings of a glove; name their folder in PHALANX_GLOVE_DATA";
  Comparison comparison;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty()) << folder;
  for (const fs::path& file : files) {
    // Trials begin where the time goes back, as in a file of several.
    std::vector<std::vector<Observation>> trials(1);
    for (const Observation& step : glove_steps(file)) {
      if (!trials.back().empty() && step.time <= trials.back().back().time) trials.emplace_back();
      trials.back().push_back(step);
    }
    for (std::size_t k = 0; k < trials.size(); ++k) {
      std::vector<ScoredTask> tasks = generated_tasks(100, trials[k]);
      const std::vector<ScoredTask> more = generated_tasks(102, trials[k]);
      tasks.insert(tasks.end(), more.begin(), more.end());
      comparison.add(fmt::format("{} trial {}", file.filename().string(), k), trials[k], tasks);
    }
  }
  comparison.expect_agreement();
  RecordProperty("agreement", comparison.summary());
  EXPECT_GT(comparison.valid(), 100);
}

}  // namespace
}  // namespace phalanx::test
