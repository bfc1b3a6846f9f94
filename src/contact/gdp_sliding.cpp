// SPDX-License-Identifier: Apache-2.0
// The GDP in sliding mode: joints move towards the HCP while contacts with Coulomb friction stop them, and the
// continuous search ends each motion before anything penetrates. See docs/sliding.md.
#include <algorithm>
#include <cmath>

#include "contact/contact_problem.h"
#include "contact/first_contact.h"
#include "contact/gdp_digit.h"
#include "contact/manifold.h"
#include "contact/object_end.h"
#include "phalanx/core/constants.h"

namespace phalanx {
namespace {

constexpr double kClearance = 10e-6;  // h1 - h0: working clearance above the margin [m]
constexpr double kMostReach = 50e-6;  // beyond it the continuous search finds contacts [m]
constexpr double kSlack = 20e-6;      // of the reach, above the way of this tick [m]
constexpr double kAnchorGain = 0.2;   // share of the rotation since spin was held, taken back in a substep
constexpr double kFrictionDepth = 40e-6;    // friction at zero depth counts this much [m]
constexpr double kMostRecovery = 2e-6;      // way back to the working clearance in a substep [m]
constexpr double kLeastRecovery = 1e-9;     // [m]
constexpr double kRecoveryAlong = 2.0;      // springs follow it by at most this times its way off the surface
constexpr double kRounding = 1e-12;         // [m]
constexpr double kMostSlide = 1e-3;         // of a touching segment in a substep [m]
constexpr double kTolerance = 1e-12;        // of the contact problem [m]
constexpr double kStill = 1e-13;            // displacement that is no motion [rad]
constexpr double kTouching = 0.2e-6;        // above the working clearance [m]
constexpr double kSamePlace = 3e-3;         // a contact may move by this much between two substeps [m]
constexpr double kSameDirection = 0.99995;  // cosine: a contact that opposes a motion already
constexpr double kSameBlock = 50e-6;        // [m]
constexpr double kDepthRise = 0.02;         // greatest relative rise of depth_per_multiplier in a substep
constexpr double kLeastFactor = 1e-12;      // of depth_per_multiplier [m^2]
constexpr double kOwnCompliance = 0.05;     // share of friction's compliance that is each contact's own
constexpr double kLeastLoadShare = 0.25;    // of a contact in its segment's load
constexpr double kLongestSubstep = 1e-3;    // [s]
constexpr double kMostSubsteps = 20.0;
constexpr int kSweeps = 6;        // then Newton's method goes on
constexpr int kSweepsOfOne = 20;  // of a single contact
constexpr int kRecoverySweeps = 8;
constexpr double kSoftness = 0.05;  // of the recovery, so that it converges between opposed contacts
constexpr int kMostEvents = 4;

static_assert(DigitContacts::kMost == ContactProblem::kMostContacts);
static_assert(kSegmentsPerDigit * Manifold::kMost + kMostEvents <= DigitContacts::kMost);

/// Motion of one digit in one substep.
class Substep {
 public:
  Substep(const ContactModel& model, const DigitAngles& goal, const DigitPose& goal_pose, DigitTick& tick,
          GdpState& state, int& evaluations) noexcept
      : model_(model),
        goal_(goal),
        goal_pose_(goal_pose),
        tick_(tick),
        state_(state),
        contacts_(state.sliding[idx(tick.digit)]),
        evaluations_(evaluations) {
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t joint = idx(joint_index(tick.digit, i));
      lowest_[idx(i)] = model.hand.parameters().min_angle[joint];
      highest_[idx(i)] = model.hand.parameters().max_angle[joint];
    }
  }

  void run() noexcept {
    for (int event = 0;; ++event) {
      const bool touching = contacts_.count > 0 || event > 0;
      if (touching) {
        gather();
        recover(event == 0 ? kMostRecovery : kClearance);
      }
      const DigitAngles from = tick_.angle;
      const DigitAngles x = displacement();
      const Stop stop = move(x);
      if (touching) follow_springs(from);
      if (stop.segment < 0) return;
      if (event == kMostEvents || has(tick_.status, Status::kSearchExhausted)) {
        tick_.status |= Status::kSearchExhausted;
        return;
      }
      add_block(stop.segment, x);
    }
  }

