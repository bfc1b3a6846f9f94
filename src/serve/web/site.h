// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "phalanx/serve/web_server.h"

namespace phalanx::web {

/// One file of the front-end.
struct SiteFile {
  std::string type;  ///< media type
  Bytes bytes;
  Bytes gzipped;           ///< null: not compressed
  std::string tag;         ///< value of the ETag field
  bool immutable = false;  ///< its name contains a hash of its content
};

/// Static files of the built front-end, read once at the start. A request names a file of this list exactly
/// or gets none: no path is looked up on the disk.
class Site {
 public:
  /// Reads the folder. Leaves hidden files and symbolic links out. A folder that does not exist has no files.
  /// @throws WebServerError if it cannot be read, or is too large to be a front-end
  explicit Site(const std::filesystem::path& folder);

  /// @param path  of the request; "/" means "/index.html", "/patient" means "/patient.html".
  /// @returns null if there is no such file
  [[nodiscard]] const SiteFile* find(const std::string& path) const noexcept;

 private:
  void read(const std::filesystem::path& folder);

  std::map<std::string, SiteFile, std::less<>> files_;
};

/// @returns the media type of a file extension: "text/html; charset=utf-8" for ".html"
[[nodiscard]] std::string_view media_type(std::string_view extension) noexcept;
/// @returns the bytes in gzip format. @throws std::bad_alloc
[[nodiscard]] std::string gzip(std::string_view bytes);

}  // namespace phalanx::web
