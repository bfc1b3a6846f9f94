// SPDX-License-Identifier: Apache-2.0
// The recordings of a folder: what is in them, and mending one that has no end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "phalanx/device/motion.h"
#include "phalanx/record/recording_keys.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// @returns true if the name is that of a recording: it ends with ".mcap" or, encrypted, with ".mcap.enc"
[[nodiscard]] bool has_recording_name(const std::filesystem::path& file);

/// @returns the path without the ending of a recording's name, and with `ending`: "a.mcap.enc", ".html" is "a.html"
[[nodiscard]] std::filesystem::path beside_recording(const std::filesystem::path& file,
                                                     const std::string& ending);

/// What a recording is, as its end and its beginning say.
struct RecordingSummary {
  std::filesystem::path file;
  std::uint64_t bytes = 0;  ///< on the disk
  bool written = false;     ///< a program is writing it
  bool begins = false;      ///< it begins as an MCAP file
  bool has_end = false;     ///< false: repair_recording() keeps what is whole
  std::string trouble;      ///< why nothing more is known; empty: all below is
  double begin = 0.0;       ///< UTC [s since 1970]
  double changed = 0.0;     ///< the file's last change, likewise
  double seconds = 0.0;     ///< from the first to the last message
  std::uint64_t steps = 0;
  std::uint64_t events = 0;
  std::uint64_t gaps = 0;
  std::string scene;    ///< of the first station
  std::string device;   ///< of the first station
  std::string version;  ///< of the program
  bool encrypted = false;
  std::string key_id;  ///< of an encrypted one: the id of its key
  bool no_key =
      false;  ///< its key is not here: `trouble` says so; the begin is that of the file's name, and `has_end` of its frames
};

/// @returns in words what may be done with it: "whole", "2 gaps", "being written", "no end: repair", or its trouble
[[nodiscard]] std::string recording_state(const RecordingSummary& recording);

/// Reads the end of a file, and its beginning up to the first station. It changes nothing. Not real-time.
/// @param keys  of encrypted recordings; may be empty
/// @throws std::invalid_argument if there is no such file
[[nodiscard]] RecordingSummary summarise_recording(const std::filesystem::path& file,
                                                   const FindRecordingKey& keys = {});

/// @returns the recordings of a folder, by their begin, oldest first; none if it does not exist
/// @param known  an earlier result: whole files of it that have not changed since are not read again
/// @throws std::invalid_argument if the folder cannot be read
[[nodiscard]] std::vector<RecordingSummary> list_recordings(const std::filesystem::path& folder,
                                                            const std::vector<RecordingSummary>& known = {},
                                                            const FindRecordingKey& keys = {});

/// Result of repair_recording().
struct RepairedRecording {
  bool changed = false;             ///< false: the file was whole
  std::filesystem::path original;   ///< new name of the damaged file
  std::uint64_t chunks = 0;         ///< that were kept
  std::uint64_t lost_bytes = 0;     ///< of the original that are not in the file
  std::vector<std::string> losses;  ///< one line for each part that is lost
  /// The file is encrypted, and its key is not here: whole frames were kept, `chunks` counts them, and indexes and end are
  /// not made. repair_recording() with the key completes it.
  bool needs_key = false;
};

/// Puts a whole file in the place of one that has no end or is damaged: every chunk whose checksum is right is kept. The
/// original is kept as FILE.torn. FILE exists at every moment, also if the power fails: first the damaged file, then the
/// whole one. An encrypted file stays encrypted, under the same id.
/// @throws std::invalid_argument for a file that is being written, or is no recording; std::system_error if the disk fails
[[nodiscard]] RepairedRecording repair_recording(const std::filesystem::path& file,
                                                 const FindRecordingKey& keys = {});

/// A step of the shown hand, about 60 a second.
struct RecordedForce {
  double time = 0.0;   ///< since the beginning of the recording [s]
  DigitArray force{};  ///< sum of the magnitudes on each digit, as sent to the motors [N]
};

/// Something that happened.
struct RecordedEvent {
  double time = 0.0;  ///< since the beginning of the recording [s]
  std::string code;
  std::string who;
  std::string text;
};

/// Forces and events of a recording.
struct RecordingContent {
  std::vector<RecordedForce> forces;
  std::vector<RecordedEvent> events;  ///< with stations that begin, changes and gaps
};

/// Reads a whole recording. @param on_progress  as replay()
/// @throws std::runtime_error if it is not whole, or encrypted and without its key; what() names the place and the remedy
[[nodiscard]] RecordingContent read_recording(const std::filesystem::path& file,
                                              const std::function<void(double)>& on_progress = {},
                                              const FindRecordingKey& keys = {});

/// @returns the angles of the recording's longest station, as its device measured them and its calibration converted them:
/// a key for each sample, by the device's clock
/// @throws std::runtime_error as read_recording(), or if there are fewer than two samples
[[nodiscard]] Motion recorded_motion(const std::filesystem::path& file, const FindRecordingKey& keys = {});

}  // namespace phalanx