 private:
  [[nodiscard]] PlacedSegment placed(int k) noexcept {
    return {model_.trees[idx(segment_index(tick_.digit, k))], tick_.pose.segment[idx(k)], state_.scratch};
  }

  [[nodiscard]] NearPairs& near(int k) noexcept { return state_.near[idx(segment_index(tick_.digit, k))]; }

  /// Lists the contacts at the digit's pose, and the pairs that have stopped it in this substep. Multipliers go from
  /// the last contacts to these.
  void gather() noexcept {
    const DigitContacts last = contacts_;
    contacts_.count = 0;
    std::array<bool, DigitContacts::kMost> taken{};
    DigitAngles change{};
    for (std::size_t i = 0; i < change.size(); ++i) change[i] = tick_.hcp[i] - tick_.hcp_from[i];
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const double way = segment_speed(model_.hand, tick_.digit, change, k) + kSlack;
      const double reach = working_clearance() + std::min(kMostReach, way);
      if (state_.clearance[idx(segment_index(tick_.digit, k))].bound() > reach) continue;
      near(k).candidates().list(placed(k), model_.object.tree(), working_clearance() + way);
      Manifold manifold;
      find_manifold(placed(k), model_.object.tree(), reach, working_clearance() + kSlack,
                    model_.parameters.max_contacts, near(k), manifold);
      for (int i = 0; i < manifold.count; ++i) add(k, manifold.place[idx(i)], last, taken);
    }
    for (int b = 0; b < blocks_; ++b) {
      const Block& block = block_[idx(b)];
      ContactPlace place;
      place.triangle = -1;
      place.slot = block.slot;
      place.on_segment = tick_.pose.segment[idx(block.k)] * block.p_S;
      place.on_object = block.on_object;
      place.gap = block.direction.dot(place.on_segment - block.on_object);
      place.direction = block.direction;
      if (place.gap > 0.0 && !is_listed(block.k, place)) add(block.k, place, last, taken);
    }
    gathered_ = true;
  }

  /// Without friction a digit that started inside is shown by the shortest way out, in joint space.
  [[nodiscard]] double friction_of(int slot) const noexcept {
    if (state_.inside[idx(tick_.digit)] || !state_.started[idx(tick_.digit)]) return 0.0;
    return model_.object.friction(model_.object.tree().source(slot), model_.parameters.friction);
  }

  [[nodiscard]] double working_clearance() const noexcept { return model_.parameters.margin + kClearance; }

  [[nodiscard]] bool is_listed(int k, const ContactPlace& place) const noexcept {
    return std::any_of(contacts_.contact.begin(), contacts_.contact.begin() + contacts_.count,
                       [&](const SlidingContact& contact) {
                         return contact.k == k && contact.normal.dot(place.direction) >= kSameDirection &&
                                (contact.p_W - place.on_segment).squaredNorm() <= kSameBlock * kSameBlock;
                       });
  }

