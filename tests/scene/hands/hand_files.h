// SPDX-License-Identifier: Apache-2.0
// Hand files with segment meshes, written into a folder of their own.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "phalanx/hand/hand_meshes.h"
#include "phalanx/mesh/import.h"
#include "phalanx/scene/hand_file.h"

namespace phalanx::test {

/// A folder that is gone at the end of the test; its name holds a space on purpose.
class HandFolder {
 public:
  HandFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("phalanx hand " + std::to_string(::getpid()) + "." + std::to_string(++count));
    std::filesystem::create_directories(path_ / "meshes");
  }
  ~HandFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  HandFolder(const HandFolder&) = delete;
  HandFolder& operator=(const HandFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path mesh(int segment, const std::string& prefix = "") const {
    return path_ / "meshes" / (prefix + std::string(segment_name(segment)) + ".obj");
  }

  /// One .obj a segment, its numbers `per_metre` times the metres.
  void write_meshes(const SegmentMeshes& meshes, double per_metre = 1000.0,
                    const std::string& prefix = "") const {
    for (int s = 0; s < kSegments; ++s) {
      TriangleMesh scaled = meshes[static_cast<std::size_t>(s)];
      for (Vec3& v : scaled.vertices) v *= per_metre;
      write_obj(scaled, mesh(s, prefix), std::string(segment_name(s)));
    }
  }

  /// The adult's hand file with these lines as its table [meshes]; its path.
  [[nodiscard]] std::string write_hand(const std::string& meshes_table) const {
    std::ifstream in(PHALANX_SOURCE_DIR "/assets/hands/adult.toml");
    std::stringstream text;
    text << in.rdbuf();
    std::string adult = text.str();
    if (const std::size_t at = adult.find("\n[meshes]"); at != std::string::npos) adult.resize(at + 1);
    const std::filesystem::path file = path_ / "hand.toml";
    std::ofstream(file) << adult << "\n[meshes]\n" << meshes_table;
    return file.string();
  }

 private:
  std::filesystem::path path_;
};

}  // namespace phalanx::test
