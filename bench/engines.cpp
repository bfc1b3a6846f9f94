// SPDX-License-Identifier: Apache-2.0
// A fingertip in sliding mode beside two physics engines: the same motions of the measured fingertip, over the
// same objects, with the same stiffness and friction. What each shows and renders is held against the law. See
// bench/README.md.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "btBulletDynamicsCommon.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/constants.h"
#include "phalanx/mesh/primitives.h"
#include "stopwatch.h"
#include "support/lone_finger.h"

namespace phalanx::bench {
namespace {

using test::LoneFinger;

constexpr double kPeriod = 1e-3;      // [s]
constexpr double kStiffness = 500.0;  // of the law, and of the engines' coupling [N/m]
constexpr double kFriction = 0.6;
constexpr double kDepth = 3e-3;        // of the measured fingertip [m]
constexpr double kMass = 0.01;         // of the engines' fingertip [kg]
constexpr int kHandTriangles = 40000;  // so that our fingertip is as round as theirs

/// An object below the fingertip.
struct Scene {
  std::string name;
  double ball = 0.0;                           ///< diameter [m]; 0: boxes
  double touches_at = LoneFinger::kTipRadius;  ///< height of the fingertip's centre where it touches [m]
  std::vector<std::pair<Vec3, Pose>> boxes{};  ///< sizes [m] and poses
  bool has_face = false;                       ///< flat, so that the friction of a drag can be read
  [[nodiscard]] TriangleMesh mesh() const {
    TriangleMesh mesh;
    if (ball > 0.0) {
      Pose X = test::at(0.0, 0.0, -0.5 * ball);
      X.R =
          Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()).toRotationMatrix();  // the pole's slivers are elsewhere
      append(mesh, make_sphere(ball, 20000), X);
    }
    for (const auto& [size, pose] : boxes) append(mesh, make_box({size.x(), size.y(), size.z()}, 12), pose);
    return mesh;
  }
  /// Returns the distance of a point from the object; < 0 inside.
  [[nodiscard]] double distance(const Vec3& point) const {
    if (ball > 0.0) return (point - Vec3(0.0, 0.0, -0.5 * ball)).norm() - 0.5 * ball;
    double least = kInfinity;
    for (const auto& [size, pose] : boxes) {
      const Vec3 q = (pose.R.transpose() * (point - pose.p)).cwiseAbs() - 0.5 * size;
      least = std::min(least, q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0));
    }
    return least;
  }
};

std::vector<Scene> scenes() {
  Scene groove{.name = "groove of 90 degrees", .touches_at = 0.0};
  for (const auto& [size, X] : test::groove_boxes(kPi / 2.0)) groove.boxes.emplace_back(size, X);
  return {{.name = "face of a block",
           .boxes = {{Vec3(0.2, 0.03, 0.02), test::at(0.0, 0.009, -0.01)}},
           .has_face = true},
          {.name = "ball of 60 mm", .ball = 0.06},
          groove};
}

/// What a program shows and renders in one tick.
struct Shown {
  Vec3 tip = Vec3::Zero();    ///< centre of the shown fingertip [m]
  Vec3 force = Vec3::Zero();  ///< on the finger [N]
};

/// Measured fingertip of one tick, and the angles of the finger that has it.
struct Measured {
  JointArray angle{};
  Vec3 tip = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
};

const double kTipDamping = 2.0 * std::sqrt(kStiffness * kMass);  // critical [N s/m]

class Program {
 public:
  virtual ~Program() = default;
  virtual Shown tick(const Measured& measured) = 0;
  /// Returns the distance of the shown fingertip and the object after a tick, < 0 inside it [m]. It is not timed.
  [[nodiscard]] virtual double gap() = 0;
};

LoneFinger finger_at(const Scene& scene) {
  LoneFinger finger(ObjectModel(scene.mesh()), kHandTriangles);
  HapticParameters& parameters = finger.model().parameters;
  parameters.contact.mode = ContactMode::kSliding;
  parameters.contact.friction = kFriction;
  parameters.force.stiffness = kStiffness;
  return finger;
}