  void add(int k, const ContactPlace& place, const DigitContacts& last,
           std::array<bool, DigitContacts::kMost>& taken) noexcept {
    SlidingContact& contact = contacts_.contact[idx(contacts_.count++)];
    const Pose& X_WS = tick_.pose.segment[idx(k)];
    contact = {};
    contact.k = k;
    contact.triangle = place.triangle;
    contact.slot = place.slot;
    contact.p_S = X_WS.R.transpose() * (place.on_segment - X_WS.p);
    contact.p_W = place.on_segment;
    contact.normal = place.direction;
    contact.tangent[0] = place.direction.unitOrthogonal();
    contact.tangent[1] = place.direction.cross(contact.tangent[0]);
    const bool interpolated = model_.parameters.normal == ForceNormal::kInterpolated && near(k).is_at(X_WS);
    contact.force_normal = interpolated ? normal_at_place(model_.object, near(k), place) : place.direction;
    contact.gap = place.gap;
    contact.friction = friction_of(place.slot);

    int best = -1;
    double nearest = kSamePlace * kSamePlace;
    for (int i = 0; i < last.count; ++i) {
      const SlidingContact& before = last.contact[idx(i)];
      if (taken[idx(i)] || before.k != k || before.normal.dot(contact.normal) < kCos30Deg) continue;
      const bool same = place.triangle >= 0 && before.triangle == place.triangle && before.slot == place.slot;
      const double apart = same ? -1.0 : (before.p_S - contact.p_S).squaredNorm();
      if (apart < nearest) {
        nearest = apart;
        best = i;
      }
    }
    if (best < 0) return;
    taken[idx(best)] = true;
    const SlidingContact& before = last.contact[idx(best)];
    const Vec3 friction = before.tangential_multiplier();
    // A contact that has opened seldom pushes again at once. Of two contacts of one segment, the iteration would
    // take many sweeps to hand its load over.
    if (place.gap <= working_clearance() + kTouching) {
      contact.multiplier = {before.multiplier[0], friction.dot(contact.tangent[0]),
                            friction.dot(contact.tangent[1]), before.multiplier[3]};
    }
    contact.turned = before.turned;
    contact.slips = before.slips;
  }

  [[nodiscard]] static Vec3 along_surface(const Vec3& v, const Vec3& normal) noexcept {
    return v - v.dot(normal) * normal;
  }

  /// Stores the pair that stopped a motion x of segment k, so that it is a contact for the rest of the substep.
  void add_block(int k, const DigitAngles& x) noexcept {
    const SegmentMotion motion = segment_motion(model_.hand, tick_.digit, tick_.pose, x, k);
    const double cap = std::nextafter(model_.parameters.margin, 1.0);
    const ContactPatch patch = contact_patch(placed(k), model_.object, cap, &motion, near(k));
    if (patch.pairs == 0 || patch.lead_direction.isZero(0.0)) return;
    const Pose& X_WS = tick_.pose.segment[idx(k)];
    block_[idx(blocks_++)] = {k, patch.lead_slot, X_WS.R.transpose() * (patch.lead - X_WS.p),
                              patch.lead - patch.distance * patch.lead_direction, patch.lead_direction};
  }

  /// Returns the contact's row along its normal at the digit's pose [m/rad].
  [[nodiscard]] DigitAngles normal_row(const SlidingContact& contact) const noexcept {
    const PointJacobian J = point_jacobian(tick_.pose, contact.k, contact.p_W);
    DigitAngles row{};
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = contact.normal.dot(J.linear[i]);
    return row;
  }

  /// Returns the joints' displacement towards the goal that the contacts admit [rad].
  DigitAngles displacement() noexcept {
    DigitAngles free{};
    for (std::size_t i = 0; i < free.size(); ++i) free[i] = goal_[i] - tick_.angle[i];
    if (contacts_.count == 0) {
      contacts_.limit = {};
      solved_ = free;
      return free;
    }
    ContactProblem problem;
    set_up(free, problem);
    problem.limit = contacts_.limit;
    const double residual = solve_contacts(problem, contacts_.count > 1 ? kSweeps : kSweepsOfOne, kTolerance);
    contacts_.residual = std::max(contacts_.residual, residual);
    solved_ = problem.displacement;
    contacts_.limit = problem.limit;
    for (int i = 0; i < problem.count; ++i) {
      contacts_.contact[idx(i)].multiplier = problem.contact[idx(i)].multiplier;
      contacts_.contact[idx(i)].slips = problem.contact[idx(i)].slips;
      contacts_.contact[idx(i)].spins = problem.contact[idx(i)].spins;
    }
    DigitAngles x = problem.displacement;
    double farthest = 0.0;
    for (int c = 0; c < contacts_.count; ++c)
      if (contacts_.contact[idx(c)].multiplier[0] > 0.0)
        farthest =
            std::max(farthest, segment_speed(model_.hand, tick_.digit, x, contacts_.contact[idx(c)].k));
    if (farthest > kMostSlide)
      for (double& angle : x) angle *= kMostSlide / farthest;
    return x;
  }

