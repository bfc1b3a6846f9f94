// SPDX-License-Identifier: Apache-2.0
#include "serve/uploads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/import_cache.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "record/temporary_folder.h"
#include "serve/page_requests.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// @returns a tetrahedron with three edges of this length [mm]
std::string solid(int mm) {
  const std::string e = std::to_string(mm);
  return "v 0 0 0\nv " + e + " 0 0\nv 0 " + e + " 0\nv 0 0 " + e + "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
}

nlohmann::json taken(const std::string& query, const std::string& bytes, const std::filesystem::path& folder,
                     const Overrides& in_force = {}) {
  ImportCache imports;
  return nlohmann::json::parse(
      take_upload(upload_of(query, bytes), folder, [&] { return in_force; }, imports));
}

std::size_t files_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  if (std::filesystem::exists(folder))
    for ([[maybe_unused]] const auto& entry : std::filesystem::recursive_directory_iterator(folder)) ++count;
  return count;
}

TEST(Uploads, TheQuerySaysNameSizeAndUnit) {
  const UploadedMesh mesh = upload_of("name=my%20mug%2Fx+y.stl&size_mm=90.5&unit=mm&more=1", "abc");
  EXPECT_EQ(mesh.name, "my mug/x y.stl");
  EXPECT_EQ(mesh.size_mm, 90.5);
  EXPECT_EQ(mesh.unit, "mm");
  EXPECT_EQ(mesh.bytes, "abc");
  for (const char* wrong : {"size_mm=-1", "size_mm=nan", "size_mm=inf", "size_mm=2001", "size_mm=9x",
                            "size_mm=", "unit=mile", "unit="})
    EXPECT_THROW(static_cast<void>(upload_of("name=a.obj&" + std::string(wrong), "abc")),
                 std::invalid_argument)
        << wrong;
  EXPECT_THROW(static_cast<void>(upload_of("name=a.obj", "")), std::invalid_argument);
  EXPECT_EQ(upload_of("name=%zz%4", "x").name, "%zz%4");
  EXPECT_EQ(upload_of("&&=&name", "x").name, "");
  EXPECT_EQ(upload_of("name=%30%39%4a%4A%c3%A9%2f%2F", "x").name, "09JJ\u00E9//");
  EXPECT_EQ(upload_of("size_mm=2000", "x").size_mm, 2000.0);
  EXPECT_EQ(upload_of("size_mm=0", "x").size_mm, 0.0);
  EXPECT_THROW(static_cast<void>(upload_of("size_mm=2000.001", "x")), std::invalid_argument);
}

TEST(Uploads, AGoodMeshIsKeptUnderAGeneratedName) {
  const TemporaryFolder folder;
  const auto answer = taken("name=..%2F..%2Fetc%2Fpass%20wd.OBJ&unit=mm", solid(60), folder / "up");
  ASSERT_TRUE(answer["ok"].get<bool>()) << answer.dump();
  const std::filesystem::path file = answer["file"].get<std::string>();
  EXPECT_EQ(file.parent_path(), folder / "up");
  EXPECT_THAT(file.filename().string(), ::testing::MatchesRegex("passwd-[0-9a-f]{16}\\.obj"));
  EXPECT_EQ(testing::read_file(file), solid(60));
  EXPECT_TRUE(answer.contains("report"));
  EXPECT_FALSE(names_foreign_file("objects.0.file", file.string(), folder / "up"));
  const auto same = taken("name=passwd.obj&unit=mm", solid(60), folder / "up");
  EXPECT_EQ(same["file"], answer["file"]);
  const auto other = taken("name=passwd.obj&unit=mm", solid(61), folder / "up");
  EXPECT_NE(other["file"], answer["file"]);
  const auto lengthy = taken("name=" + std::string(41, 'n') + ".obj&unit=mm", solid(60), folder / "up");
  EXPECT_THAT(std::filesystem::path(lengthy["file"].get<std::string>()).filename().string(),
              ::testing::MatchesRegex("n{40}-[0-9a-f]{16}\\.obj"));
}

