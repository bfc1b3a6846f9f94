// SPDX-License-Identifier: Apache-2.0
// What assessments have measured, taken over again from their recordings: own force, own range, entry check.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/record/recorded_exercise.h"
#include "phalanx/registry/registry.h"

namespace phalanx {

/// Measurements of the recordings whose results a registry did not have: after a kill, or from a time after a
/// restored backup. What the registry had is left as it is, since a person may have changed it afterwards.
class RebuiltMeasurements {
 public:
  /// Remembers the results that the registry has now. A patient whose results cannot be read gets nothing.
  RebuiltMeasurements(Registry& registry, const Actor& actor);

  /// Reads the rows of a recording: RecordedResultsOf for Registry::rebuild(). It keeps the assessments.
  /// @throws std::runtime_error as recorded_exercises()
  [[nodiscard]] std::vector<ResultRow> read(const std::filesystem::path& recording,
                                            const FindRecordingKey& keys);

  /// Takes over what the assessments that were read have measured, in the order of their dates, as far as the
  /// rebuild has given them rows and take_late() permits it.
  /// @returns the codes of the changed patients
  /// @throws RegistryError as Registry::edit_patient()
  [[nodiscard]] std::vector<std::string> take_over();

 private:
  [[nodiscard]] bool take_over_of(Patient& patient, std::vector<ResultRow> known) const;

  Registry& registry_;
  const Actor& actor_;
  std::map<std::string, std::vector<ResultRow>> known_;  ///< before the rebuild, by record id
  /// Assessments, each with the file name of its recording.
  std::vector<std::pair<std::string, RecordedExercise>> read_;
};

}  // namespace phalanx
