// SPDX-License-Identifier: Apache-2.0
// The recording of a program that calls step() itself: the same MCAP file as that of a session
// (docs/recording.md), without a station.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "phalanx/scene/scene.h"
#include "phalanx/station/session.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// What a recording of own steps states at its beginning.
struct StepRecorderSettings {
  std::string scene;  ///< its name, for people
  Overrides values;   ///< of the scene's keys, as TOML: they have the parameters of the first step
  std::map<std::string, std::string> metadata;  ///< recording_metadata()
};

/// A step, and what it depended on besides the steps before.
struct OwnStep {
  const Sample& sample;
  const Snapshot& snapshot;   ///< the result
  double stiffness = 0.0;     ///< of the force law at this step [N/m]
  unsigned confirmed = 0;     ///< digits whose opening was confirmed since the last step: bit d for digit d
  bool withdrawn = false;     ///< all openings were withdrawn since the last step, before `confirmed`
  std::uint64_t changed = 0;  ///< number of the change() that it began; 0: none
};

/// Writes steps of a program, each with its sample, so that a replay makes them again; besides the shown
/// hand and its contacts about 60 times a second of the samples' time. One thread. Not real-time: add()
/// waits for the disk.
class StepRecorder {
 public:
  /// Begins the file.
  /// @param file      does not exist yet
  /// @param geometry  of the model; its rate is that of the steps
  /// @throws std::invalid_argument if the name does not end with ".mcap"; std::runtime_error if the file
  /// cannot be made
  StepRecorder(const std::filesystem::path& file, const SessionGeometry& geometry,
               StepRecorderSettings settings);
  StepRecorder(StepRecorder&&) noexcept;
  StepRecorder& operator=(StepRecorder&&) noexcept;
  StepRecorder(const StepRecorder&) = delete;
  StepRecorder& operator=(const StepRecorder&) = delete;
  ~StepRecorder();  ///< does not finish(): the file then has no end

  /// Adds a change of parameters, before the step that begins it.
  /// @param number  from 1 on, rising;  @param values  as StepRecorderSettings::values
  void change(std::uint64_t number, const Overrides& values);
  /// Adds a step. Ticks that were left out are stated in the file.
  /// @throws std::runtime_error if the disk refuses; the step is kept, and written with the next one. Also after
  /// finish(); nothing is added then
  void add(const OwnStep& step);
  /// Adds something that happened, at the time of the last step. @param who  may be empty
  /// @throws std::runtime_error after finish()
  void event(const std::string& code, const std::string& who, const std::string& text);
  /// Writes the rest and the file's end, and closes the file. A second call has no effect.
  /// @throws std::runtime_error if the disk refuses; it may be called again then
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace phalanx