TEST(Uploads, AFileThatIsNoMeshIsRefusedAndLeavesNothing) {
  const TemporaryFolder folder;
  for (const char* name : {"mug.exe", "mug", "", ".obj", "mug.obj.toml", "%ff%fe.sh"}) {
    const auto answer = taken("name=" + std::string(name), "MZ...", folder / "up");
    EXPECT_FALSE(answer["ok"].get<bool>()) << name;
    EXPECT_FALSE(answer["error"].get<std::string>().empty()) << name;
  }
  for (const char* name : {"mug.obj", "mug.stl", "mug.ply", "mug.glb", "mug.3ds"}) {
    const auto answer = taken("name=" + std::string(name), std::string("broken \0\xFF", 9), folder / "up");
    EXPECT_FALSE(answer["ok"].get<bool>()) << name;
  }
  EXPECT_EQ(files_in(folder / "up"), 0U);
}

TEST(Uploads, ASizeThatNoHandCanGraspIsNotKept) {
  const TemporaryFolder folder;
  const auto answer = taken("name=a.obj&unit=m", solid(60), folder / "up");  // 60 m
  EXPECT_FALSE(answer["ok"].get<bool>());
  EXPECT_THAT(answer["error"].get<std::string>(), ::testing::Not(::testing::IsEmpty()));
  EXPECT_TRUE(answer.contains("report"));
  EXPECT_EQ(files_in(folder / "up"), 0U);
}

// Its numbers would be 60 m.
TEST(Uploads, AStatedSizeIsInMillimetresIndependentOfTheFilesNumbers) {
  const TemporaryFolder folder;
  const auto answer = taken("name=a.obj&unit=m&size_mm=60", solid(60), folder / "up");
  ASSERT_TRUE(answer["ok"].get<bool>()) << answer.dump();
  for (const auto& extent : answer["report"]["extent_m"]) EXPECT_NEAR(extent.get<double>(), 0.06, 1e-6);
}

/// @returns the mesh of an answer's preview, in metres
TriangleMesh preview_of(const nlohmann::json& answer) {
  const auto position = answer["preview"]["position_um"].get<std::vector<std::int64_t>>();
  const auto index = answer["preview"]["triangle"].get<std::vector<std::int32_t>>();
  TriangleMesh mesh;
  for (std::size_t i = 0; i + 2 < position.size(); i += 3)
    mesh.vertices.push_back(1e-6 * Vec3(static_cast<double>(position[i]),
                                        static_cast<double>(position[i + 1]),
                                        static_cast<double>(position[i + 2])));
  for (std::size_t i = 0; i + 2 < index.size(); i += 3)
    mesh.triangles.push_back({index[i], index[i + 1], index[i + 2]});
  EXPECT_EQ(position.size() % 3, 0U);
  EXPECT_EQ(index.size() % 3, 0U);
  check_mesh(mesh, "preview");
  return mesh;
}

