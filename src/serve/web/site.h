// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "phalanx/serve/web_server.h"

namespace phalanx::web {

struct SiteFile {
  std::string type;
  Bytes bytes;
  Bytes gzipped;  ///< null: not worth it
  std::string tag;
  bool immutable = false;  ///< its name has a hash of what is in it
};

/// The built front-end, read once: what is not in the list is not there, whatever a path says.
class Site {
 public:
  /// Hidden files and symbolic links are left out. A folder that is not there has no files.
  /// @throws WebServerError  cannot be read, or is too large to be a front-end
  explicit Site(const std::filesystem::path& folder);

  /// @param path  "/" is "/index.html". Null: none of that name
  [[nodiscard]] const SiteFile* find(const std::string& path) const noexcept;

 private:
  void read(const std::filesystem::path& folder);

  std::map<std::string, SiteFile, std::less<>> files_;
};

/// "text/html; charset=utf-8" of ".html"
[[nodiscard]] std::string_view media_type(std::string_view extension) noexcept;
/// As gzip makes it. @throws std::bad_alloc
[[nodiscard]] std::string gzip(std::string_view bytes);

}  // namespace phalanx::web