  void set_up(const DigitAngles& free, ContactProblem& problem) noexcept {
    const double h1 = working_clearance();
    problem.free = free;
    problem.count = contacts_.count;
    set_limits(problem);
    problem.elongation = contacts_.elongation;
    const std::array<double, kSegmentsPerDigit> load = segment_load();
    const double factor = depth_per_multiplier();
    // A segment's contacts together give way by this, however many they are and whatever each bears.
    compliance_ = factor / model_.parameters.tangential_stiffness_ratio;
    problem.spring_compliance = (1.0 - kOwnCompliance) * compliance_;
    for (int c = 0; c < contacts_.count; ++c) {
      const SlidingContact& contact = contacts_.contact[idx(c)];
      ProblemContact& out = problem.contact[idx(c)];
      const PointJacobian J = point_jacobian(tick_.pose, contact.k, contact.p_W);
      for (std::size_t i = 0; i < free.size(); ++i) {
        out.row[kNormalRow][i] = contact.normal.dot(J.linear[i]);
        out.row[kTangentRow][i] = contact.tangent[0].dot(J.linear[i]);
        out.row[kSecondTangentRow][i] = contact.tangent[1].dot(J.linear[i]);
        out.row[kSpinRow][i] = contact.normal.dot(J.angular[i]);
      }
      out.room = std::max(0.0, contact.gap - h1);
      out.segment = contact.k;
      out.tangent = contact.tangent;
      out.spin_anchor = kAnchorGain * contact.turned;
      out.friction = contact.friction;
      out.spin_radius = model_.parameters.spin_radius;
      const Vec3 apart = contact.p_W - goal_pose_.segment[idx(contact.k)] * contact.p_S;
      const double depth = std::max(0.0, apart.dot(contact.normal));
      out.most_friction_normal = 2.0 * (depth + kFrictionDepth) / factor;
      const double all = load[idx(contact.k)];
      const double share = all > 0.0 ? std::max(kLeastLoadShare, contact.multiplier[0] / all) : 1.0;
      out.tangent_compliance = kOwnCompliance * compliance_ / share;
      out.multiplier = contact.multiplier;
    }
  }

  /// Returns DigitContacts::depth_per_multiplier. A digit that begins to press has none; it will be about the mean
  /// product of the contacts' normal rows [m^2].
  [[nodiscard]] double depth_per_multiplier() const noexcept {
    double factor = contacts_.depth_per_multiplier;
    if (!(factor > 0.0)) {
      for (int c = 0; c < contacts_.count; ++c)
        for (const double arm : normal_row(contacts_.contact[idx(c)])) factor += arm * arm / contacts_.count;
    }
    return std::max(factor, kLeastFactor);
  }

  /// Returns the sum of the normal multipliers of each segment's contacts [1/m].
  [[nodiscard]] std::array<double, kSegmentsPerDigit> segment_load() const noexcept {
    std::array<double, kSegmentsPerDigit> load{};
    for (int c = 0; c < contacts_.count; ++c)
      load[idx(contacts_.contact[idx(c)].k)] += contacts_.contact[idx(c)].multiplier[0];
    return load;
  }

  void set_limits(ContactProblem& problem) const noexcept {
    for (std::size_t i = 0; i < lowest_.size(); ++i) {
      problem.lowest[i] = std::min(0.0, lowest_[i] - tick_.angle[i]);
      problem.highest[i] = std::max(0.0, highest_[i] - tick_.angle[i]);
    }
  }

