// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/record/recording_keys.h"
#include "phalanx/record/recordings.h"
#include "phalanx/serve/web_server.h"

namespace phalanx {

namespace mcap {
class ReadableFile;
}

/// Keys of encrypted recordings that a request may use.
struct RecordingAccess {
  FindRecordingKey keys = {};  ///< empty: none
  std::string refusal = {};    ///< why there are none, and the remedy; empty: there are no keys at all
};

/// Files of the station for its pages: /recordings is the list of the recordings of a folder as JSON, /recordings/NAME a part of one
/// (HTTP Range), /recordings/NAME?until=BYTES the same of one that is being written, as it was when it had so many bytes, with an
/// end as a finished one has, /report the report of the newest fault. Only those who may operate get them, since they hold what happened to people.
/// An encrypted recording is read decrypted if the request may use its key; otherwise 409 states why.
/// A thread of its own reads the disk, so that neither a stop nor a tick waits for it on the server's thread.
class StationFiles : public std::enable_shared_from_this<StationFiles> {
 public:
  using Respond = std::function<void(WebResponse)>;
  static constexpr std::size_t kLargestPart = 16U << 20U;  ///< of a file in one response [bytes]
  static constexpr std::size_t kMostWaiting = 64;          ///< requests
  static constexpr std::size_t kKeptEnds = 4;              ///< of recordings that are being written

  using FindAccess = std::function<RecordingAccess(const WebRequest&)>;

  /// @param folder  empty: there are none
  /// @param access  keys for each request; empty: none. The reading thread calls it
  explicit StationFiles(std::filesystem::path folder, FindAccess access = {})
      : folder_(std::move(folder)), access_(std::move(access)) {}

  /// @returns true if the path is of these files
  [[nodiscard]] static bool is_one(const std::string& path) noexcept {
    return path == "/recordings" || path.starts_with("/recordings/") || path == "/report";
  }
  /// Sets the file of /report. Any thread.
  void set_report(std::filesystem::path file);
  /// Responds from the reading thread, or at once with a refusal in words. Any thread; allocates.
  void request(const WebRequest& request, Respond respond);

 private:
  struct Request {
    WebRequest request;
    Respond respond;
  };
  void work();
  [[nodiscard]] WebResponse response_to(const WebRequest& request);
  /// The bytes of a recording up to a place, and what follows them.
  struct Cut {
    std::string name;
    std::uint64_t until = 0;  ///< as it was asked for
    std::uint64_t place = 0;  ///< where the end begins: no chunk lies across it
    Bytes end;
  };
  [[nodiscard]] WebResponse answer(const WebRequest& request, const FindRecordingKey& keys);
  [[nodiscard]] WebResponse part_of(const std::string& name, const WebRequest& request,
                                    const FindRecordingKey& keys);
  [[nodiscard]] const Cut& cut_at(const std::string& name, const mcap::ReadableFile& file,
                                  std::uint64_t until);
  [[nodiscard]] WebResponse list(const FindRecordingKey& keys);
  [[nodiscard]] WebResponse whole_report();

  const std::filesystem::path folder_;
  const FindAccess access_;
  std::vector<RecordingSummary> known_;         ///< the newest list without keys; of the reading thread
  std::vector<RecordingSummary> known_opened_;  ///< the newest list with keys, likewise
  std::deque<Cut> cuts_;                        ///< the newest first, likewise
  std::mutex mutex_;                            ///< of all members below
  std::deque<Request> requests_;
  std::filesystem::path report_;  ///< empty: no fault has been reported
  bool working_ = false;          ///< the thread runs
};

}  // namespace phalanx
