// SPDX-License-Identifier: Apache-2.0
// Folders, clocks and examples of the registry's tests.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/registry/registry.h"
#include "record/temporary_folder.h"

namespace phalanx::testing {

/// Folder in memory where the system has one: tests synchronise thousands of times.
class MemoryFolder {
 public:
  MemoryFolder() {
    const std::filesystem::path memory = "/dev/shm";
    const bool usable = ::access(memory.c_str(), W_OK) == 0;
    path_ = ((usable ? memory : std::filesystem::temp_directory_path()) / "phalanx-registry-XXXXXX").string();
    if (::mkdtemp(path_.data()) == nullptr)
      throw std::runtime_error("there is no place for the test's files");
  }
  ~MemoryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return std::filesystem::path(path_) / name;
  }

 private:
  std::string path_;
};

/// Opens a key file, or makes it.
inline KeyStore keys_of(const std::filesystem::path& file) {
  return std::filesystem::exists(file) ? KeyStore::open(file) : KeyStore::create(file);
}

/// Data folder and key file of one test, with clocks that stand still.
class RegistryFiles {
 public:
  [[nodiscard]] RegistrySettings settings() {
    return {.folder = data(),
            .password_cost = Argon2Cost::least(),
            .utc = [this] { return utc; },
            .steady = [this] { return steady; }};
  }
  [[nodiscard]] KeyStore keys() const { return keys_of(keys_file()); }
  [[nodiscard]] Registry open() { return Registry(settings(), keys()); }

  [[nodiscard]] std::filesystem::path data() const { return folder / "data"; }
  [[nodiscard]] std::filesystem::path keys_file() const { return folder / "config/keys"; }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder / name; }

  double utc = 1'777'887'000.0;  ///< 2026-05-04T09:30:00Z
  double steady = 1000.0;

 private:
  MemoryFolder folder;
};

inline const Actor kOwner = Actor::owner();

inline Patient example_patient(const std::string& code = "P07") {
  Patient out;
  out.code = code;
  out.side = Handedness::kLeft;
  out.symbol = "boat";
  out.calibration = "left_p07.toml";
  out.calibration_expires = "2026-12-31";
  out.own_force_n = {0.0, 11.5, 0.0, 0.0, 0.0};
  out.force_limit_n = 8.0;
  out.warnings = {"fragile skin"};
  out.prescription.push_back({.exercise = "press_and_hold",
                              .repetitions_per_day = 30,
                              .minutes_per_day = 12.5,
                              .overrides = {{"target", "0.3"}},
                              .note = "slowly"});
  out.entry = EntryCheck{.flexion_deg = 41.0, .release_deg = 30.0, .date = "2026-05-04", .suitable = true};
  out.note = "left hand after a stroke";
  return out;
}

inline ResultRow example_result(const std::string& recording, int number = 1, double value = 3.25) {
  ResultRow out;
  out.recording = recording;
  out.number = number;
  out.exercise = "press_and_hold";
  out.assessment = true;
  out.date = 1'777'888'000.0;
  out.scores = {
      {.name = "mean_n", .unit = "N", .value = value, .origin = ScoreOrigin::kRendered, .invalid = {}},
      {.name = "rise_time_s", .unit = "s", .invalid = "not measured: the target was not reached"}};
  out.conditions = {.device = "simulated",
                    .serial = "S1",
                    .calibration_method = "jig",
                    .contact_mode = "gdp",
                    .stabiliser = "smoothing",
                    .rendering = "1",
                    .protocol = "00c0ffee00c0ffee"};
  out.seconds = 61.5;
  out.repetitions = 5;
  out.successes = 3;
  out.detail = R"({"trials":[1,2,3]})";
  return out;
}

/// @returns all regular files below a folder
inline std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  if (!std::filesystem::exists(folder)) return out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

/// @returns the files below a folder whose bytes or name hold a text
inline std::vector<std::string> files_with(const std::filesystem::path& folder, const std::string& text) {
  std::vector<std::string> out;
  for (const auto& file : files_below(folder))
    if (read_file(file).find(text) != std::string::npos ||
        file.lexically_relative(folder).string().find(text) != std::string::npos)
      out.push_back(file.string());
  return out;
}

/// @returns the files below a folder that others may read or write
inline std::vector<std::string> open_to_others(const std::filesystem::path& folder) {
  std::vector<std::string> out;
  for (const auto& file : files_below(folder)) {
    struct stat state{};
    if (::stat(file.c_str(), &state) == 0 && (state.st_mode & 0777U) != 0600U) out.push_back(file.string());
  }
  return out;
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

/// @returns all that a registry knows of its patients, without random numbers
inline std::string state_text(Registry& registry, const Actor& actor = kOwner) {
  std::string out;
  for (Patient& patient : registry.patients(actor)) {
    const std::string record = std::exchange(patient.record, "");
    out += patient_json(patient) + "\n";
    for (const ResultRow& row : registry.results(actor, record)) out += " " + result_json(row) + "\n";
    for (const EnteredTest& test : registry.tests(actor, record)) out += " " + test_json(test) + "\n";
    for (const PatientNote& note : registry.notes(actor, record)) out += " " + note_json(note) + "\n";
  }
  return out;
}

/// @returns the kind of refusal of a call; fails the test if it succeeds
template <typename Function>
RegistryFault fault_of(const Function& function) {
  try {
    function();
  } catch (const RegistryError& error) {
    EXPECT_STRNE(error.what(), "");
    return error.fault();
  }
  ADD_FAILURE() << "it was not refused";
  return RegistryFault::kDisk;
}

}  // namespace phalanx::testing
