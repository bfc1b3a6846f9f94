// SPDX-License-Identifier: Apache-2.0
// The exported hand, loaded back by readers that are not ours: where every segment is at random angles.
#include "phalanx/scene/hand_export.h"

#include <gmock/gmock.h>
#include <mujoco/mujoco.h>
#include <urdf_parser/urdf_parser.h>

#include <memory>
#include <random>
#include <sstream>

#include "phalanx/force/force_parameters.h"
#include "phalanx/mesh/primitives.h"
#include "scene/hands/hand_files.h"
#include "scene/hands/mass_properties.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

struct Case {
  const char* name;
  const char* profile;  ///< empty: the adult's hand
  Handedness handedness;
  HandMeshSource meshes = HandMeshSource::kCapsules;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// The adult's hand with its thumb's and index's D-H rows made general: offsets, angles, a link between the
/// two axes of the first joint.
void make_general(HandParameters& hand) {
  for (const std::size_t digit : {0U, 1U}) {
    auto& dh = hand.digits[digit].dh;
    dh[0].a = 0.004;
    for (std::size_t i = 0; i < kJointsPerDigit; ++i) {
      dh[i].d = 0.003 - 0.001 * static_cast<double>(i);
      dh[i].theta = 0.1 + 0.2 * static_cast<double>(i);
      dh[i].alpha += 0.15;
    }
  }
}

LoadedHand load(const Case& c) {
  HandDescription description;
  description.mesh_source = c.meshes;
  description.triangles = 800;
  description.profile = c.profile;
  description.handedness = c.handedness;
  LoadedHand hand = load_hand(description);
  const std::string_view name(c.name);
  if (name.find("General") != std::string_view::npos) make_general(hand.parameters);
  if (name.find("Coupled") != std::string_view::npos) hand.parameters = test::coupled(hand.parameters);
  return hand;
}

class HandExport : public ::testing::TestWithParam<Case> {
 protected:
  HandExport()
      : hand_(load(GetParam())), model_(hand_.parameters, hand_.handedness, {}, hand_.meshes.collision) {}

  /// Calls `check` with seeded angles over the range of motion, its ends too, and the poses they give.
  template <typename Check>
  void at_random_angles(Check&& check) {
    std::mt19937_64 random(21);
    for (int n = 0; n < 200; ++n) {
      JointArray q{};
      for (std::size_t j = 0; j < kJoints; ++j) {
        std::uniform_real_distribution<double> u(hand_.parameters.min_angle[j],
                                                 hand_.parameters.max_angle[j]);
        q[j] = n == 0 ? hand_.parameters.min_angle[j] : n == 1 ? hand_.parameters.max_angle[j] : u(random);
      }
      HandPoses poses;
      model_.poses(q, poses);
      check(q, [&](int segment) -> Pose {
        if (segment == kPalm) return model_.palm_pose();
        return poses.digit[static_cast<std::size_t>(digit_of_segment(segment))]
            .segment[static_cast<std::size_t>(segment % kSegmentsPerDigit)];
      });
    }
  }

  /// Number of hinges that are no joints: one a coefficient.
  [[nodiscard]] int coupled_hinges() const {
    int count = 0;
    for (const DigitParameters& digit : hand_.parameters.digits) {
      for (const double ratio : {digit.coupling.metacarpal_per_flexion, digit.coupling.pronation_per_flexion,
                                 digit.coupling.pronation_per_abduction})
        count += ratio != 0.0 ? 1 : 0;
    }
    return count;
  }

