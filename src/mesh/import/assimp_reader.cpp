// SPDX-License-Identifier: Apache-2.0
#include "mesh/import/assimp_reader.h"

#include "mesh/import/polygon_cut.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

namespace phalanx::mesh {
namespace {

/// File system with a single file.
class OneFile : public Assimp::IOSystem {
 public:
  OneFile(const void* data, std::size_t bytes, std::string name)
      : data_(static_cast<const std::uint8_t*>(data)), bytes_(bytes), name_(std::move(name)) {}
  [[nodiscard]] bool Exists(const char* file) const override { return name_ == file; }
  [[nodiscard]] char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (name_ != file || std::string_view(mode).find('w') != std::string_view::npos) return nullptr;
    return new Assimp::MemoryIOStream(data_, bytes_);  // Assimp passes it to Close
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  const std::uint8_t* data_;
  std::size_t bytes_;
  std::string name_;
};

std::string_view importer_name(const std::string& format) {
  if (format == "obj") return "Wavefront Object Importer";
  if (format == "3ds") return "Discreet 3DS Importer";
  if (format == "stl") return "Stereolithography (STL) Importer";
  if (format == "ply") return "Stanford Polygon Library (PLY) Importer";
  return "glTF2 Importer";
}

/// Removes all of Assimp's readers but the named format's. Otherwise Assimp guesses among all of them if a
/// file's content does not fit its name.
/// @returns true if exactly one reader is left
bool keep_only(Assimp::Importer& importer, const std::string& format) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* reader = importer.GetImporter(i);
    if (std::string_view(importer.GetImporterInfo(i)->mName) == importer_name(format)) continue;
    importer.UnregisterLoader(reader);
    delete reader;  // unregistering transfers its ownership
  }
  return importer.GetImporterCount() == 1;
}

struct Placed {
  const aiMesh* mesh;
  Eigen::Matrix4d X;
};

Eigen::Matrix4d to_eigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d out;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < 4; ++j) out(i, j) = static_cast<double>(m[i][j]);
  return out;
}

/// Returns every use of a mesh by a node, in the file's order, with the product of the transforms above it.
/// It does not recurse, because a file may nest to any depth.
std::vector<Placed> place_meshes(const aiScene& scene, bool skip_root) {
  std::vector<Placed> placed;
  std::vector<std::pair<const aiNode*, Eigen::Matrix4d>> open;
  open.emplace_back(scene.mRootNode, skip_root ? Eigen::Matrix4d::Identity().eval()
                                               : to_eigen(scene.mRootNode->mTransformation));
  while (!open.empty()) {
    const auto [node, X] = open.back();
    open.pop_back();
    for (unsigned i = 0; i < node->mNumMeshes; ++i) {
      if (node->mMeshes[i] < scene.mNumMeshes) placed.push_back({scene.mMeshes[node->mMeshes[i]], X});
    }
    for (unsigned i = node->mNumChildren; i-- > 0;)
      open.emplace_back(node->mChildren[i], X * to_eigen(node->mChildren[i]->mTransformation));
  }
  return placed;
}

bool has_triangle(const aiMesh& mesh) {
  for (unsigned i = 0; i < mesh.mNumFaces; ++i)
    if (mesh.mFaces[i].mNumIndices >= 3) return true;
  return false;
}

class Collector {
 public:
  explicit Collector(const std::string& origin) : origin_(origin) {}

