// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/picture.h"

#include <gmock/gmock.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "figures/picture/camera.h"
#include "figures/picture/overlay.h"
#include "figures/picture/ray_scene.h"
#include "figures/picture/shading.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/scene/hand_file.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using testing::TemporaryFolder;

/// The open hand over a ball that the index finger's tip touches from above with 2 N.
struct Scene {
  Scene() : hand(make_hand_model(load_hand_file("adult"), Handedness::kRight, {}, 1000)) {
    HandPoses poses;
    hand.poses(hand.parameters().open_angle, poses);
    for (int s = 0; s < kPalm; ++s) {
      const Pose& X = poses.digit[static_cast<std::size_t>(digit_of_segment(s))]
                          .segment[static_cast<std::size_t>(s % kSegmentsPerDigit)];
      snapshot.gdp_pose[static_cast<std::size_t>(s)] = snapshot.hcp_pose[static_cast<std::size_t>(s)] = X;
    }
    const std::size_t tip = 5;
    const Vec3 below = snapshot.gdp_pose[tip].p - 0.04 * Vec3::UnitY();
    append(object, make_sphere(0.05, 500), Pose{Mat3::Identity(), below});
    snapshot.segment[tip] = {.contact = true,
                             .depth = 4e-3,
                             .force_raw = 2.0,
                             .force = 2.0,
                             .point = below + 0.025 * Vec3::UnitY(),
                             .normal = Vec3::UnitY()};
    snapshot.hcp_pose[tip].p -= 4e-3 * Vec3::UnitY();
  }
  HandModel hand;
  TriangleMesh object;
  Snapshot snapshot;
};

constexpr PictureOptions kSmall{.width = 160, .height = 120, .samples = 2};

/// Pixels for which `is` holds.
template <class Is>
int count(const Image& image, Is is) {
  int n = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    n += is(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]) ? 1 : 0;
  return n;
}
bool teal(int r, int g, int b) { return r + 25 < g && r + 25 < b && b < g + 30; }
bool bone(int r, int g, int b) { return r > g && g > b && r > b + 8 && r < b + 60; }
bool hot(int r, int g, int b) { return r > g + 60 && r > b + 60; }

TEST(Picture, ShowsHandObjectAndForce) {
  const Scene scene;
  const Image image = render_picture(scene.hand.meshes(), scene.object, scene.snapshot, kSmall);
  ASSERT_EQ(image.rgb.size(), 160U * 120U * 3U);
  EXPECT_GT(count(image, teal), 100);
  EXPECT_GT(count(image, bone), 500);
  EXPECT_GT(count(image, hot), 20);
}

TEST(Picture, OfNoObjectShowsTheHandAlone) {
  Scene scene;
  scene.snapshot.segment = {};
  scene.snapshot.hcp_pose = scene.snapshot.gdp_pose;
  const Image image = render_picture(scene.hand.meshes(), {}, scene.snapshot, kSmall);
  EXPECT_EQ(count(image, teal), 0);
  EXPECT_EQ(count(image, hot), 0);
  EXPECT_GT(count(image, bone), 500);
}

// Two balls 10 cm apart along x: seen along y there is a gap in the middle of the image, along x there is not.
TEST(Picture, IsSeenFromTheStatedView) {
  SegmentMeshes two_balls;
  Snapshot snapshot;
  for (const std::size_t s : {3U, 12U}) {
    two_balls[s] = make_sphere(0.04, 500);
    snapshot.gdp_pose[s].p = (s == 3 ? 0.05 : -0.05) * Vec3::UnitX();
  }
  snapshot.hcp_pose = snapshot.gdp_pose;
  const auto balls_in_the_middle = [&](const Vec3& view) {
    PictureOptions options = kSmall;
    options.view = view;
    const Image image = render_picture(two_balls, {}, snapshot, options);
    constexpr int kMiddle = 84;  // of the part of the width that the scene takes
    Image column{.width = 1, .height = image.height, .rgb = {}};
    for (int y = 0; y < image.height; ++y)
      for (int c = 0; c < 3; ++c)
        column.rgb.push_back(image.rgb[static_cast<std::size_t>(3 * (y * image.width + kMiddle) + c)]);
    return count(column, bone);
  };
  EXPECT_EQ(balls_in_the_middle(Vec3::UnitY()), 0);
  EXPECT_GT(balls_in_the_middle(3.0 * Vec3::UnitX()), 60);
}

