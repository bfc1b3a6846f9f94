// SPDX-License-Identifier: Apache-2.0
// The patients of `phalanx run`: its page gets them with --data.
#pragma once

#include <memory>
#include <vector>

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

}  // namespace phalanx
