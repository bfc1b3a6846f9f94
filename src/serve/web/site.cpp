// SPDX-License-Identifier: Apache-2.0
#include "serve/web/site.h"

#define ZLIB_CONST  // zlib reads through pointers to const
#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <fstream>
#include <iterator>
#include <new>
#include <utility>

namespace phalanx::web {
namespace {

constexpr std::size_t kLargestSite = std::size_t{64} * 1024 * 1024;  // [bytes]
constexpr std::size_t kMostEntries = 1024;
constexpr std::size_t kSmallestCompressed = 1024;  // [bytes]

std::string read_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw WebServerError(fmt::format("{}: cannot be read; check its permissions", path.string()));
  return std::string(std::istreambuf_iterator<char>(file), {});
}

bool is_compressible(std::string_view type) noexcept {
  return type.starts_with("text/") || type.starts_with("application/") || type == "image/svg+xml";
}

SiteFile site_file(const std::filesystem::path& path, std::string bytes, const std::string& name) {
  SiteFile file;
  file.type = media_type(path.extension().string());
  file.immutable = name.starts_with("/assets/");
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  file.tag = fmt::format("W/\"{:08x}-{:x}\"", sum, bytes.size());
  if (bytes.size() >= kSmallestCompressed && is_compressible(file.type)) {
    std::string compressed = gzip(bytes);
    if (compressed.size() < bytes.size())
      file.gzipped = std::make_shared<const std::string>(std::move(compressed));
  }
  file.bytes = std::make_shared<const std::string>(std::move(bytes));
  return file;
}

}  // namespace

std::string_view media_type(std::string_view extension) noexcept {
  using Pair = std::pair<std::string_view, std::string_view>;
  static constexpr std::array kTypes{
      Pair{".html", "text/html; charset=utf-8"},
      Pair{".js", "text/javascript; charset=utf-8"},
      Pair{".mjs", "text/javascript; charset=utf-8"},
      Pair{".css", "text/css; charset=utf-8"},
      Pair{".txt", "text/plain; charset=utf-8"},
      Pair{".svg", "image/svg+xml"},
      Pair{".png", "image/png"},
      Pair{".jpg", "image/jpeg"},
      Pair{".webp", "image/webp"},
      Pair{".ico", "image/x-icon"},
      Pair{".woff2", "font/woff2"},
      Pair{".json", "application/json"},
      Pair{".map", "application/json"},
      Pair{".wasm", "application/wasm"},
      Pair{".webmanifest", "application/manifest+json"},
      Pair{".glb", "model/gltf-binary"},
  };
  for (const auto& [name, type] : kTypes) {
    if (name == extension) return type;
  }
  return "application/octet-stream";
}

Site::Site(const std::filesystem::path& folder) {
  std::error_code error;
  if (folder.empty() || !std::filesystem::is_directory(folder, error)) return;
  try {
    read(folder);
  } catch (const std::filesystem::filesystem_error& problem) {
    throw WebServerError(
        fmt::format("{}: the front-end cannot be read: {}", folder.string(), problem.what()));
  }
}

void Site::read(const std::filesystem::path& folder) {
  std::size_t total = 0;
  std::size_t entries = 0;
  std::filesystem::recursive_directory_iterator at(folder);
  for (; at != std::filesystem::recursive_directory_iterator(); ++at) {
    if (++entries > kMostEntries) {
      throw WebServerError(
          fmt::format("{}: more than {} files and folders, which is no built front-end; check the path",
                      folder.string(), kMostEntries));
    }
    const bool hidden = at->path().filename().string().starts_with('.');
    if (hidden && at->is_directory()) at.disable_recursion_pending();
    if (hidden || at->is_symlink() || !at->is_regular_file()) continue;
    total += at->file_size();
    if (total > kLargestSite) {
      throw WebServerError(fmt::format("{}: more than {} MiB, which is no built front-end; check the path",
                                       folder.string(), kLargestSite / (1024 * 1024)));
    }
    const std::string name = fmt::format("/{}", at->path().lexically_relative(folder).generic_string());
    files_.emplace(name, site_file(at->path(), read_whole(at->path()), name));
  }
}

std::string gzip(std::string_view bytes) {
  constexpr int kGzipHeader = 16;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzipHeader, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    throw std::bad_alloc();
  }
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<const Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

const SiteFile* Site::find(const std::string& path) const noexcept {
  std::string_view name = path;
  if (path == "/") name = "/index.html";
  if (path == "/patient") name = "/patient.html";
  const auto found = files_.find(name);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace phalanx::web
