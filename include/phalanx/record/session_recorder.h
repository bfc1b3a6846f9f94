// SPDX-License-Identifier: Apache-2.0
// The recording of a session: one MCAP file (docs/recording.md), written while the station runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/device/clock.h"
#include "phalanx/record/recording_keys.h"
#include "phalanx/station/session.h"

namespace phalanx {

class ChangeReader;

namespace mcap {
class WritableFile;
}

/// Settings of a SessionRecorder.
struct RecorderSettings {
  std::filesystem::path folder;             ///< is made if it does not exist
  std::uint64_t least_room = 1U << 30U;     ///< free bytes below which no recording begins
  std::optional<std::uint64_t> quota = {};  ///< bytes of all recordings of the folder at which none begins
  bool foxglove = true;  ///< with frames, meshes and forces for tools that read Foxglove's schemas
  /// Stated in the file outside its chunks: version, commit, machine. Nothing about a person may stand here.
  std::map<std::string, std::string> metadata;
  /// Encrypts the file, whose name then ends with ".mcap.enc"; none: it is written as it is.
  std::optional<RecordingEncryption> encryption = {};
};

/// Makes the folder of recordings if it does not exist, and checks that a recording can begin there.
/// @throws std::invalid_argument for a folder that cannot be written, or too little room, with the remedy
void check_recordings_folder(const RecorderSettings& settings);

/// @returns the origin of a recording for RecorderSettings::metadata: program, machine, and what is exact in the file
[[nodiscard]] std::map<std::string, std::string> recording_metadata(const std::string& version);

/// What people are told of a recording.
struct RecordingStatus {
  std::filesystem::path file;
  std::uint64_t bytes = 0;       ///< on the disk for good
  std::uint64_t free_bytes = 0;  ///< of the file system, or of the quota if that is less
  double unsaved = 0.0;          ///< age of the oldest step that is not on the disk for good [s]
  std::uint64_t lost_steps = 0;  ///< that are not in the file: Gap
  std::string trouble;           ///< why the disk refuses; empty: it does not
};

/// Writes all steps of a session, with their samples, and the changes; besides the shown hand and its contacts about 60
/// times a second. Chunks are closed and synchronised every 0.2 s.
///
/// If the disk refuses a chunk, it is kept and tried again every 0.2 s, and the steps that come wait in up to
/// kMostWaitingBytes of memory; those beyond it are lost, and a Gap names them.
///
/// The recorder's thread calls add(), update() and finish(); any thread the others. Not real-time: nothing here is called
/// by the station's loop.
class SessionRecorder {
 public:
  static constexpr double kChunkSeconds = 0.2;  ///< [s]
  static constexpr std::size_t kMostWaitingBytes = 64U
                                                   << 20U;  ///< of steps that the disk does not take [bytes]

  /// Begins the file `<folder>/<UTC date and time>.mcap`, or `.mcap.enc`.
  /// @param session  of SessionSettings::keep_changes; outlives the recorder, as does `clock`
  /// @throws std::invalid_argument for a folder that cannot be written, or too little room, with the remedy;
  /// std::runtime_error, likewise, if the disk refuses
  /// @param changes  shared by recorders that follow each other; null: this one is the session's only recorder
  SessionRecorder(RecorderSettings settings, Session& session, const Clock& clock,
                  std::shared_ptr<ChangeReader> changes = {});
  /// The same into a file that is given, encrypted if the settings say so. For tests. @param name  RecordingStatus::file
  SessionRecorder(RecorderSettings settings, Session& session, const Clock& clock, std::filesystem::path name,
                  std::unique_ptr<mcap::WritableFile> file, std::shared_ptr<ChangeReader> changes = {});
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;
  ~SessionRecorder();  ///< does not finish(): the file then has no end

  /// Adds a step, as Session::next_record() gave it. @throws std::bad_alloc; a Gap then names the step
  void add(const StepRecord& record, std::span<const DeviceSample> samples);
  /// Adds what is due beside the steps, and writes the chunk if it is. Call it 60 times a second. @throws std::bad_alloc;
  /// what was due is then missing, but no step
  void update();
  /// Ends the recording before the first step of this station: finish() then writes no change of it or of later ones, and
  /// names the steps that are missing before it. Another recorder with the same ChangeReader takes over. No add() or
  /// update() follows. @throws std::bad_alloc; it may be called again
  void end_before(std::uint64_t station);
  /// Writes the rest and the file's end. Call it after Session::shut_down() or end_before().
  /// @returns false if the disk refuses, or there is no memory (RecordingStatus::trouble); it may be called again then
  bool finish() noexcept;

  /// Removes the file of a recorder that got no step. It is of no use afterwards.
  void discard() noexcept;

  /// Adds something that happened. @param who  as in cockpit.proto's Notice
  void event(const std::string& code, const std::string& who, const std::string& text);
  [[nodiscard]] RecordingStatus status() const;

 private:
  struct Impl;
  static std::unique_ptr<Impl> begun(RecorderSettings settings, Session& session, const Clock& clock,
                                     std::shared_ptr<ChangeReader> changes);

  const std::unique_ptr<Impl> impl_;
};

}  // namespace phalanx