class Ours : public Program {
 public:
  explicit Ours(LoneFinger& finger) : model_(finger.model()), scratch_(model_.trees()), hand_(model_) {}
  Shown tick(const Measured& measured) override {
    const Snapshot& s = hand_.tick(measured.angle);
    const auto tip = static_cast<std::size_t>(segment_index(test::kIndex, 2));
    Shown shown{.tip = s.gdp_pose[tip] * Vec3(0.0, 0.0, -test::kLength3)};
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      shown.force += test::index_segment(s, k).force * test::index_segment(s, k).normal;
    return shown;
  }
  /// The distance of the meshes of finger and object; 0 where they meet.
  [[nodiscard]] double gap() override {
    double least = kInfinity;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const auto segment = static_cast<std::size_t>(segment_index(test::kIndex, k));
      const PlacedSegment placed{model_.trees()[segment], hand_.now().gdp_pose[segment], scratch_};
      least = std::min(least, phalanx::distance(placed, model_.object.tree(), 1e-3));
    }
    return least;
  }

 private:
  const test::Setup& model_;
  SearchScratch scratch_;
  test::Runner hand_;
};

/// A ball of the fingertip's radius, with a spring and a damper to the measured fingertip. The force is the
/// spring's.
class MuJoCo : public Program {
 public:
  /// @param of_contacts      MJCF attributes; empty: MuJoCo's defaults
  /// @param impedance_ratio  of friction's constraint to the normal one's
  MuJoCo(const Scene& scene, const Vec3& start, const std::string& of_contacts, double impedance_ratio)
      : scene_(scene) {
    std::string geoms;
    const auto vector = [](const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); };
    if (scene.ball > 0.0)
      geoms +=
          fmt::format("<geom type='sphere' size='{}' pos='0 0 {}'/>", 0.5 * scene.ball, -0.5 * scene.ball);
    for (const auto& [size, pose] : scene.boxes) {
      const Eigen::Quaterniond q(pose.R);
      geoms += fmt::format("<geom type='box' size='{}' pos='{}' quat='{} {} {} {}'/>", vector(0.5 * size),
                           vector(pose.p), q.w(), q.x(), q.y(), q.z());
    }
    std::string joints;
    for (const char* axis : {"1 0 0", "0 1 0", "0 0 1"})
      joints += fmt::format("<joint type='slide' axis='{}' stiffness='{}' damping='{}'/>", axis, kStiffness,
                            kTipDamping);
    const std::string xml = fmt::format(
        "<mujoco><option timestep='{}' gravity='0 0 0' cone='elliptic' impratio='{}'/>"
        "<default><geom friction='{} 0 0' condim='3' {}/></default><worldbody>{}"
        "<body pos='{}'>{}<geom type='sphere' size='{}' mass='{}'/></body></worldbody></mujoco>",
        kPeriod, impedance_ratio, kFriction, of_contacts, geoms, vector(start), joints,
        LoneFinger::kTipRadius, kMass);
    auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "fingertip.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[0], xml.data(), xml.size());
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML("fingertip.xml", files.get(), error.data(), static_cast<int>(error.size())));
    mj_deleteVFS(files.get());
    if (!model_) throw std::runtime_error(fmt::format("MuJoCo refuses the fingertip: {}", error.data()));
    data_.reset(mj_makeData(model_.get()));
    start_ = start;
  }
  Shown tick(const Measured& measured) override {
    for (int i = 0; i < 3; ++i) {
      model_->qpos_spring[i] = (measured.tip - start_)[i];
      data_->qfrc_applied[i] = kTipDamping * measured.velocity[i];
    }
    mj_step(model_.get(), data_.get());
    Shown shown;
    for (int i = 0; i < 3; ++i) shown.tip[i] = start_[i] + data_->qpos[i];
    shown.force = kStiffness * (shown.tip - measured.tip);
    tip_at_ = shown.tip;
    return shown;
  }
  [[nodiscard]] double gap() override { return scene_.distance(tip_at_) - LoneFinger::kTipRadius; }

 private:
  const Scene& scene_;
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  Vec3 start_ = Vec3::Zero();
  Vec3 tip_at_ = Vec3::Zero();
};

/// The same in Bullet. Its lengths are in centimetres, since it is made for bodies of 0.05 to 10 units.
class Bullet : public Program {
 public:
  Bullet(const Scene& scene, const Vec3& start) : scene_(scene) {
    world_.setGravity(btVector3(0, 0, 0));
    world_.getSolverInfo().m_numIterations = 50;
    if (scene.ball > 0.0)
      add(std::make_unique<btSphereShape>(unit(0.5 * scene.ball)), test::at(0.0, 0.0, -0.5 * scene.ball),
          0.0);
    for (const auto& [size, pose] : scene.boxes)
      add(std::make_unique<btBoxShape>(units(0.5 * size)), pose, 0.0);
    Pose at;
    at.p = start;
    tip_ = add(std::make_unique<btSphereShape>(unit(LoneFinger::kTipRadius)), at, kMass);
    tip_->setAngularFactor(0);
    tip_->setActivationState(DISABLE_DEACTIVATION);
  }
  Shown tick(const Measured& measured) override {
    const btVector3 away = units(measured.tip) - tip_->getWorldTransform().getOrigin();
    tip_->applyCentralForce(static_cast<btScalar>(kStiffness) * away -
                            static_cast<btScalar>(kTipDamping) *
                                (tip_->getLinearVelocity() - units(measured.velocity)));
    world_.stepSimulation(static_cast<btScalar>(kPeriod), 0);
    const btVector3& now = tip_->getWorldTransform().getOrigin();
    Shown shown;
    shown.tip = Vec3(now.x(), now.y(), now.z()) / kUnits;
    shown.force = kStiffness * (shown.tip - measured.tip);
    tip_at_ = shown.tip;
    return shown;
  }
  [[nodiscard]] double gap() override { return scene_.distance(tip_at_) - LoneFinger::kTipRadius; }

