// SPDX-License-Identifier: Apache-2.0
#include "scene/hands/skin_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene.h"
#include "scene/text_file.h"

namespace phalanx {
namespace {

using Json = nlohmann::json;

/// Largest distance of a vertex from the wrist [m]: the longest hand is shorter.
constexpr double kFarthest = 0.3;
/// Tolerance of the sum of a vertex's weights, which are written with few digits.
constexpr double kSlack = 1e-3;
/// Deepest nesting of a skin file. Showing a deeper element in a message would need a stack frame
/// for each level.
constexpr int kDeepest = 16;
constexpr std::uintmax_t kMaxBytes = 16U << 20U;

/// Writes an element as in the file, shortened.
std::string show(const Json& value) {
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + " ...";
  return text;
}

class SkinReader {
 public:
  explicit SkinReader(const std::filesystem::path& file) : file_(file.string()) {}

  [[nodiscard]] HandSkin read() {
    parse();
    read_segments();
    HandSkin skin;
    read_vertices(skin);
    read_influences(skin);
    read_triangles(skin);
    return skin;
  }

 private:
  void parse() {
    std::error_code unknown;
    if (const auto bytes = std::filesystem::file_size(file_, unknown); !unknown && bytes > kMaxBytes)
      throw SceneError(
          fmt::format("{}: is {} bytes long; a skin has at most 16 MB: use fewer vertices", file_, bytes));
    const auto keep_shallow = [this](int depth, Json::parse_event_t, const Json&) {
      if (depth > kDeepest)
        throw SceneError(
            fmt::format("{}: its lists are nested {} deep, deeper than the pairs in influences: "
                        "write it as docs/hands.md says",
                        file_, depth));
      return true;
    };
    try {
      root_ = Json::parse(read_text_file(file_, "skin"), keep_shallow);
    } catch (const Json::exception& error) {
      throw SceneError(fmt::format("{}: not valid JSON: {}; correct it there", file_, error.what()));
    }
    if (!root_.is_object()) {
      throw SceneError(fmt::format("{}: is {}; write an object {{\"segments\": ...}}", file_, show(root_)));
    }
  }

  /// Reads a list that must not be empty.
  [[nodiscard]] const Json& list(const std::string& key) const {
    const auto found = root_.find(key);
    if (found == root_.end()) throw SceneError(fmt::format("{}: {}: is missing; add it", file_, key));
    if (!found->is_array() || found->empty())
      throw SceneError(fmt::format("{}: {} = {}: write a list that is not empty", file_, key, show(*found)));
    return *found;
  }

  [[noreturn]] void fail(std::string_view key, std::size_t i, const Json& value,
                         const std::string& problem) const {
    throw SceneError(fmt::format("{}: {}[{}] = {}: {}", file_, key, i, show(value), problem));
  }

  void read_segments() {
    const Json& names = list("segments");
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!names[i].is_string()) fail("segments", i, names[i], "write a segment's name in quotes");
      const auto& name = names[i].get_ref<const std::string&>();
      const std::optional<int> segment = find_segment(name);
      if (!segment) fail("segments", i, names[i], "there is no such segment; " + nearest_segment(name));
      segments_.push_back(static_cast<std::uint8_t>(*segment));
    }
  }

  static std::string nearest_segment(const std::string& name) {
    std::vector<std::string> all;
    for (int s = 0; s < kSegments; ++s) all.emplace_back(segment_name(s));
    return fmt::format("the nearest name is \"{}\"", nearest_name(name, all));
  }

  void read_vertices(HandSkin& skin) const {
    const Json& rows = list("vertices_mm");
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Json& row = rows[i];
      if (!row.is_array() || row.size() != 3 || !row[0].is_number() || !row[1].is_number() ||
          !row[2].is_number())
        fail("vertices_mm", i, row, "write three numbers [x, y, z]");
      const Vec3 p = kMm * Vec3(row[0].get<double>(), row[1].get<double>(), row[2].get<double>());
      if (!p.allFinite() || p.norm() > kFarthest) {
        fail("vertices_mm", i, row,
             fmt::format("lies {:.4g} mm from the wrist's centre, more than {:g} mm; write millimetres in "
                         "the hand's frame",
                         p.norm() / kMm, kFarthest / kMm));
      }
      skin.mesh.vertices.push_back(p);
    }
  }

  /// Reads a whole number in 0 .. `count` - 1.
  static std::optional<std::size_t> index(const Json& value, std::size_t count) {
    if (!value.is_number_unsigned()) return std::nullopt;
    const auto i = value.get<std::uint64_t>();
    if (i >= count) return std::nullopt;
    return static_cast<std::size_t>(i);
  }

  void read_influences(HandSkin& skin) const {
    const Json& rows = list("influences");
    const std::size_t vertices = skin.mesh.vertices.size();
    if (rows.size() != vertices) {
      throw SceneError(
          fmt::format("{}: influences: has {} entries for {} vertices; write one for each of vertices_mm",
                      file_, rows.size(), vertices));
    }
    skin.segment.resize(vertices);
    skin.weight.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) read_influence(rows[i], i, skin.segment[i], skin.weight[i]);
  }

  void read_influence(const Json& row, std::size_t i,
                      std::array<std::uint8_t, HandSkin::kInfluences>& segment,
                      std::array<float, HandSkin::kInfluences>& weight) const {
    if (!row.is_array() || row.empty() || row.size() > HandSkin::kInfluences)
      fail("influences", i, row, "write one to four pairs [[segment, weight], ...]");
    std::array<double, HandSkin::kInfluences> stated{};
    double sum = 0.0;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const Json& pair = row[k];
      if (!pair.is_array() || pair.size() != 2)
        fail("influences", i, row, "write pairs [[segment, weight], ...]");
      const std::optional<std::size_t> s = index(pair[0], segments_.size());
      if (!s) {
        fail("influences", i, row,
             fmt::format("there is no segment {}; write a number from 0 to {}, its place in segments",
                         show(pair[0]), segments_.size() - 1));
      }
      if (!pair[1].is_number() || !(pair[1].get<double>() > 0.0) || pair[1].get<double>() > 1.0 + kSlack)
        fail("influences", i, row, fmt::format("{} is no weight; write one above 0, up to 1", show(pair[1])));
      segment[k] = segments_[*s];
      stated[k] = pair[1].get<double>();
      sum += stated[k];
    }
    if (std::abs(sum - 1.0) > kSlack)
      fail("influences", i, row, fmt::format("the weights' sum is {:.6g}; make it 1", sum));
    for (std::size_t k = 0; k < row.size(); ++k) weight[k] = static_cast<float>(stated[k] / sum);
  }

  void read_triangles(HandSkin& skin) const {
    const Json& rows = list("triangles");
    const std::size_t vertices = skin.mesh.vertices.size();
    for (std::size_t t = 0; t < rows.size(); ++t) {
      const Json& row = rows[t];
      if (!row.is_array() || row.size() != 3)
        fail("triangles", t, row, "write the numbers of three vertices [a, b, c]");
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::optional<std::size_t> v = index(row[k], vertices);
        if (!v) {
          fail("triangles", t, row,
               fmt::format("there is no vertex {}; they are numbered from 0 to {}", show(row[k]),
                           vertices - 1));
        }
        triangle[k] = static_cast<std::int32_t>(*v);
      }
      skin.mesh.triangles.push_back(triangle);
    }
  }

  std::string file_;
  Json root_;
  std::vector<std::uint8_t> segments_;  ///< segment of the program for each of the file's
};

}  // namespace

HandSkin read_skin_file(const std::filesystem::path& file) { return SkinReader(file).read(); }

}  // namespace phalanx