  /// Moves the digit away from what is nearer than the working clearance, at most by `most` [m]. Where that is
  /// not possible, as between two walls, it moves less. The motion carries no force. Springs of contacts that hold
  /// move along, or a finger that rests would creep by a little in every substep.
  void recover(double most) noexcept {
    const double h1 = working_clearance();
    ContactProblem problem;
    problem.count = contacts_.count;
    set_limits(problem);
    bool any = false;
    for (int c = 0; c < contacts_.count; ++c) {
      const SlidingContact& contact = contacts_.contact[idx(c)];
      ProblemContact& out = problem.contact[idx(c)];
      out.row[kNormalRow] = normal_row(contact);
      out.room = std::max(-most, contact.gap - h1);
      out.softness = kSoftness;
      any = any || out.room < -kLeastRecovery;
    }
    if (!any) return;
    (void)solve_contacts(problem, kRecoverySweeps, kLeastRecovery);
    const DigitAngles& away = problem.displacement;
    std::array<bool, kSegmentsPerDigit> known{};
    for (int k = 0; k < kSegmentsPerDigit; ++k) known[idx(k)] = near(k).is_at(tick_.pose.segment[idx(k)]);
    (void)move(away);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      if (!known[idx(k)]) continue;
      near(k).carry(tick_.pose.segment[idx(k)], segment_speed(model_.hand, tick_.digit, away, k) + kRounding);
    }
    gathered_ = true;
    const std::array<double, kSegmentsPerDigit> load = segment_load();
    std::array<double, kSegmentsPerDigit> opened{};  // greatest way off the surface
    std::array<Vec3, DigitContacts::kMost> along;    // and of each contact along it
    for (int c = 0; c < contacts_.count; ++c) {
      SlidingContact& contact = contacts_.contact[idx(c)];
      const Vec3 way = tick_.pose.segment[idx(contact.k)] * contact.p_S - contact.p_W;
      const double off = contact.normal.dot(way);
      contact.p_W += way;
      contact.gap += off;
      opened[idx(contact.k)] = std::max(opened[idx(contact.k)], std::abs(off));
      along[idx(c)] = along_surface(way, contact.normal);
    }
    for (int c = 0; c < contacts_.count; ++c) {
      const SlidingContact& contact = contacts_.contact[idx(c)];
      if (!holds(contact)) continue;
      // Out of a wedge the way along the surface is long; its spring would pull the finger back in.
      const double longest = kRecoveryAlong * opened[idx(contact.k)];
      const double length = along[idx(c)].norm();
      const double share = contact.multiplier[0] / load[idx(contact.k)];
      contacts_.elongation[idx(contact.k)] +=
          share * (length > longest ? longest / length : 1.0) * along[idx(c)];
    }
  }

  [[nodiscard]] static bool holds(const SlidingContact& contact) noexcept {
    return contact.multiplier[0] > 0.0 && !contact.slips;
  }

  /// Moves the digit along a straight line in joint space up to the first stop.
  Stop move(const DigitAngles& x) noexcept {
    Path path{tick_.angle, x, tick_.angle};
    bool still = true;
    bool free = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
      path.end[i] = x[i] == goal_[i] - tick_.angle[i]
                        ? goal_[i]
                        : std::clamp(tick_.angle[i] + x[i], lowest_[i], highest_[i]);
      path.rate[i] = path.end[i] - tick_.angle[i];
      still = still && std::abs(path.rate[i]) <= kStill;
      free = free && path.end[i] == goal_[i];
    }
    if (still && (!free || tick_.angle == goal_)) return {};
    path.near_known = gathered_;
    gathered_ = false;
    return first_contact(model_, path, 0.0, evaluations_, tick_, state_);
  }

  /// Moves the springs with the digit: to where the solution has them, by the share of it that was done. Contacts that
  /// hold say instead, by their share of the load, what has really moved; else its difference would add up.
  void follow_springs(const DigitAngles& from) noexcept {
    double done = 0.0;
    double wanted = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      done += solved_[i] * (tick_.angle[i] - from[i]);
      wanted += solved_[i] * solved_[i];
    }
    const double share = wanted > kStill * kStill ? std::clamp(done / wanted, 0.0, 1.0) : 1.0;
    const std::array<double, kSegmentsPerDigit> load = segment_load();
    auto solution = contacts_.elongation;
    for (Vec3& e : solution) e *= 1.0 - share;
    for (int c = 0; c < contacts_.count; ++c) {
      const SlidingContact& contact = contacts_.contact[idx(c)];
      solution[idx(contact.k)] -= share * compliance_ * contact.tangential_multiplier();
    }
    auto next = solution;
    for (int c = 0; c < contacts_.count; ++c) {
      SlidingContact& contact = contacts_.contact[idx(c)];
      follow_spin(contact, from);
      if (!holds(contact)) continue;
      const Vec3 moved = tick_.pose.segment[idx(contact.k)] * contact.p_S - contact.p_W;
      const Vec3 difference = contacts_.elongation[idx(contact.k)] + moved - solution[idx(contact.k)];
      next[idx(contact.k)] +=
          contact.multiplier[0] / load[idx(contact.k)] * along_surface(difference, contact.normal);
    }
    contacts_.elongation = next;
  }

  /// Adds the digit's motion to the rotation about the normal that spin has held.
  void follow_spin(SlidingContact& contact, const DigitAngles& from) const noexcept {
    if (contact.spins || !(contact.multiplier[0] > 0.0)) {
      contact.turned = 0.0;
      return;
    }
    const PointJacobian J = point_jacobian(tick_.pose, contact.k, contact.p_W);
    for (std::size_t i = 0; i < from.size(); ++i)
      contact.turned += contact.normal.dot(J.angular[i]) * (tick_.angle[i] - from[i]);
  }

  const ContactModel& model_;
  const DigitAngles& goal_;
  const DigitPose& goal_pose_;
  DigitTick& tick_;
  GdpState& state_;
  DigitContacts& contacts_;
  int& evaluations_;
  DigitAngles lowest_{};
  DigitAngles highest_{};
  DigitAngles solved_{};     ///< displacement that the contact problem gave [rad]
  double compliance_ = 0.0;  ///< of the friction of a segment in that problem [m^2]
  bool gathered_ = false;    ///< the near pairs are those of the digit's pose
  /// Pair that has stopped a motion in this substep.
  struct Block {
    int k = 0;
    int slot = -1;
    Vec3 p_S = Vec3::Zero();
    Vec3 on_object = Vec3::Zero();
    Vec3 direction = Vec3::Zero();
  };
  int blocks_ = 0;
  std::array<Block, kMostEvents> block_;
};