 private:
  static constexpr double kUnits = 100.0;  // in a metre
  static btScalar unit(double metres) { return static_cast<btScalar>(kUnits * metres); }
  static btVector3 units(const Vec3& v) { return {unit(v.x()), unit(v.y()), unit(v.z())}; }

  btRigidBody* add(std::unique_ptr<btCollisionShape> shape, const Pose& pose, double mass) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0.0) shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape.get(), inertia);
    const Eigen::Quaterniond q(pose.R);
    info.m_startWorldTransform =
        btTransform(btQuaternion(static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()),
                                 static_cast<btScalar>(q.z()), static_cast<btScalar>(q.w())),
                    units(pose.p));
    info.m_friction = static_cast<btScalar>(mass > 0.0 ? kFriction : 1.0);  // their product counts
    shapes_.push_back(std::move(shape));
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
    return bodies_.back().get();
  }

  const Scene& scene_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btRigidBody* tip_ = nullptr;
  Vec3 tip_at_ = Vec3::Zero();
};

/// The motion: pressed, held, dragged, held, dragged back and lifted. Phases are by ticks.
struct Motion {
  static constexpr int kPress = 300, kHold = 800, kDrag = 1400, kHeld = 3400, kBack = 4000, kEnd = 4200;
  std::vector<Measured> tick;
};

Motion motion_over(const Scene& scene) {
  LoneFinger finger = finger_at(scene);
  const double start = finger.aim({.from = Vec3(0.0, 0.0, scene.touches_at + 2e-3)});
  const double down = start + (2e-3 + kDepth) / LoneFinger::lever();
  const double across =
      scene.boxes.size() == 2 ? 0.0 : 0.1;  // along a groove the finger is not dragged: it is held by both
  Motion motion;
  HandPoses poses;
  const auto blend = [](double a, double b, int i, int from, int to) {
    return a + (b - a) * std::clamp((i - from) / static_cast<double>(to - from), 0.0, 1.0);
  };
  for (int i = 0; i < Motion::kEnd; ++i) {
    double angle = blend(start, down, i, 0, Motion::kPress);
    if (i >= Motion::kBack) angle = blend(down, start, i, Motion::kBack, Motion::kEnd);
    double abduction = blend(0.0, across, i, Motion::kHold, Motion::kDrag);
    if (i >= Motion::kHeld) abduction = blend(across, 0.0, i, Motion::kHeld, Motion::kBack);
    Measured measured{.angle = LoneFinger::pose(angle, abduction)};
    finger.model().hand.poses(measured.angle, poses);
    measured.tip = poses.digit[test::kIndex].segment[2] * Vec3(0.0, 0.0, -test::kLength3);
    if (i > 0) measured.velocity = (measured.tip - motion.tick.back().tip) / kPeriod;
    motion.tick.push_back(measured);
  }
  return motion;
}

struct Result {
  double least_gap = kInfinity;  ///< of the shown fingertip and the object [m]
  double law_error = 0.0;   ///< of the force at rest upwards, against k times the way since it touched [-]
  double jump = 0.0;        ///< greatest change of the force in a tick beyond k times the measured motion [N]
  double creep = 0.0;       ///< way of the shown fingertip in the hold after the drag, from 0.1 to 2 s [m]
  double friction = 0.0;    ///< ratio of friction and normal force at the end of the drag
  double median_us = 0.0;   ///< of a tick in contact
  double slowest_us = 0.0;  ///< of 99.9 % of the ticks in contact
};

/// Nearest rank. @param times  sorted
double percentile(const std::vector<double>& times, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(times.size())));
  return times.empty() ? 0.0 : times[std::clamp<std::size_t>(rank, 1, times.size()) - 1];
}

