// SPDX-License-Identifier: Apache-2.0
#include "apps/month/month_program.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace phalanx::testing {
namespace {

constexpr std::int64_t kFirstDay = 1'772'323'200;  // 2026-03-01T00:00:00Z [s since 1970]

std::string exported(const std::string& recording) {
  return std::filesystem::path(recording).filename().string();
}

}  // namespace

MonthProgram::MonthProgram() { set_date(1); }

void MonthProgram::set_date(int day, double hour) const {
  const std::int64_t date = kFirstDay + 86'400 * (day - 1) + std::llround(3600.0 * hour);
  const std::int64_t shift = date - static_cast<std::int64_t>(std::time(nullptr));
  // In place: running programs have mapped the file.
  std::fstream file(folder / "date", std::ios::in | std::ios::out | std::ios::binary);
  if (!file.is_open()) file.open(folder / "date", std::ios::out | std::ios::binary);
  file.write(reinterpret_cast<const char*>(&shift), sizeof(shift));
}

std::vector<std::string> MonthProgram::environment() const {
  return {fmt::format("HOME={}", (folder / "home").string()),
          fmt::format("PHALANX_PATIENTS_DIR={}", (folder / "data").string()),
          fmt::format("PHALANX_KEYS={}", (folder / "keys/patients").string()),
          fmt::format("PHALANX_DATA_DIR={}", PHALANX_SOURCE_DIR),
          fmt::format("PHALANX_SHIFTED_DATE={}", (folder / "date").string())};
}

ProgramResult MonthProgram::phalanx(const std::string& command) const {
  return run(command, fmt::format("PHALANX_SHIFTED_DATE='{}' LD_PRELOAD='{}'", (folder / "date").string(),
                                  PHALANX_SHIFTED_DATE_LIBRARY));
}

std::string MonthProgram::done_today(const std::string& command) const {
  const ProgramResult result = phalanx(command);
  EXPECT_EQ(result.exit_code, 0) << command << ": " << result.err << result.out;
  return result.out;
}

std::vector<std::string> MonthProgram::exercise_command(const std::string& arguments) const {
  std::vector<std::string> command{PHALANX_PROGRAM, "exercise",  "run",      "--no-realtime", "--no-foxglove",
                                   "--rate-hz",     "200",       "--record", "rec",           "--patient",
                                   code_,           "--confirm", code_};
  std::istringstream words(arguments);
  for (std::string word; words >> word;) command.push_back(word);
  return command;
}

ProgramResult MonthProgram::exercise(const std::string& arguments, const std::string& before) const {
  std::string command = fmt::format("unset PHALANX_PASSPHRASE PHALANX_PASSWORD; {};", before);
  for (const std::string& variable : environment()) command.append(fmt::format(" export '{}';", variable));
  command.append(fmt::format(" '{}' -- /usr/bin/env LD_PRELOAD='{}:{}'", PHALANX_HELD_CLOCK_PROGRAM,
                             PHALANX_SHIFTED_DATE_LIBRARY, PHALANX_HELD_CLOCK_LIBRARY));
  for (const std::string& word : exercise_command(arguments)) command.append(fmt::format(" '{}'", word));
  return run_command(folder, command);
}

void MonthProgram::session(const std::string& name, double skill, int seed) const {
  SCOPED_TRACE(fmt::format("{}, skill {}, seed {}", name, skill, seed));
  const auto result = exercise(fmt::format("{} --demo {} --seed {}", name, skill, seed));
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_THAT(result.out,
              ::testing::AllOf(::testing::HasSubstr("byte for byte"),
                               ::testing::HasSubstr(fmt::format("kept in the registry for {}", code_))))
      << result.err;
}

std::vector<std::string> MonthProgram::recordings() const {
  std::vector<std::string> found;
  if (!std::filesystem::exists(folder / "rec")) return found;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "rec"))
    if (entry.path().extension() != ".torn") found.push_back("rec/" + entry.path().filename().string());
  std::sort(found.begin(), found.end());
  return found;
}

nlohmann::json MonthProgram::results() const {
  return nlohmann::json::parse(done_today(fmt::format("patient results {} --json", code_)));
}

nlohmann::json MonthProgram::rows_of(const std::string& recording) const {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& row : results())
    if (row["recording"] == exported(recording)) rows.push_back(row);
  return rows;
}

void MonthProgram::rebuild() const {
  for (const std::string& file : recordings())
    if (file.ends_with(".enc")) done_today("session repair --keys keys/patients " + file);
  done_today("patient rebuild rec");
  const nlohmann::json rows = results();
  done_today("patient rebuild rec");
  EXPECT_EQ(results(), rows) << "nothing is doubled";
}

nlohmann::json MonthProgram::compare() const {
  write_file(folder / "results.json", results().dump());
  for (const std::string& file : recordings())
    done_today(fmt::format(
        "session export --quiet --parts observations,events --keys keys/patients --out exports/{} {}",
        exported(file), file));
  const ProgramResult compared = run_command(folder, "/usr/bin/python3 '" PHALANX_SOURCE_DIR
                                                     "/tests/apps/month/month.py' '" PHALANX_SOURCE_DIR
                                                     "/tests/exercise/scores.py' results.json exports");
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  return compared.exit_code == 0 ? nlohmann::json::parse(compared.out) : nlohmann::json::object();
}

}  // namespace phalanx::testing
