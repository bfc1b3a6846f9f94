// SPDX-License-Identifier: Apache-2.0
// The patients of `phalanx run`, and their exercises: its page gets them with --data.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "phalanx/clinic/station_exercises.h"
#include "phalanx/registry/registry.h"
#include "phalanx/serve/cockpit.h"
#include "run/run_options.h"

namespace phalanx {

/// Opens the registry of --data and its key file. A folder without a registry gets one, and standard
/// error states where.
/// @returns null without --data
/// @throws std::invalid_argument if --keys is given without --data, or as read_secret() for a passphrase;
/// RegistryError as KeyStore::open() and Registry. A registry whose key file is missing is refused: a new one
/// could not read its patients
[[nodiscard]] std::shared_ptr<Registry> open_run_registry(const RunOptions& options);

/// @returns the exercises of assets/exercises that can be read, by name; none if the folder is not found.
/// Reads the disk
[[nodiscard]] std::vector<ListedExercise> exercises_for_pages();

/// Makes what carries out exercises of patients on the station.
/// @param registry  null: there is none
/// @param say       gets messages for people; the owner's thread
/// @returns null without a registry, or with --record off: a result is made from its recording
[[nodiscard]] std::shared_ptr<StationExercises> exercises_of_run(
    const RunOptions& options, Session& session, RunRecorder& recorder, std::shared_ptr<Registry> registry,
    std::function<void(const std::string& text, bool warning)> say);

}  // namespace phalanx
