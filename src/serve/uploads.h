// SPDX-License-Identifier: Apache-2.0
// Meshes that pages send: reading the request, checking the mesh in a process of its own, keeping the file,
// and the thread on which that is done.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "phalanx/mesh/import_cache.h"
#include "phalanx/scene/scene.h"
#include "phalanx/serve/web_server.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Mesh that a page has sent, and how to read it.
struct UploadedMesh {
  std::string name;  ///< of the file on the sender's computer; only letters, digits, - and _ of it are used
  std::string bytes;
  double size_mm = 0.0;    ///< largest extent [mm]; 0: as in the file
  std::string unit = "m";  ///< of the file's numbers
};

/// Reads the query of an upload: "name=mug.stl&size_mm=90", percent-coded.
/// @throws std::invalid_argument that names the wrong value
[[nodiscard]] UploadedMesh upload_of(const std::string& query, std::string bytes);

/// Function that returns SessionInfo::values of the station, or none if the upload has been abandoned.
using ValuesInForce = std::function<std::optional<Overrides>()>;

constexpr std::size_t kMostUploadedTriangles = 500'000;  ///< more would take minutes to check

/// Imports a mesh in a process of its own. If a scene could use it, writes the file into the folder and
/// keeps the imported mesh in the cache: a scene with this file, size and unit needs no other import. Keeps
/// the newest 50 uploads in the folder and those that the scene in force names. Does not touch files with
/// names of another form. Does not throw for a mesh that is refused. Forks; takes long.
/// @param in_force  called before each step, so that an abandoned upload ends with its step
/// @returns a JSON object: "ok"; "error" (if not ok); "file", the value for objects.N.file; "report" and
/// "preview", see docs/meshes.md
[[nodiscard]] std::string take_upload(const UploadedMesh& mesh, const std::filesystem::path& folder,
                                      const ValuesInForce& in_force, ImportCache& imports);

/// State of one upload, which the cockpit and the upload's thread share: either may outlive the
/// other. Any thread.
class UploadJob {
 public:
  explicit UploadJob(const Session& session) : session_(&session) {}

  /// @returns SessionInfo::values; none if the job has been abandoned
  [[nodiscard]] std::optional<Overrides> values() const;
  [[nodiscard]] bool done() const;
  void finish();
  /// Abandons the job: it does not use the session any more and ends with its current step. Waits for that end,
  /// but no longer than `wait`.
  void abandon(std::chrono::milliseconds wait);

 private:
  mutable std::mutex mutex_;
  std::condition_variable done_changed_;
  const Session* session_;  ///< null: abandoned
  bool done_ = false;
};

/// Starts the work of a job on a detached thread.
/// @param work     owns all that it uses
/// @param respond  called with the result after the job is done, so that the next upload may begin
void start_upload(const std::shared_ptr<UploadJob>& job,
                  std::function<WebResponse(const ValuesInForce&)> work,
                  std::function<void(WebResponse)> respond);

}  // namespace phalanx
