// SPDX-License-Identifier: Apache-2.0
#include "serve/station_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/record/recordings.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_writer.h"
#include "record/plain_text.h"

namespace phalanx {
namespace {

constexpr std::string_view kFiles = "/recordings/";
constexpr std::string_view kReport = "/report";

WebResponse words(int status, const std::string& text) {
  WebResponse response;
  response.status = status;
  response.body = std::make_shared<const std::string>(text + "\n");
  return response;
}

struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;  ///< inclusive
};

/// @returns the range of "bytes=FIRST-LAST"; none for any other form
std::optional<ByteRange> read_range(std::string_view field) {
  constexpr std::string_view kUnit = "bytes=";
  if (!field.starts_with(kUnit)) return std::nullopt;
  field.remove_prefix(kUnit.size());
  ByteRange range;
  const char* end = field.data() + field.size();
  const auto first = std::from_chars(field.data(), end, range.first);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '-') return std::nullopt;
  const auto last = std::from_chars(first.ptr + 1, end, range.last);
  if (last.ec != std::errc() || last.ptr != end || range.last < range.first) return std::nullopt;
  return range;
}

/// @returns the number of "until=NUMBER"; none for any other form
std::optional<std::uint64_t> read_until(std::string_view query) {
  constexpr std::string_view kKey = "until=";
  if (!query.starts_with(kKey)) return std::nullopt;
  query.remove_prefix(kKey.size());
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(query.data(), query.data() + query.size(), value);
  if (error != std::errc() || end != query.data() + query.size()) return std::nullopt;
  return value;
}

}  // namespace

void StationFiles::request(const WebRequest& request, Respond respond) {
  if (!request.client.may_operate)
    return respond(
        words(403, "recordings and reports are for those who may operate: use the operator's address"));
  if (request.method == "POST")
    return respond(words(405, "this address does not allow this method: files can only be read"));
  if (folder_.empty() && request.path != kReport)
    return respond(words(404, "this run records nothing (--record off), so it has no folder of recordings"));
  std::unique_lock lock(mutex_);
  if (requests_.size() >= kMostWaiting) {
    lock.unlock();
    return respond(words(503, "too many files are being read; ask again"));
  }
  requests_.push_back({request, std::move(respond)});
  if (working_) return;
  try {
    std::thread([self = shared_from_this()] { self->work(); }).detach();
    working_ = true;
  } catch (const std::system_error&) {
    const Request refused = std::move(requests_.back());
    requests_.pop_back();
    lock.unlock();
    refused.respond(words(503, "there is no thread to read files; ask again"));
  }
}

void StationFiles::set_report(std::filesystem::path file) {
  const std::scoped_lock lock(mutex_);
  report_ = std::move(file);
}

void StationFiles::work() {
  std::unique_lock lock(mutex_);
  while (!requests_.empty()) {
    const Request next = std::move(requests_.front());
    requests_.pop_front();
    lock.unlock();
    try {
      next.respond(response_to(next.request));
    } catch (const std::exception&) {  // no memory: without an answer, the server gives 500
    }
    lock.lock();
  }
  working_ = false;
}

WebResponse StationFiles::answer(const WebRequest& request, const FindRecordingKey& keys) {
  if (!request.path.starts_with(kFiles)) return list(keys);
  return part_of(request.path.substr(kFiles.size()), request, keys);
}

WebResponse StationFiles::response_to(const WebRequest& request) {
  RecordingAccess access;
  try {
    if (request.path == kReport) return whole_report();
    if (access_) access = access_(request);
    return answer(request, access.keys);
  } catch (const std::system_error& error) {
    return words(500, fmt::format("the disk refuses ({})", error.code().message()));
  } catch (const mcap::McapError& error) {
    return words(409, fmt::format("the recording cannot be read: {}", error.what()));
  } catch (const mcap::NoKeyError& error) {
    return words(409, fmt::format("the recording cannot be read: {}",
                                  access.refusal.empty() ? error.what() : as_utf8(access.refusal)));
  } catch (const std::invalid_argument& refused) {
    return words(404, as_utf8(refused.what()));
  }
}

