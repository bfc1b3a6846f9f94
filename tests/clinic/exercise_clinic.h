// SPDX-License-Identifier: Apache-2.0
// A station that goes on running, with patients and their exercises, under a held clock.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/clinic/station_exercises.h"
#include "phalanx/record/run_recorder.h"
#include "phalanx/scene/data_paths.h"
#include "record/temporary_folder.h"
#include "serve/people_registry.h"
#include "station/session_fixture.h"

namespace phalanx::test {

/// Fixture of a station with StationExercises. Its exercises are those of assets/exercises, and `short`: two presses of
/// 3 s, with forces.
class ExerciseClinic : public SessionFixture {
 protected:
  using Stage = ExerciseStatus::Stage;
  using Kind = ExerciseInput::Kind;

  ExerciseClinic() { make_data(); }
  ~ExerciseClinic() override {
    end();
    ::unsetenv("PHALANX_DATA_DIR");
  }

  /// Starts a station of the simulated device with a registry of SIM1 and SIM2, whose hand is the right one.
  void begin_station() {
    namespace fs = std::filesystem;
    registry = make_registry(folder.path() / "clinic", clocks);
    sim1 = add_patient("SIM1");
    sim2 = add_patient("SIM2");
    SessionSettings settings = with("simulated", "first_touch");
    settings.overrides = {{"rate_hz", "200"}};
    settings.keep_changes = true;
    start(settings);
    recorder->begin(*session, clock, recordings());
    exercises = std::make_unique<StationExercises>(*session, *recorder, registry, clinic_settings());
  }
  Patient add_patient(const std::string& code) {
    Patient patient = ready_patient(code);
    patient.own_force_n.fill(4.0);
    return registry->add_patient(Actor::owner(), patient);
  }
  [[nodiscard]] RecorderSettings recordings() const {
    return {
        .folder = folder / "rec", .least_room = 0, .foxglove = false, .metadata = recording_metadata("test")};
  }
  virtual StationExercisesSettings clinic_settings() {
    StationExercisesSettings settings;
    settings.recording = recordings();
    settings.overrides = {{"rate_hz", "200"}};
    settings.utc = [this] { return clocks->utc.load(); };
    settings.say = [this](const std::string& text, bool) { said.push_back(text); };
    return settings;
  }
  void own() override {
    session->poll();
    if (exercises) exercises->tick();
    if (auto report = session->take_fault_report()) reports.push_back(std::move(*report));
  }
  /// Ends the program in good order.
  void end() {
    if (!session || ended) return;
    ended = true;
    session->shut_down();
    recorder->finish(true);
    if (exercises) exercises->end();
    recorder.reset();
  }

  std::uint32_t order(const Patient& patient, const std::string& demo = "healthy",
                      const std::string& exercise = "short") {
    return exercises->begin(
        Actor::owner(),
        {.record = patient.record, .exercise = exercise, .confirm = patient.code, .demo = demo, .seed = 7});
  }
  void input(Kind kind, double value = 0.0) { exercises->input({.kind = kind, .value = value}); }
  [[nodiscard]] ExerciseStatus status() const { return exercises->status(); }
  bool until_stage(Stage stage) {
    const bool came = until([&] { return status().stage == stage || status().stage == Stage::kEnded; });
    EXPECT_EQ(status().trouble, "");
    return came && status().stage == stage;
  }
  bool until_phase(ExercisePhase phase) {
    return until([&] { return status().view.phase == phase || status().stage == Stage::kEnded; }) &&
           status().view.phase == phase;
  }
  /// Begins `short`, and waits for its first press with forces.
  void begin_exercise(const Patient& patient) {
    static_cast<void>(order(patient));
    ASSERT_TRUE(until_stage(Stage::kRunning));
    input(Kind::kBegin);
    ASSERT_TRUE(until_phase(ExercisePhase::kTrial));
    ASSERT_TRUE(until([&] { return session->view().state == SafetyState::kRunning; }));
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "rec"))
      found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
  }
  [[nodiscard]] std::vector<ResultRow> results(const Patient& patient) const {
    return registry->results(Actor::owner(), patient.record);
  }
  /// @returns the finder of one patient's key
  [[nodiscard]] FindRecordingKey key_of(const Patient& patient) const {
    const RecordingEncryption key = registry->recording_key(Actor::owner(), patient.record);
    return [key](const std::string& id) -> std::optional<RecordingKey> {
      return id == key.id ? std::optional(key.key) : std::nullopt;
    };
  }

  const testing::TemporaryFolder folder;
  const std::shared_ptr<RegistryClocks> clocks = std::make_shared<RegistryClocks>();
  std::shared_ptr<Registry> registry;
  Patient sim1;
  Patient sim2;
  std::unique_ptr<RunRecorder> recorder = std::make_unique<RunRecorder>("", std::filesystem::path());
  std::unique_ptr<StationExercises> exercises;
  std::vector<std::string> said;
  bool ended = false;

 private:
  /// Makes a data folder with the shipped scenes and assets, and one more exercise.
  void make_data() const {
    namespace fs = std::filesystem;
    const fs::path shipped = data_folder();
    const fs::path data = folder / "share";
    fs::create_directories(data / "assets/exercises");
    fs::create_directories(data / "scenes");  // a test may add one
    for (const auto& entry : fs::directory_iterator(shipped / "scenes"))
      fs::create_symlink(entry.path(), data / "scenes" / entry.path().filename());
    for (const auto& entry : fs::directory_iterator(shipped / "assets"))
      if (entry.path().filename() != "exercises")
        fs::create_symlink(entry.path(), data / "assets" / entry.path().filename());
    for (const auto& entry : fs::directory_iterator(shipped / "assets/exercises"))
      fs::create_symlink(entry.path(), data / "assets/exercises" / entry.path().filename());
    std::ofstream(data / "assets/exercises/short.toml")
        << "format = 1\ntitle = \"Short\"\nkind = \"assessment\"\nmeasure = \"press_and_hold\"\n"
           "scene = \"index_ball\"\ndigits = \"index\"\ninstruction = \"Press and hold.\"\n"
           "trials = 2\ntrial_s = 3\nrest_s = 0.5\nwarm_up_s = 0\n";
    ::setenv("PHALANX_DATA_DIR", data.c_str(), 1);
  }
};

}  // namespace phalanx::test