// The tetrahedron of three edges of 60 mm has a volume of 60^3/6 mm^3 = 36 cm^3 if its triangles wind outward.
TEST(Uploads, TheAnswerHoldsTheImportedMeshForAPicture) {
  const TemporaryFolder folder;
  const TriangleMesh as_in_file = preview_of(taken("name=a.obj&unit=mm", solid(60), folder / "up"));
  EXPECT_EQ(as_in_file.vertices.size(), 4U);
  EXPECT_TRUE(is_closed(as_in_file));
  EXPECT_NEAR(signed_volume(as_in_file), 36e-6, 1e-12);
  EXPECT_NEAR(bounds(as_in_file).min.norm(), 0.0, 1e-9);
  const Bounds scaled = bounds(preview_of(taken("name=a.obj&size_mm=90", solid(60), folder / "up")));
  EXPECT_NEAR((scaled.max - Vec3(0.045, 0.045, 0.045)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((scaled.min + Vec3(0.045, 0.045, 0.045)).norm(), 0.0, 1e-9);
}

TEST(Uploads, APictureOfAMeshWithManyTrianglesHasFewer) {
  const TemporaryFolder folder;
  const TriangleMesh fine = make_torus(0.08, 0.03, 40'000);
  const auto answer = taken("name=a.obj&unit=m", test::to_obj(fine), folder / "up");
  ASSERT_TRUE(answer["ok"].get<bool>()) << answer.dump();
  EXPECT_EQ(answer["report"]["triangles"].get<std::size_t>(), fine.triangles.size());
  const TriangleMesh picture = preview_of(answer);
  EXPECT_LE(picture.triangles.size(), 20'000U);
  EXPECT_GT(picture.triangles.size(), 15'000U);
  EXPECT_TRUE(is_closed(picture));
  EXPECT_NEAR(signed_volume(picture), signed_volume(fine), 0.01 * signed_volume(fine));
}

TEST(Uploads, ARefusedMeshHasNoPicture) {
  const TemporaryFolder folder;
  for (const char* query : {"name=a.obj&unit=m", "name=a.exe&unit=mm"})
    EXPECT_FALSE(taken(query, solid(60), folder / "up").contains("preview")) << query;
}

TEST(Uploads, AFolderThatCannotBeWrittenIsReported) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "in the way";
  const auto answer = taken("name=a.obj&unit=mm", solid(60), folder / "file");
  EXPECT_FALSE(answer["ok"].get<bool>());
}

/// Writes a file that is the older the lower its number is.
std::filesystem::path put_old(const std::filesystem::path& folder, const std::string& name, int number) {
  std::filesystem::create_directories(folder);
  const auto file = folder / name;
  std::ofstream(file) << number;
  std::filesystem::last_write_time(
      file, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1000 - number));
  return file;
}

std::string upload_name(int number) {
  const std::string digits = std::to_string(number);
  return "old-" + std::string(16 - digits.size(), 'a') + digits + ".obj";
}

TEST(Uploads, KeepsTheNewestFifty) {
  const TemporaryFolder folder;
  for (int i = 0; i < 60; ++i) put_old(folder / "up", upload_name(i), i);
  const auto answer = taken("name=new.obj&unit=mm", solid(60), folder / "up");
  EXPECT_EQ(files_in(folder / "up"), 50U);
  EXPECT_TRUE(std::filesystem::exists(answer["file"].get<std::string>()));
  EXPECT_FALSE(std::filesystem::exists(folder / "up" / upload_name(10)));
  EXPECT_TRUE(std::filesystem::exists(folder / "up" / upload_name(59)));
}

TEST(Uploads, FilesWithOtherNamesStayHoweverOldTheyAre) {
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> theirs;
  for (const char* name :
       {"thesis.odt", "mug.obj", "mug-2.stl", "-0123456789abcdef.obj", "mug-0123456789abcdeF.obj",
        "mug-0123456789abcdeg.obj", "mug-0123456789abcde.obj", "mug_0123456789abcdef.obj",
        "my mug-0123456789abcdef.obj", "mug-0123456789abcdef.obj.bak", "mug-0123456789abcdef.txt",
        "mug-0123456789abcdef", "0123456789abcdef.obj"})
    theirs.push_back(put_old(folder / "up", name, 0));
  for (int i = 0; i < 60; ++i) put_old(folder / "up", upload_name(i), 1 + i);
  ASSERT_TRUE(taken("name=new.obj&unit=mm", solid(60), folder / "up")["ok"].get<bool>());
  for (const auto& file : theirs) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  EXPECT_EQ(files_in(folder / "up"), 50U + theirs.size());
}

TEST(Uploads, AFileThatTheSceneInForceNamesStays) {
  const TemporaryFolder folder;
  const auto named = put_old(folder / "up", upload_name(0), 0);
  const auto other = put_old(folder / "up", upload_name(1), 1);
  for (int i = 2; i < 60; ++i) put_old(folder / "up", upload_name(i), i);
  const auto answer = taken("name=new.obj&unit=mm", solid(60), folder / "up",
                            {{"rate_hz", "250"}, {"objects.0.file", "'" + named.string() + "'"}});
  ASSERT_TRUE(answer["ok"].get<bool>());
  EXPECT_TRUE(std::filesystem::exists(named));
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST(Uploads, AnAbandonedUploadLeavesNothing) {
  const TemporaryFolder folder;
  for (const int asked_before : {0, 1}) {
    int asked = 0;
    ImportCache imports;
    const auto in_force = [&] { return asked++ < asked_before ? std::optional(Overrides()) : std::nullopt; };
    const auto answer = nlohmann::json::parse(
        take_upload(upload_of("name=a.obj&unit=mm", solid(60)), folder / "up", in_force, imports));
    EXPECT_FALSE(answer["ok"].get<bool>());
    EXPECT_EQ(asked, asked_before + 1);
    EXPECT_EQ(files_in(folder / "up"), 0U);
    EXPECT_EQ(imports.bytes(), 0U);
  }
}

// The page sends size_mm as the user typed it, and the unit only if the size is 0.
TEST(Uploads, ASceneWithTheMeshNeedsNoOtherImport) {
  const TemporaryFolder folder;
  const auto scene_with = [](const std::string& file, const std::string& keys) {
    return load_scene("first_touch", {{"hand.meshes", "\"capsules\""},
                                      {"grasp.type", "\"none\""},
                                      {"objects.0", "{kind = 'file', file = '" + file + "', " + keys + "}"}});
  };
  for (const auto& [query, keys] : std::vector<std::pair<std::string, std::string>>{
           {"size_mm=90.1&unit=mm", "size_mm = 90.1"}, {"size_mm=0&unit=mm", "size_mm = 0, unit = 'mm'"}}) {
    ImportCache imports;
    const auto answer = nlohmann::json::parse(take_upload(
        upload_of("name=a.obj&" + query, solid(60)), folder / "up", [] { return Overrides(); }, imports));
    ASSERT_TRUE(answer["ok"].get<bool>()) << answer.dump();
    const std::string file = answer["file"].get<std::string>();
    const TriangleMesh world = resolve(scene_with(file, keys), {.imports = &imports}).world;
    EXPECT_EQ(imports.hits(), 1U) << keys;
    EXPECT_EQ(imports.misses(), 0U) << keys;
    EXPECT_EQ(world.vertices, make_world_mesh(scene_with(file, keys)).vertices);
    EXPECT_EQ(world.triangles, make_world_mesh(scene_with(file, keys)).triangles);
    static_cast<void>(resolve(scene_with(file, "size_mm = 91"), {.imports = &imports}));
    EXPECT_EQ(imports.misses(), 1U) << "another size";
  }
}

// A page states which axis of the file is up: R = Rz(yaw) Ry(pitch) Rx(roll) turns it to z.
TEST(Uploads, ASceneTurnsTheMeshWithoutAnotherImport) {
  const TemporaryFolder folder;
  ImportCache imports;
  const auto answer = nlohmann::json::parse(take_upload(
      upload_of("name=a.obj&unit=mm",
                "v 0 0 0\nv 30 0 0\nv 0 40 0\nv 0 0 50\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"),
      folder / "up", [] { return Overrides(); }, imports));
  ASSERT_TRUE(answer["ok"].get<bool>()) << answer.dump();
  const std::string place = "{kind = 'file', file = '" + answer["file"].get<std::string>() +
                            "', size_mm = 0, unit = 'mm', rotation_deg = ";
  for (const auto& [turn, height] : std::vector<std::pair<std::string, double>>{
           {"[0, -90, 0]", 0.03}, {"[90, 0, 0]", 0.04}, {"[0, 0, 0]", 0.05}}) {
    const auto scene = load_scene(
        "first_touch",
        {{"hand.meshes", "\"capsules\""}, {"grasp.type", "\"none\""}, {"objects.0", place + turn + "}"}});
    const Bounds box = bounds(resolve(scene, {.imports = &imports}).world);
    EXPECT_NEAR(box.max.z(), height, 1e-8) << turn;
    EXPECT_NEAR(box.min.z(), 0.0, 1e-8) << turn;
  }
  EXPECT_EQ(imports.misses(), 0U);
}

TEST(Uploads, AMeshThatNoSceneCanUseIsNotKeptInTheCache) {
  const TemporaryFolder folder;
  ImportCache imports;
  for (const char* query : {"name=a.obj&unit=m", "name=a.exe&unit=mm"}) {
    const auto answer = nlohmann::json::parse(
        take_upload(upload_of(query, solid(60)), folder / "up", [] { return Overrides(); }, imports));
    EXPECT_FALSE(answer["ok"].get<bool>()) << query;
    EXPECT_EQ(imports.bytes(), 0U) << query;
  }
}

TEST(Uploads, AMeshThatWouldTakeMinutesToCheckIsRefused) {
  const TemporaryFolder folder;
  std::string mesh = "v 0 0 0\nv 60 0 0\nv 0 60 0\n";
  for (std::size_t i = 0; i <= kMostUploadedTriangles; ++i) mesh += "f 1 2 3\n";
  const auto answer = taken("name=big.obj&unit=mm", mesh, folder / "up");
  EXPECT_FALSE(answer["ok"].get<bool>());
  EXPECT_EQ(answer["error"],
            "big.obj: 500001 triangles; decimate the mesh before sending it, the limit is 500000");
  EXPECT_EQ(files_in(folder / "up"), 0U);
}

TEST(Uploads, TheImportHasNoLimitUnlessOneIsSet) {
  const std::string mesh = solid(60);
  const auto import_it = [&](std::size_t most) {
    static_cast<void>(import_and_check_from_memory(mesh.data(), mesh.size(), "obj",
                                                   {.unit = 1e-3, .most_triangles = most}));
  };
  EXPECT_NO_THROW(import_it(0));
  EXPECT_NO_THROW(import_it(4));
  EXPECT_THROW(import_it(3), std::invalid_argument);
}

class ForeignFiles : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(ForeignFiles, AreFoundHoweverTheyAreWritten) {
  const auto& [key, value] = GetParam();
  EXPECT_TRUE(names_foreign_file(key, value, "/tmp/up")) << key << " = " << value;
}
INSTANTIATE_TEST_SUITE_P(
    All, ForeignFiles,
    ::testing::Values(
        std::pair{"objects.0.file", "/etc/passwd"}, std::pair{"objects.0.file", "\"/etc/passwd\""},
        std::pair{"objects.0.file", "'/etc/passwd'"}, std::pair{"objects.0.file", "\"\"\"/etc/passwd\"\"\""},
        std::pair{"objects.0.file", R"("\u002fetc\u002fpasswd")"},
        std::pair{"objects.0.file", R"("\U0000002Fetc")"}, std::pair{"objects.0.file", "secret.obj"},
        std::pair{"objects.0.file", "\"secret.obj\""}, std::pair{"objects.0.file", ".."},
        std::pair{"objects.0.file", "/tmp/up/../secret.obj"}, std::pair{"objects.0.file", "/tmp/up/a/b.obj"},
        std::pair{"objects.0.file", "/tmp/up/a.b.obj"}, std::pair{"objects.0.file", "/tmp/up/.obj"},
        std::pair{"objects.0.file", "/tmp/up/"}, std::pair{"objects.0.file", "/tmp/upper/a.obj"},
        std::pair{"objects.0.file", "/tmp/up/a.obj/../../x"},
        std::pair{"objects.0", "{kind='file', file='secret.obj'}"},
        std::pair{"objects", "[{kind='file', file='/etc/x'}]"},
        std::pair{"objects", R"([{kind='file', "\u0066ile"='secret.obj'}])"},
        std::pair{"objects.00.file", "secret.obj"}, std::pair{"motion.file", "walk.csv"},
        std::pair{"motion", "{file = 'walk.csv'}"}, std::pair{"hand.profile", "../x"},
        std::pair{"hand.profile", "mine.toml"}, std::pair{"hand.profile", R"("mine\u002etoml")"},
        std::pair{"hand", "{profile = 'mine.toml'}"}, std::pair{"device.file", "./x.toml"},
        std::pair{"device", "{file = './x'}"}, std::pair{"patient", "'/x'"},
        std::pair{"objects.0.kind", "'''\n/etc/passwd'''"}, std::pair{"odd.file", "x"}));

TEST(OwnFiles, ShippedNamesNumbersAndUploadsMayBeNamed) {
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{
           {"hand.profile", "large-man"},
           {"hand.profile", "\"large-man\""},
           {"rate_hz", "250"},
           {"rate_hz", ""},
           {"mirror", "true"},
           {"objects.0.rotation_deg", "[0, 0, -42]"},
           {"force.law", "hooke"},
           {"objects.0.file", "/tmp/up/mug-0123456789abcdef.obj"},
           {"objects.0.file", "\"/tmp/up/mug-0123456789abcdef.obj\""},
           {"objects.0.file", "\"\""},
           {"objects.0", "{kind='file', file='/tmp/up/mug-0123456789abcdef.obj', size_mm=90}"}})
    EXPECT_FALSE(names_foreign_file(key, value, "/tmp/up")) << key << " = " << value;
}

}  // namespace
}  // namespace phalanx