// The measured hand lies 5 cm below the shown one, so its disc, some 23 pixels in radius, is in the lower
// half. All of it is bluer than the light ground behind it, its middle too, where it covers an eighth.
TEST(Picture, TheMeasuredHandCoversAllOfItsDisc) {
  SegmentMeshes one_ball;
  one_ball[0] = make_sphere(0.04, 500);
  Snapshot snapshot;
  snapshot.hcp_pose[0].p = -0.05 * Vec3::UnitZ();
  snapshot.gdp_pose[3].p = snapshot.hcp_pose[3].p = 0.02 * Vec3::UnitX();  // what tells the thumb's side
  Image lower = render_picture(one_ball, {}, snapshot, kSmall);
  lower.rgb.erase(lower.rgb.begin(), lower.rgb.begin() + 160 * 60 * 3);
  EXPECT_GT(count(lower, [](int r, int, int b) { return b > r + 8; }), 1300);
}

// Two bones of 5 cm hang one below the other, the upper one loaded: half of what is seen is hot, half of it
// is not.
TEST(Picture, TintsALoadedSegmentToItsJoint) {
  SegmentMeshes two_bones;
  Snapshot snapshot;
  for (const std::size_t s : {3U, 4U, 5U}) {
    if (s < 5) {
      append(two_bones[s], make_box(Vec3(0.02, 0.02, 0.05), 12),
             Pose{Mat3::Identity(), -0.025 * Vec3::UnitZ()});
    }
    snapshot.gdp_pose[s].p = -0.05 * static_cast<double>(s - 3) * Vec3::UnitZ();
  }
  snapshot.gdp_pose[12].p = -0.02 * Vec3::UnitX();  // what tells the thumb's side
  snapshot.hcp_pose = snapshot.gdp_pose;
  snapshot.segment[3] = {.contact = true,
                         .depth = 1e-3,
                         .force_raw = 2.0,
                         .force = 2.0,
                         .point = Vec3(0.0, 0.01, -0.025),
                         .normal = Vec3::UnitY()};
  const Image image =
      render_picture(two_bones, {}, snapshot,
                     {.width = 160, .height = 120, .samples = 2, .full_force = 3.0, .force_scale = false});
  const int upper = count(image, hot), lower = count(image, bone);
  EXPECT_GT(upper, 300);
  EXPECT_LT(10 * upper, 14 * lower);
  EXPECT_LT(10 * lower, 16 * upper);
}

TEST(Picture, IsTheSameEveryTime) {
  const Scene scene;
  EXPECT_EQ(render_picture(scene.hand.meshes(), scene.object, scene.snapshot, kSmall).rgb,
            render_picture(scene.hand.meshes(), scene.object, scene.snapshot, kSmall).rgb);
}

TEST(Picture, IsWrittenAsAPngThatReadsBack) {
  Image image{.width = 16, .height = 17, .rgb = {}};
  for (int i = 0; i < 16 * 17 * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i % 251));
  const TemporaryFolder folder;
  const auto file = folder / "a.png";
  write_png(image, file);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&png, file.c_str()), 0) << png.message;
  EXPECT_EQ(png.width, 16U);
  EXPECT_EQ(png.height, 17U);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(png));
  ASSERT_NE(png_image_finish_read(&png, nullptr, rgb.data(), 0, nullptr), 0) << png.message;
  EXPECT_EQ(rgb, image.rgb);
}

TEST(Picture, SaysWhichFileCannotBeWritten) {
  const Image image{.width = 1, .height = 1, .rgb = {0, 0, 0}};
  try {
    write_png(image, "/no/such/folder/a.png");
    FAIL() << "written";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/no/such/folder/a.png"));
  }
}

TEST(Picture, RefusesASizeThatMakesNoSense) {
  const Scene scene;
  EXPECT_THROW((void)render_picture(scene.hand.meshes(), scene.object, scene.snapshot, {.width = 0}),
               std::invalid_argument);
  EXPECT_THROW((void)render_picture(scene.hand.meshes(), scene.object, scene.snapshot, {.samples = 0}),
               std::invalid_argument);
}

TEST(Picture, RefusesAViewWithoutAHorizon) {
  const Scene scene;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& view : {Vec3(0, 0, 0), Vec3(0, 0, -1), Vec3(nan, 1, 0), Vec3(1, 0, nan)}) {
    PictureOptions options = kSmall;
    options.view = view;
    EXPECT_THROW((void)render_picture(scene.hand.meshes(), {}, scene.snapshot, options),
                 std::invalid_argument);
  }
}

