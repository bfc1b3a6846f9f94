// SPDX-License-Identifier: Apache-2.0
// The journal of one patient: sealed events in a file that is only appended to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "registry/crypto.h"

namespace phalanx::registry {

/// Place in a journal: after so many events, and bytes of the file.
struct JournalPlace {
  std::uint64_t events = 0;
  std::uint64_t bytes = 0;
};

/// What was read of a journal.
struct JournalContent {
  std::string generation = {};           ///< random, of this file
  std::vector<std::string> events = {};  ///< JSON
  std::vector<std::uint64_t> ends = {};  ///< end of each event in the file [bytes]
  JournalPlace place = {};               ///< after the last event that could be read
  std::uint64_t damaged = 0;             ///< events in between that could not be read
  bool torn = false;                     ///< bytes follow that are no whole event
};

/// The journal file of one record:
///
///     "phalanx journal 1 " generation (32 hexadecimal digits) '\n'
///     { length (32 bit, little-endian), sealed event (AES-256-GCM with the record's key) } ...
///
/// Record id, generation and number of the event are authenticated with each event: none can be moved,
/// repeated or left out. append() synchronises. All functions throw RegistryError kDisk, or kNewer for
/// a newer format.
class Journal {
 public:
  Journal(std::filesystem::path file, std::string record, Key key);

  [[nodiscard]] bool exists() const;
  /// @returns generation; empty: there is no file, or it does not begin as a journal
  [[nodiscard]] std::string generation() const;
  [[nodiscard]] std::uint64_t bytes() const;
  /// Reads the events from a place on. A damaged event is left out and counted if its length is right.
  [[nodiscard]] JournalContent read(const JournalPlace& from = {}) const;
  /// Appends one event after a place, which is the file's end. @returns the place after it
  JournalPlace append(const std::string& generation, const JournalPlace& at, const std::string& event);
  /// Puts a new file with these events in the old one's place.
  JournalContent replace(const std::vector<std::string>& events);
  /// Cuts what follows a place.
  void cut(const JournalPlace& at);
  /// Overwrites and removes the file.
  void erase();

 private:
  [[nodiscard]] std::string sealed_event(const std::string& generation, std::uint64_t number,
                                         const std::string& event) const;
  [[nodiscard]] std::string context(const std::string& generation, std::uint64_t number) const;

  std::filesystem::path file_;
  std::string record_;
  Key key_;
};

}  // namespace phalanx::registry