  LoadedHand hand_;
  HandModel model_;
};

/// Largest difference of two poses: of positions [m], of rotation matrices' entries [-].
struct Difference {
  double position = 0.0;
  double rotation = 0.0;
  void add(const Pose& a, const Pose& b) {
    position = std::max(position, (a.p - b.p).norm());
    rotation = std::max(rotation, (a.R - b.R).cwiseAbs().maxCoeff());
  }
};

Pose of_urdf(const urdf::Pose& pose) {
  const Eigen::Quaterniond q(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  return {q.toRotationMatrix(), Vec3(pose.position.x, pose.position.y, pose.position.z)};
}

/// Pose of a link in the root link by the reader's own tree.
Pose link_pose(const urdf::ModelInterface& robot, const std::string& name, const JointArray& q) {
  Pose X;
  for (urdf::LinkConstSharedPtr link = robot.getLink(name); link && link->parent_joint;
       link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
    const auto angle_of = [&](const std::string& of) {
      return q[static_cast<std::size_t>(find_joint(of).value())];
    };
    const double angle =
        joint.mimic ? joint.mimic->multiplier * angle_of(joint.mimic->joint_name) + joint.mimic->offset
                    : angle_of(joint.name);
    X = of_urdf(joint.parent_to_joint_origin_transform) *
        (Pose{rotation_about(axis, angle), Vec3::Zero()} * X);
  }
  return X;
}

TEST_P(HandExport, AsUrdfHasOurForwardKinematicsAndLimitsInUrdfdom) {
  const auto robot = urdf::parseURDF(urdf_text(hand_, {}));
  ASSERT_TRUE(robot);
  EXPECT_EQ(robot->getName(), hand_.parameters.name);
  EXPECT_EQ(robot->getRoot()->name, "wrist");
  EXPECT_EQ(robot->links_.size(), static_cast<std::size_t>(kSegments + kDigits + coupled_hinges()));
  EXPECT_EQ(robot->joints_.size(), static_cast<std::size_t>(kJoints + coupled_hinges()));
  for (int j = 0; j < kJoints; ++j) {
    const auto joint = robot->getJoint(std::string(joint_name(j)));
    ASSERT_TRUE(joint) << joint_name(j);
    EXPECT_EQ(joint->type, urdf::Joint::REVOLUTE);
    EXPECT_EQ(joint->limits->lower, hand_.parameters.min_angle[static_cast<std::size_t>(j)]);
    EXPECT_EQ(joint->limits->upper, hand_.parameters.max_angle[static_cast<std::size_t>(j)]);
    EXPECT_EQ(joint->limits->effort, LimitParameters{}.joint_torque);
    EXPECT_EQ(joint->limits->velocity, LimitParameters{}.joint_speed);
  }
  for (const auto& [name, joint] : robot->joints_) {
    if (!joint->mimic) continue;
    const auto of = static_cast<std::size_t>(find_joint(joint->mimic->joint_name).value());
    const double ratio = joint->mimic->multiplier;
    const auto [least, largest] =
        std::minmax({ratio * hand_.parameters.min_angle[of], ratio * hand_.parameters.max_angle[of]});
    EXPECT_EQ(joint->limits->lower, least) << name;
    EXPECT_EQ(joint->limits->upper, largest) << name;
    EXPECT_EQ(joint->limits->velocity, std::abs(ratio) * LimitParameters{}.joint_speed) << name;
  }
  Difference worst;
  at_random_angles([&](const JointArray& q, const auto& pose_of) {
    for (int s = 0; s < kSegments; ++s)
      worst.add(link_pose(*robot, std::string(segment_name(s)), q), pose_of(s));
  });
  EXPECT_LT(worst.position, 1e-9) << "seed 21";
  EXPECT_LT(worst.rotation, 1e-9) << "seed 21";
  RecordProperty("position_m", ::testing::PrintToString(worst.position));
  RecordProperty("rotation", ::testing::PrintToString(worst.rotation));
}

TEST_P(HandExport, AsUrdfNamesItsMeshesItsMassAndItsInertia) {
  const auto robot = urdf::parseURDF(urdf_text(hand_, {.collision = "c <1> \"2\"", .display = "d & e"}));
  ASSERT_TRUE(robot);
  double mass = 0.0;
  for (int s = 0; s < kSegments; ++s) {
    const std::string name(segment_name(s));
    const auto link = robot->getLink(name);
    ASSERT_TRUE(link && link->inertial && link->visual && link->collision) << name;
    const urdf::Inertial& inertial = *link->inertial;
    mass += inertial.mass;
    const MassProperties expected =
        mass_properties(hand_.meshes.collision[static_cast<std::size_t>(s)], kHandDensity);
    Mat3 inertia;
    inertia << inertial.ixx, inertial.ixy, inertial.ixz,  //
        inertial.ixy, inertial.iyy, inertial.iyz,         //
        inertial.ixz, inertial.iyz, inertial.izz;
    EXPECT_LT((inertia - expected.inertia).norm(), 1e-12 * expected.inertia.trace()) << name;
    const Pose at = of_urdf(inertial.origin);
    EXPECT_LT((at.p - expected.centre).norm(), 1e-12) << name;
    EXPECT_LT((at.R - Mat3::Identity()).norm(), 1e-15) << name;
    const auto mesh_of = [](const urdf::GeometrySharedPtr& geometry) {
      return std::dynamic_pointer_cast<urdf::Mesh>(geometry)->filename;
    };
    EXPECT_EQ(mesh_of(link->collision->geometry), "c <1> \"2\"/" + name + ".obj");
    EXPECT_EQ(mesh_of(link->visual->geometry), "d & e/" + name + ".obj");
  }
  double volume = 0.0;
  for (const TriangleMesh& mesh : hand_.meshes.collision) volume += signed_volume(mesh);
  EXPECT_NEAR(mass, kHandDensity * volume, 1e-12);
}

/// MuJoCo's model of a text, its meshes written beside it; fails the test with MuJoCo's own words.
class MujocoHand {
 public:
  explicit MujocoHand(const LoadedHand& hand, const ExportedMeshes& meshes = {}) {
    folder_.write_meshes(hand.meshes.collision, 1.0);
    folder_.write_meshes(hand.meshes.display, 1.0);
    if (meshes.display != meshes.collision)
      std::filesystem::copy(folder_.path() / meshes.collision, folder_.path() / meshes.display);
    const std::string file = (folder_.path() / "hand.xml").string();
    std::ofstream(file) << mjcf_text(hand, meshes);
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
    EXPECT_TRUE(model_) << error.data();
    if (model_) data_.reset(mj_makeData(model_.get()));
  }
  [[nodiscard]] const mjModel* model() const { return model_.get(); }
  [[nodiscard]] int id(mjtObj kind, std::string_view name) const {
    return mj_name2id(model_.get(), kind, std::string(name).c_str());
  }
  void pose(const JointArray& q) {
    for (int j = 0; j < kJoints; ++j)
      data_->qpos[model_->jnt_qposadr[id(mjOBJ_JOINT, joint_name(j))]] = q[static_cast<std::size_t>(j)];
    for (int e = 0; e < model_->neq; ++e) {  // what MuJoCo's solver would bring about
      const mjtNum* coefficient = model_->eq_data + mjNEQDATA * e;
      const mjtNum driver = data_->qpos[model_->jnt_qposadr[model_->eq_obj2id[e]]];
      data_->qpos[model_->jnt_qposadr[model_->eq_obj1id[e]]] = coefficient[0] + coefficient[1] * driver;
    }
    mj_kinematics(model_.get(), data_.get());
  }
  [[nodiscard]] Pose body(int segment) const {
    const int body = id(mjOBJ_BODY, segment_name(segment));
    Pose X;
    X.p = Eigen::Map<const Vec3>(data_->xpos + 3 * body);
    X.R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->xmat + 9 * body);
    return X;
  }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  test::HandFolder folder_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
};

TEST_P(HandExport, AsMjcfHasOurForwardKinematicsAndLimitsInMujoco) {
  MujocoHand mujoco(hand_);
  ASSERT_TRUE(mujoco.model());
  EXPECT_EQ(mujoco.model()->njnt, kJoints + coupled_hinges());
  EXPECT_EQ(mujoco.model()->neq, coupled_hinges());
  for (int e = 0; e < mujoco.model()->neq; ++e) {
    EXPECT_EQ(mujoco.model()->eq_type[e], mjEQ_JOINT);
    const mjtNum* coefficient = mujoco.model()->eq_data + mjNEQDATA * e;
    for (const int other : {0, 2, 3, 4}) EXPECT_EQ(coefficient[other], 0.0) << "proportional";
    const int coupled = mujoco.model()->eq_obj1id[e];
    const int joint = mujoco.model()->eq_obj2id[e];
    const mjtNum* range = mujoco.model()->jnt_range + 2 * joint;
    const auto [least, largest] = std::minmax({coefficient[1] * range[0], coefficient[1] * range[1]});
    EXPECT_EQ(mujoco.model()->jnt_range[2 * coupled], least);
    EXPECT_EQ(mujoco.model()->jnt_range[2 * coupled + 1], largest);
  }
  EXPECT_EQ(mujoco.model()->nbody, kSegments + 1);
  for (int j = 0; j < kJoints; ++j) {
    const int id = mujoco.id(mjOBJ_JOINT, joint_name(j));
    ASSERT_GE(id, 0) << joint_name(j);
    EXPECT_TRUE(mujoco.model()->jnt_limited[id]);
    EXPECT_EQ(mujoco.model()->jnt_range[2 * id], hand_.parameters.min_angle[static_cast<std::size_t>(j)]);
    EXPECT_EQ(mujoco.model()->jnt_range[2 * id + 1], hand_.parameters.max_angle[static_cast<std::size_t>(j)]);
  }
  Difference worst;
  at_random_angles([&](const JointArray& q, const auto& pose_of) {
    mujoco.pose(q);
    for (int s = 0; s < kSegments; ++s) worst.add(mujoco.body(s), pose_of(s));
  });
  EXPECT_LT(worst.position, 1e-9) << "seed 21";
  EXPECT_LT(worst.rotation, 1e-9) << "seed 21";
  RecordProperty("position_m", ::testing::PrintToString(worst.position));
  RecordProperty("rotation", ::testing::PrintToString(worst.rotation));
}

// MuJoCo moves a mesh's own frame to its centre of mass and back: a vertex must come out where it was.
TEST_P(HandExport, AsMjcfKeepsItsMeshesAndMassesInPlace) {
  MujocoHand mujoco(hand_);
  ASSERT_TRUE(mujoco.model());
  const mjModel& m = *mujoco.model();
  mujoco.pose(JointArray{});
  for (int s = 0; s < kSegments; ++s) {
    const TriangleMesh& mesh = hand_.meshes.collision[static_cast<std::size_t>(s)];
    const int body = mujoco.id(mjOBJ_BODY, segment_name(s));
    const int geom = m.body_geomadr[body];
    const int data = m.geom_dataid[geom];
    const Eigen::Map<const Eigen::Vector4d> wxyz(m.geom_quat + 4 * geom);
    const Mat3 R = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).toRotationMatrix();
    const Vec3 p = Eigen::Map<const Vec3>(m.geom_pos + 3 * geom);
    Bounds box{Vec3::Constant(1.0), Vec3::Constant(-1.0)};
    for (int v = 0; v < m.mesh_vertnum[data]; ++v) {
      const float* vertex = m.mesh_vert + 3 * (m.mesh_vertadr[data] + v);
      const Vec3 placed = R * Eigen::Vector3f(vertex[0], vertex[1], vertex[2]).cast<double>() + p;
      box.min = box.min.cwiseMin(placed);
      box.max = box.max.cwiseMax(placed);
    }
    const Bounds expected = bounds(mesh);
    EXPECT_LT((box.min - expected.min).norm(), 1e-6) << segment_name(s) << ": single precision";
    EXPECT_LT((box.max - expected.max).norm(), 1e-6) << segment_name(s);
    const MassProperties mass = mass_properties(mesh, kHandDensity);
    EXPECT_NEAR(m.body_mass[body], mass.mass, 1e-12);
    EXPECT_LT((Eigen::Map<const Vec3>(m.body_ipos + 3 * body) - mass.centre).norm(), 1e-12);
    // MuJoCo keeps the moments about the main axes and a turn to them. It stops turning where what is left
    // beside the diagonal is below 1e-12 kg m^2, or the next turn below 1.4e-6 rad.
    const Eigen::Map<const Vec3> moments(m.body_inertia + 3 * body);
    EXPECT_NEAR(moments.sum(), mass.inertia.trace(), 1e-12);
    const Eigen::Map<const Eigen::Vector4d> turn(m.body_iquat + 4 * body);
    const Mat3 Q = Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]).toRotationMatrix();
    const Mat3 inertia = Q * moments.asDiagonal() * Q.transpose();
    EXPECT_LT((inertia - mass.inertia).norm(), 5e-12 + 5e-6 * mass.inertia.trace()) << segment_name(s);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, HandExport,
    ::testing::Values(
        Case{"AdultRight", "", Handedness::kRight, HandMeshSource::kFile},
        Case{"AdultLeft", "", Handedness::kLeft, HandMeshSource::kFile},
        Case{"CapsulesRight", "", Handedness::kRight}, Case{"CapsulesLeft", "", Handedness::kLeft},
        Case{"GeneralDhRight", "", Handedness::kRight}, Case{"GeneralDhLeft", "", Handedness::kLeft},
        Case{"CoupledRight", "", Handedness::kRight}, Case{"CoupledLeft", "", Handedness::kLeft},
        Case{"GeneralCoupledLeft", "", Handedness::kLeft},
        Case{"SmallWomanRight", "small-woman", Handedness::kRight, HandMeshSource::kFile},
        Case{"LargeManLeft", "large-man", Handedness::kRight, HandMeshSource::kFile},
        Case{"StiffHandRight", "stiff-hand", Handedness::kRight, HandMeshSource::kFile}),
    [](const auto& test) { return std::string(test.param.name); });