/// Forgets the springs of segments that do not press: of a motion that was cut short, a part of them is left.
void release_springs(DigitContacts& contacts) noexcept {
  std::array<bool, kSegmentsPerDigit> presses{};
  for (int c = 0; c < contacts.count; ++c)
    if (contacts.contact[idx(c)].multiplier[0] > 0.0) presses[idx(contacts.contact[idx(c)].k)] = true;
  for (std::size_t k = 0; k < presses.size(); ++k)
    if (!presses[k]) contacts.elongation[k].setZero();
}

/// Sets the depths of the contacts from their multipliers, and the digit's factor between them.
void set_depths(const ContactModel& model, const DigitTick& tick, const DigitAngles& goal,
                DigitContacts& contacts) noexcept {
  DigitAngles middle{};
  for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = 0.5 * (tick.angle[i] + goal[i]);
  DigitPose pose;
  model.hand.digit_pose(tick.digit, middle, pose);
  double sum = 0.0;
  double weighted = 0.0;
  for (int c = 0; c < contacts.count; ++c) {
    const SlidingContact& contact = contacts.contact[idx(c)];
    const double p = contact.multiplier[0];
    if (!(p > 0.0)) continue;
    const PointJacobian J = point_jacobian(tick.pose, contact.k, contact.p_W);
    const PointJacobian half = point_jacobian(pose, contact.k, pose.segment[idx(contact.k)] * contact.p_S);
    double squared = 0.0;
    double A = 0.0;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      const double g = contact.normal.dot(J.linear[i]);
      squared += g * g;
      A += g * contact.normal.dot(half.linear[i]);
    }
    sum += p * p;
    weighted += p * p / std::max(A, 0.1 * squared);
  }
  double& factor = contacts.depth_per_multiplier;
  if (sum > 0.0) {
    const double wanted = sum / weighted;
    factor = factor > 0.0 ? std::min(wanted, factor * (1.0 + kDepthRise)) : wanted;
  } else {
    factor = 0.0;
  }
  const double share = factor * contacts.force_share();
  for (int c = 0; c < contacts.count; ++c) {
    SlidingContact& contact = contacts.contact[idx(c)];
    for (std::size_t r = 0; r < contact.depth.size(); ++r) contact.depth[r] = share * contact.multiplier[r];
    contact.spin_depth = share * contact.multiplier[3];
  }
}