WebResponse StationFiles::whole_report() {
  std::unique_lock lock(mutex_);
  const std::filesystem::path file = report_;
  lock.unlock();
  if (file.empty()) return words(404, "no fault has been reported since the program began");
  const mcap::ReadableFile readable(file);
  if (readable.size() > kLargestPart) return words(500, "the report is too large");
  std::string bytes;
  readable.read(0, readable.size(), bytes);
  WebResponse response;
  response.type = "application/json";
  response.body = std::make_shared<const std::string>(std::move(bytes));
  return response;
}

WebResponse StationFiles::list(const FindRecordingKey& keys) {
  nlohmann::json files = nlohmann::json::array();
  // A request without keys must not get what was read for one with keys.
  std::vector<RecordingSummary>& known = keys ? known_opened_ : known_;
  known = list_recordings(folder_, known, keys);
  for (const RecordingSummary& recording : known) {
    const bool opens = recording.has_end && recording.trouble.empty() && !recording.written;
    files.push_back({{"name", as_utf8(recording.file.filename().string())},
                     {"bytes", recording.bytes},
                     {"begin", recording.begin},
                     {"seconds", recording.seconds},
                     {"steps", recording.steps},
                     {"events", recording.events},
                     {"gaps", recording.gaps},
                     {"scene", as_utf8(recording.scene)},
                     {"device", as_utf8(recording.device)},
                     {"opens", opens},
                     {"state", as_utf8(recording_state(recording))}});
  }
  const nlohmann::json all = {{"folder", as_utf8(folder_.string())}, {"recordings", std::move(files)}};
  WebResponse response;
  response.type = "application/json";
  response.body = std::make_shared<const std::string>(all.dump());
  return response;
}

const StationFiles::Cut& StationFiles::cut_at(const std::string& name, const mcap::ReadableFile& file,
                                              std::uint64_t until) {
  const auto known = std::find_if(cuts_.begin(), cuts_.end(),
                                  [&](const Cut& cut) { return cut.name == name && cut.until == until; });
  if (known != cuts_.end()) return *known;
  const mcap::Summary summary = mcap::summarise_until(file, until);
  const mcap::Bytes end = mcap::end_of_file(summary, summary.begin);
  cuts_.push_front({.name = name,
                    .until = until,
                    .place = summary.begin,
                    .end = std::make_shared<const std::string>(end.begin(), end.end())});
  if (cuts_.size() > kKeptEnds) cuts_.pop_back();
  return cuts_.front();
}

WebResponse StationFiles::part_of(const std::string& name, const WebRequest& request,
                                  const FindRecordingKey& keys) {
  const std::filesystem::path file = folder_ / name;
  if (name.find('/') != std::string::npos || !has_recording_name(file) ||
      !std::filesystem::is_regular_file(file))
    return words(404, "there is no recording of this name; /recordings lists them");
  const auto range = read_range(request.range);
  if (!range || range->last - range->first >= kLargestPart)
    return words(400, fmt::format("a recording is read in parts of at most {} bytes: ask with the header "
                                  "'Range: bytes=FIRST-LAST'",
                                  kLargestPart));
  const mcap::ReadableFile readable(file, keys);
  std::uint64_t from_file = readable.size();  // bytes that are read from it; the others are those of `end`
  std::string_view end;
  if (!request.query.empty()) {
    const auto until = read_until(request.query);
    if (!until) return words(400, "the query of a recording is 'until=BYTES', or none");
    const Cut& cut = cut_at(name, readable, *until);
    from_file = cut.place;
    end = *cut.end;
  }
  const std::uint64_t size = from_file + end.size();
  WebResponse response;
  if (range->first >= size) {
    response = words(416, fmt::format("the recording has {} bytes", size));
    response.content_range = fmt::format("bytes */{}", size);
    return response;
  }
  const std::uint64_t last = std::min(range->last, size - 1);
  std::string bytes;
  if (range->first < from_file)
    readable.read(range->first, std::min(last + 1, from_file) - range->first, bytes);
  if (last >= from_file) {
    const std::uint64_t begin = std::max(range->first, from_file) - from_file;
    bytes +=
        end.substr(static_cast<std::size_t>(begin), static_cast<std::size_t>(last + 1 - from_file - begin));
  }
  response.status = 206;
  response.type = "application/octet-stream";
  response.content_range = fmt::format("bytes {}-{}/{}", range->first, last, size);
  if (bytes.size() != last - range->first + 1) return words(500, "the recording became shorter meanwhile");
  response.body = std::make_shared<const std::string>(std::move(bytes));
  return response;
}

}  // namespace phalanx