/// Runs the motion. @param times  of each tick in contact [us]; the least of this and earlier runs
Result run_once(const Scene& scene, const Motion& motion, Program& program, std::vector<double>& times) {
  Result result;
  Vec3 force_before = Vec3::Zero();
  Vec3 held = Vec3::Zero();
  std::size_t touching = 0;
  for (int i = 0; i < Motion::kEnd; ++i) {
    const Measured& measured = motion.tick[static_cast<std::size_t>(i)];
    const Stopwatch watch;
    const Shown shown = program.tick(measured);
    const double us = watch.us();
    result.least_gap = std::min(result.least_gap, program.gap());
    if (scene.distance(measured.tip) < LoneFinger::kTipRadius) {
      if (touching == times.size()) times.push_back(us);
      times[touching] = std::min(times[touching], us);
      ++touching;
    }
    const double motion_force = kStiffness * kPeriod * measured.velocity.norm();
    result.jump = std::max(result.jump, (shown.force - force_before).norm() - motion_force);
    force_before = shown.force;
    if (i == Motion::kHold - 1)
      result.law_error = shown.force.z() / (kStiffness * (scene.touches_at - measured.tip.z())) - 1.0;
    if (i == Motion::kDrag - 1 && scene.has_face)
      result.friction = std::hypot(shown.force.x(), shown.force.y()) / shown.force.z();
    if (i == Motion::kDrag + 100) held = shown.tip;
    if (i == Motion::kHeld - 1) result.creep = (shown.tip - held).norm();
  }
  return result;
}

/// Runs the motion three times from the start, and takes each tick's least time.
Result run(const Scene& scene, const Motion& motion, const std::function<std::unique_ptr<Program>()>& make) {
  std::vector<double> times;
  Result result;
  for (int i = 0; i < 3; ++i) result = run_once(scene, motion, *make(), times);
  std::sort(times.begin(), times.end());
  result.median_us = percentile(times, 0.5);
  result.slowest_us = percentile(times, 0.999);
  return result;
}

void print(const std::string& scene, const std::string& program, const Result& r) {
  fmt::print("| {} | {} | {:.1f} | {:+.2f} | {:.1f} | {:.2f} | {} | {:.1f} / {:.1f} |\n", scene, program,
             1e6 * std::max(0.0, -r.least_gap), 100.0 * r.law_error, 1e3 * r.jump, 1e6 * r.creep,
             r.friction > 0.0 ? fmt::format("{:.4f}", r.friction) : std::string("-"), r.median_us,
             r.slowest_us);
}

void compare() {
  fmt::print("A fingertip of 5 mm radius, {} N/m, friction {}, {} mm deep, 1 kHz.\n\n", kStiffness, kFriction,
             1e3 * kDepth);
  fmt::print(
      "| object | program | penetration [um] | force against the law [%] | jump [mN] | creep in 1.9 s [um] | "
      "friction, dragged | "
      "median / 99.9 % of a tick [us] |\n|---|---|---|---|---|---|---|---|\n");
  for (const Scene& scene : scenes()) {
    const Motion motion = motion_over(scene);
    const Vec3 start = motion.tick.front().tip;
    LoneFinger finger = finger_at(scene);
    (void)finger.aim({.from = Vec3(0.0, 0.0, scene.touches_at + 2e-3)});
    const Result ours = run(scene, motion, [&] { return std::make_unique<Ours>(finger); });
    if (!(ours.least_gap > finger.model().parameters.contact.margin - 10e-9))
      throw std::runtime_error(
          fmt::format("{}: our fingertip comes nearer than its margin: {} m", scene.name, ours.least_gap));
    print(scene.name, "Phalanx", ours);
    const auto mujoco = [&](const char* of_contacts, double impedance_ratio) {
      return run(scene, motion,
                 [&] { return std::make_unique<MuJoCo>(scene, start, of_contacts, impedance_ratio); });
    };
    print(scene.name, fmt::format("MuJoCo {}", mj_versionString()), mujoco("", 1.0));
    print(scene.name, fmt::format("MuJoCo {}, stiff contacts", mj_versionString()),
          mujoco("solref='0.002 1' solimp='0.99 0.999 0.0001'", 100.0));
    print(scene.name, fmt::format("Bullet {}.{:02}", btGetVersion() / 100, btGetVersion() % 100),
          run(scene, motion, [&] { return std::make_unique<Bullet>(scene, start); }));
  }
}

}  // namespace
}  // namespace phalanx::bench

int main() {
  try {
    phalanx::bench::compare();
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "phalanx_bench_engines: {}\n", error.what());
    return 1;
  }
}