// A mesh that is shown and met is read once, two that differ are both. Contacts are left out between the palm
// and each of the 15 other segments, and between the first ones of the 4 pairs of neighbouring digits.
TEST(HandAsMjcf, ReadsBothSetsOfMeshesAndLeavesOutWhatAlwaysTouches) {
  const LoadedHand hand = load(Case{"CapsulesRight", "", Handedness::kRight});
  const MujocoHand one(hand);
  ASSERT_TRUE(one.model());
  EXPECT_EQ(one.model()->nmesh, kSegments);
  EXPECT_EQ(one.model()->nexclude, 15 + 4);
  const MujocoHand two(hand, {.collision = "meshes", .display = "shown"});
  ASSERT_TRUE(two.model());
  EXPECT_EQ(two.model()->nmesh, 2 * kSegments);
  const std::string text = mjcf_text(hand, {});
  for (const char* pair :
       {R"(body1="wrist" body2="thumb-metacarpal")", R"(body1="wrist" body2="pinky-finger-phalanx-distal")",
        R"(body1="thumb-metacarpal" body2="index-finger-phalanx-proximal")",
        R"(body1="ring-finger-phalanx-proximal" body2="pinky-finger-phalanx-proximal")"})
    EXPECT_THAT(text, ::testing::HasSubstr(std::string("<exclude ") + pair + "/>"));
}