// A sphere's patches come nearer to the sphere than its flat triangles do; their corners stay.
TEST(AppendCurved, RoundsASphere) {
  const TriangleMesh sphere = make_sphere(2.0, 300);
  picture::RenderMesh flat, curved;
  append_curved(flat, sphere, {}, {.level = 1});
  append_curved(curved, sphere, {}, {.level = 4});
  EXPECT_EQ(flat.triangles.size(), sphere.triangles.size());
  EXPECT_EQ(curved.triangles.size(), 16 * sphere.triangles.size());
  const auto worst = [](const picture::RenderMesh& mesh) {
    float error = 0.0F;
    for (const auto& t : mesh.triangles) {
      const picture::Vec3f centre = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0F;
      error = std::max(error, std::abs(centre.norm() - 1.0F));
    }
    return error;
  };
  EXPECT_LT(worst(curved), 0.25F * worst(flat));
}

// A box has creases only: nothing bulges.
TEST(AppendCurved, KeepsABoxABox) {
  picture::RenderMesh mesh;
  append_curved(mesh, make_box(Vec3(2, 2, 2), 12), {}, {.level = 4});
  for (const auto& v : mesh.vertices) EXPECT_NEAR(v.cwiseAbs().maxCoeff(), 1.0F, 1e-6F);
}

picture::RayScene ball_scene(const picture::Device& device, const Vec3& centre, int part) {
  picture::RenderMesh mesh;
  picture::append_ball(mesh, centre, 0.02, part);
  return {device.get(), std::move(mesh)};
}

// In shares of the image: from 0.10 to 0.95 across, where the scale has room at the left, and from 0.07 to
// 0.93 down.
TEST(ChooseCamera, FitsAllThatThereIsAndNoMore) {
  const picture::Device device = picture::make_device();
  const picture::RayScene scene = ball_scene(device, Vec3(0.3, -0.2, 0.1), 0);
  for (const int width : {60, 160}) {
    const picture::Camera camera = choose_camera(scene, {}, {}, picture::Vec3f::UnitX(), width, 120);
    float least = 1.0F;  // room to the nearest border
    for (const picture::Vec3f& vertex : scene.mesh().vertices) {
      const Eigen::Vector2f pixel = camera.project(vertex);
      const float x = pixel.x() / static_cast<float>(width), y = pixel.y() / 120.0F;
      least = std::min({least, x - 0.10F, 0.95F - x, y - 0.07F, 0.93F - y});
    }
    EXPECT_NEAR(least, 0.0F, 2e-3F) << width;
  }
}

// A ball looks the same from everywhere, so the thumb's side and the tilt decide. From above, sine of the
// elevation less 4 ((elevation - 20) / 60)^2 is 0.28, 0.40, 0.26 and -0.35 for 17, 26, 38 and 52 degrees;
// from the side, with the cosine, it is 0.95, 0.86, 0.43 and -0.52.
TEST(ChooseCamera, LooksFromTheThumbsSideButNotTooSteeply) {
  const picture::Device device = picture::make_device();
  const picture::RayScene scene = ball_scene(device, Vec3::Zero(), 0);
  const float degree = std::numbers::pi_v<float> / 180.0F;
  const auto above = choose_camera(scene, {}, {}, picture::Vec3f::UnitZ(), 160, 120);
  EXPECT_NEAR(above.forward.z(), -std::sin(26.0F * degree), 0.01F);
  const auto beside = choose_camera(scene, {}, {}, picture::Vec3f::UnitX(), 160, 120);
  EXPECT_NEAR(beside.forward.z(), -std::sin(17.0F * degree), 0.01F);
  EXPECT_LT(beside.forward.x(), -0.9F);
}

// The second place is the one where a camera that looks along -y would stand opposite to the ball, seen from
// the origin: at 7 radii the ball just fits, R / sin(atan(0.86 tan 9.5 degrees)).
TEST(ChooseCamera, DoesNotCareWhereTheSceneLies) {
  const picture::Device device = picture::make_device();
  const double elevation = 17.0 * std::numbers::pi / 180.0;
  const Vec3 opposite = 0.5 * 7.02 * 0.02 * Vec3(0.0, -std::cos(elevation), -std::sin(elevation));
  for (const Vec3& centre : {Vec3(0.0, 0.0, 0.0), opposite}) {
    const picture::RayScene scene = ball_scene(device, centre, kSegments);
    const auto camera = choose_camera(scene, {}, {}, 0.5F * picture::Vec3f::UnitX(), 160, 120);
    EXPECT_LT(camera.forward.x(), -0.5F) << centre.transpose();
  }
}

