// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "phalanx/mesh/import.h"

namespace phalanx {

void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const std::string& object_name) {
  const auto fail = [&](const char* what) {
    throw std::runtime_error(file.string() + ": " + what +
                             "; check that the folder exists, may be written and has room");
  };
  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::unique_ptr<std::FILE, Closer> out(std::fopen(file.c_str(), "wb"));
  if (!out) fail("cannot be opened for writing");
  std::string name = object_name;
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20) c = '_';  // a line break would end the name's line
  std::fprintf(out.get(), "# metres\no %s\n", name.c_str());
  for (const Vec3& v : mesh.vertices) std::fprintf(out.get(), "v %.17g %.17g %.17g\n", v.x(), v.y(), v.z());
  for (const Triangle& t : mesh.triangles)
    std::fprintf(out.get(), "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  const bool bad = std::ferror(out.get()) != 0;
  if (std::fclose(out.release()) != 0 || bad) fail("could not be written completely");
}

}  // namespace phalanx