TEST(HandAsMjcf, IsIndentedByTwoBlanksForEachElementThatIsOpen) {
  std::istringstream text(mjcf_text(load(Case{"CapsulesRight", "", Handedness::kRight}), {}));
  std::size_t open = 0;
  std::size_t lines = 0;
  for (std::string line; std::getline(text, line); ++lines) {
    const std::size_t begin = line.find_first_not_of(' ');
    ASSERT_NE(begin, std::string::npos);
    const bool closes = line.compare(begin, 2, "</") == 0;
    if (closes) --open;
    EXPECT_EQ(begin, 2 * open) << line;
    const bool closed_within = line.ends_with("/>") || line.find("</") != std::string::npos;
    if (!closed_within) ++open;
  }
  EXPECT_EQ(open, 0U);
  EXPECT_GT(lines, static_cast<std::size_t>(4 * kSegments)) << "a body, its inertia and its two meshes";
}

// A box of a x b x c: m = rho a b c, Ixx = m (b^2 + c^2) / 12.
TEST(MassProperties, OfABoxAreThoseOfTheTextbook) {
  TriangleMesh box;
  append(box, make_box({0.02, 0.04, 0.06}, 300), Pose{Mat3::Identity(), Vec3(1.0, -2.0, 3.0)});
  const MassProperties m = mass_properties(box, 1000.0);
  EXPECT_NEAR(m.mass, 0.048, 1e-12);
  EXPECT_LT((m.centre - Vec3(1.0, -2.0, 3.0)).norm(), 1e-12);
  const Vec3 expected =
      0.048 / 12.0 * Vec3(0.04 * 0.04 + 0.06 * 0.06, 0.02 * 0.02 + 0.06 * 0.06, 0.02 * 0.02 + 0.04 * 0.04);
  EXPECT_LT((m.inertia - Mat3(expected.asDiagonal())).cwiseAbs().maxCoeff(), 1e-15);
}

}  // namespace
}  // namespace phalanx