TEST(RayScene, TellsWhereATriangleIsHitFromEitherSide) {
  using picture::Vec3f;
  const picture::Device device = picture::make_device();
  const Vec3f up = Vec3f::UnitZ();
  picture::RenderMesh mesh;
  mesh.vertices = {Vec3f::Zero(), Vec3f::UnitX(), Vec3f::UnitY()};
  mesh.albedo = {Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ()};
  mesh.triangles.push_back({0, 1, 2});
  mesh.normals.push_back({up, up, up});
  mesh.part.push_back(7);
  const picture::RayScene scene(device.get(), std::move(mesh));
  for (const float side : {-1.0F, 1.0F}) {
    const picture::Ray ray{.origin = Vec3f(0.2F, 0.3F, 2.0F * side), .direction = -side * up};
    const auto hit = scene.closest(ray);
    ASSERT_TRUE(hit) << side;
    EXPECT_NEAR(hit->distance, 2.0F, 1e-5F) << side;
    EXPECT_EQ(hit->part, 7) << side;
    EXPECT_LT((hit->albedo - Vec3f(0.5F, 0.2F, 0.3F)).norm(), 1e-5F) << side;  // its barycentric coordinates
    EXPECT_NEAR(hit->normal.z(), 1.0F, 1e-5F) << side;
    EXPECT_NEAR(hit->geometric.z(), side, 1e-5F) << side;
    EXPECT_TRUE(scene.occluded(ray)) << side;
    const picture::Ray too_short{.origin = ray.origin, .direction = ray.direction, .far = 1.5F};
    EXPECT_FALSE(scene.closest(too_short)) << side;
    EXPECT_FALSE(scene.occluded(too_short)) << side;
  }
}

// Ten rings of 24 sides lie a little inside the ball: by volume 0.964 of it. A ring that is missing at one
// end would change the sum by more than a tenth, for the origin lies outside.
TEST(AppendBall, IsClosedAndFacesOutward) {
  const Vec3 centre(1.0, 2.0, 3.0);
  picture::RenderMesh mesh;
  picture::append_ball(mesh, centre, 0.5, 4);
  double volume = 0.0;
  double worst = 0.0;  // of the normals
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = mesh.vertices[mesh.triangles[t][c]].cast<double>();
      worst = std::max(worst, (mesh.normals[t][c].cast<double>() - (p[c] - centre) / 0.5).norm());
    }
    volume += p[0].dot(p[1].cross(p[2])) / 6.0;
    EXPECT_EQ(mesh.part[t], 4);
  }
  const double whole = 4.0 / 3.0 * std::numbers::pi * 0.125;
  EXPECT_GT(volume, 0.95 * whole);
  EXPECT_LT(volume, whole);
  EXPECT_LT(worst, 1e-4);
}

// By the definition of the cosine's distribution: at 0.36 of the first number 0.6 across and 0.8 along the
// axis; the second number goes once round.
TEST(CosineDirection, GoesOnceRoundItsAxis) {
  using picture::Vec3f;
  const Vec3f axis = Vec3f(1.0F, 2.0F, 2.0F) / 3.0F;
  const auto across = [&](float turn) -> Vec3f {
    const Vec3f direction = picture::cosine_direction(axis, {0.36F, turn});
    EXPECT_NEAR(direction.norm(), 1.0F, 1e-5F) << turn;
    EXPECT_NEAR(direction.dot(axis), 0.8F, 1e-5F) << turn;
    return direction - 0.8F * axis;
  };
  EXPECT_NEAR(across(0.0F).dot(across(0.25F)), 0.0F, 1e-5F);
  EXPECT_NEAR(across(0.0F).dot(across(0.5F)), -0.36F, 1e-5F);
}

// At this size a unit of the letters is 6 pixels and a stroke 4.7 wide: the 'l' goes from (16, 14) to (16,
// 50), and the '_', from 18.6 on, from (28.6, 54.2) to (49, 54.2).
TEST(DrawText, PutsEachStrokeInItsPlace) {
  picture::Canvas canvas{
      .width = 60, .height = 80, .pixel = std::vector<picture::Vec3f>(60U * 80U, picture::Vec3f::Zero())};
  EXPECT_NEAR(picture::draw_text(canvas, 10.0F, 50.0F, 36.0F, "l_", picture::Vec3f::Ones()), 46.2F, 1e-3F);
  const auto ink = [&](std::size_t x, std::size_t y) { return canvas.pixel[60 * y + x].y(); };
  for (const auto& [x, y] :
       {std::pair(16U, 16U), std::pair(16U, 32U), std::pair(30U, 54U), std::pair(45U, 54U)})
    EXPECT_FLOAT_EQ(ink(x, y), 1.0F) << x << ", " << y;
  for (const auto& [x, y] : {std::pair(16U, 5U), std::pair(16U, 60U), std::pair(30U, 32U),
                             std::pair(20U, 54U), std::pair(55U, 54U)})
    EXPECT_FLOAT_EQ(ink(x, y), 0.0F) << x << ", " << y;
}

}  // namespace
}  // namespace phalanx