  void add(const Placed& placed) {
    const aiMesh& mesh = *placed.mesh;
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    if (out_.vertices.size() + mesh.mNumVertices > kMost)
      refuse("more vertices than 32-bit indices reach; decimate it");
    const std::size_t first = out_.vertices.size();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      const Eigen::Vector4d p{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z),
                              1.0};
      const Vec3 q = (placed.X * p).head<3>();
      if (!q.allFinite()) {
        std::ostringstream what;
        const auto number = [](double x) { return std::isnan(x) ? std::abs(x) : x; };  // avoids "-nan"
        const Vec3 shown = p.allFinite() ? q : Vec3(p.head<3>());  // the file's own numbers if they are bad
        what << "vertex " << i << " (counted from 0) of mesh '" << mesh.mName.C_Str() << "' is ("
             << number(shown.x()) << ", " << number(shown.y()) << ", " << number(shown.z())
             << "), not finite; repair the mesh or export it again";
        refuse(what.str());
      }
      out_.vertices.push_back(q);
    }
    const bool mirrored = placed.X.topLeftCorner<3, 3>().determinant() < 0.0;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices < 3) continue;  // points and lines
      corners_.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k)
        corners_.push_back(out_.vertices[first + face.mIndices[k]]);
      for (const auto& cut : cut_polygon(corners_)) {
        Triangle t{};
        for (std::size_t k = 0; k < 3; ++k)
          t[k] = static_cast<std::int32_t>(first + face.mIndices[static_cast<unsigned>(cut[k])]);
        if (mirrored) std::swap(t[1], t[2]);
        out_.triangles.push_back(t);
      }
    }
  }

  TriangleMesh take() { return std::move(out_); }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::invalid_argument(origin_ + ": " + what);
  }

  const std::string& origin_;
  TriangleMesh out_;
  std::vector<Vec3> corners_;  ///< scratch: corners of one face
};

/// Checks before the faces are read that no index exceeds its array.
void check_faces(const aiMesh& mesh, const std::string& origin) {
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    const auto refuse = [&](const std::string& what) {
      throw std::invalid_argument(origin + ": face " + std::to_string(i) + " " + what +
                                  "; repair the mesh or export it again");
    };
    if (face.mNumIndices == 0 || face.mIndices == nullptr) refuse("has no corner");
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        refuse("names vertex " + std::to_string(static_cast<std::int32_t>(face.mIndices[k])) +
               ", but its mesh has " + std::to_string(mesh.mNumVertices) + " (counted from 0)");
    }
  }
}

}  // namespace

TriangleMesh read_with_assimp(const void* data, std::size_t bytes, const std::string& format,
                              const std::string& origin) {
  Assimp::Importer importer;
  if (!keep_only(importer, format))
    throw std::invalid_argument(
        origin + ": this program's Assimp was built without a reader for ." + format +
        "; install Debian's libassimp-dev and rebuild, or convert the file to another format");
  const std::string name = "mesh." + format;
  importer.SetIOHandler(new OneFile(data, bytes, name));  // owned by the importer
  const auto require = [&](const aiScene* scene) {
    if (scene != nullptr && scene->mRootNode != nullptr) return;
    const std::string error = importer.GetErrorString();
    throw std::invalid_argument(origin + ": cannot be read as ." + format +
                                (error.empty() ? "" : " (" + error + ")") + "; check that it is a whole ." +
                                format + " file with a mesh in it, or export it again");
  };
  const aiScene* scene = importer.ReadFile(name, 0);
  require(scene);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) check_faces(*scene->mMeshes[i], origin);
  // Assimp's 3DS reader turns the scene from the format's z up to y up at the root. Here z is up, so that the
  // file's numbers stay.
  const std::vector<Placed> all = place_meshes(*scene, format == "3ds");
  // This check precedes that of the vertices: points without a surface must not cause a message.
  if (std::none_of(all.begin(), all.end(), [](const Placed& placed) { return has_triangle(*placed.mesh); }))
    throw std::invalid_argument(origin + ": the mesh has no triangle; export a surface, not points or lines");
  Collector collector(origin);
  for (const Placed& placed : all) collector.add(placed);
  return collector.take();
}

IsolationLimits reading_limits(std::size_t bytes) noexcept {
  return {.cpu_seconds = 2 + bytes / 1'000'000,
          .memory_bytes = (std::uint64_t{256} << 20) + 16 * std::uint64_t{bytes},
          .wall_seconds = 60.0 + 1e-5 * static_cast<double>(bytes)};
}

}  // namespace phalanx::mesh