/// Makes one record of the contacts of segment k: their resultant at their centre of pressure, and their moment about
/// it per force. The moment counts with the farthest contact's arm and the spin radius at most: where contacts of
/// one segment oppose each other, their resultant vanishes and their moment does not.
void set_record(const ContactModel& model, const DigitTick& tick, int k, const DigitContacts& contacts,
                ContactRecord& record) noexcept {
  record = {};
  Vec3 force = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  Vec3 centre = Vec3::Zero();
  double weight = 0.0;
  const auto for_each = [&](auto&& use) {
    for (int c = 0; c < contacts.count; ++c) {
      const SlidingContact& contact = contacts.contact[idx(c)];
      if (contact.k == k && contact.presses()) use(contact, contact.resultant());
    }
  };
  for_each([&](const SlidingContact& contact, const Vec3& f) {
    force += f;
    normal += contact.depth[0] * contact.force_normal;
    centre += contact.depth[0] * contact.p_S;
    weight += contact.depth[0];
  });
  const double depth = force.norm();
  const double pressing = normal.norm();
  if (!(weight > 0.0) || !(depth > 0.0) || !(pressing > 0.0)) return;
  record.active = true;
  record.p_S = centre / weight;
  record.n_c = normal / pressing;
  record.force_normal = force / depth;
  record.penetration = record.depth = depth;
  record.p_gdp = tick.pose.segment[idx(k)] * record.p_S;
  record.p_hcp = tick.hcp_pose.segment[idx(k)] * record.p_S;
  Vec3 moment = Vec3::Zero();
  double longest = 0.0;
  double friction = 0.0;
  for_each([&](const SlidingContact& contact, const Vec3& f) {
    const Vec3 arm = tick.pose.segment[idx(k)] * contact.p_S - record.p_gdp;
    moment += arm.cross(f) + contact.spin_depth * contact.force_normal;
    longest = std::max(longest, arm.norm());
    friction = std::max(friction, contact.friction);
  });
  const double most = longest + friction * model.parameters.spin_radius;
  const double length = moment.norm() / depth;
  record.couple = (length > most ? most / length : 1.0) / depth * moment;
}

}  // namespace

void advance_sliding(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  DigitContacts& contacts = state.sliding[idx(tick.digit)];
  contacts.residual = 0.0;
  if (goes_round(model, tick, state)) {
    for (int k = 0; k < kSegmentsPerDigit; ++k) record_of(state, tick, k) = {};
    return;
  }
  const int substeps =
      contacts.count > 0
          ? static_cast<int>(std::clamp(std::ceil(model.period / kLongestSubstep - 1e-9), 1.0, kMostSubsteps))
          : 1;
  int evaluations = 0;
  for (int n = 1; n <= substeps; ++n) {
    DigitAngles goal = tick.hcp;
    DigitPose goal_pose = tick.hcp_pose;
    if (n < substeps) {
      const double s = static_cast<double>(n) / substeps;
      for (std::size_t i = 0; i < goal.size(); ++i)
        goal[i] = tick.hcp_from[i] + s * (tick.hcp[i] - tick.hcp_from[i]);
      model.hand.digit_pose(tick.digit, goal, goal_pose);
    }
    Substep(model, goal, goal_pose, tick, state, evaluations).run();
    release_springs(contacts);
    set_depths(model, tick, goal, contacts);
  }
  for (int k = 0; k < kSegmentsPerDigit; ++k) set_record(model, tick, k, contacts, record_of(state, tick, k));
}

}  // namespace phalanx
