// SPDX-License-Identifier: Apache-2.0
// Parameters of the contact search. S1 is a paper, listed in docs/architecture.md.
#pragma once

namespace phalanx {

/// Method by which the GDP, the shown hand, is found.
enum class GdpMethod {
  kContinuous,  ///< first time of contact along the path, docs/architecture.md "The GDP, exactly"
  kTrajectory,  ///< S1 fig. 4 to the letter: sampled test, back through the recorded angles
};

/// Behaviour of a contact while it lasts.
enum class ContactMode {
  kStatic,   ///< the contact is a fixed point and holds its joints, as in S1 and S2
  kSliding,  ///< several contact points a segment slide with Coulomb friction, docs/sliding.md
};

/// Origin from which a contact's depth is counted.
enum class DepthOrigin {
  kContinuous,  ///< a contact that begins while a nearer segment pushes starts from zero depth
  kS1,          ///< S1's formula as printed: always from the GDP
};

/// Direction of the force.
enum class ForceNormal {
  kInterpolated,  ///< the object's normal, interpolated over smooth edges, within 30 degrees of n_c
  kContact,       ///< n_c, from the object to the segment at closest approach
};

/// Parameters of the contact search.
struct ContactParameters {
  double margin = 50e-6;        ///< clearance of a stopped segment [m], > 0
  double slid_distance = 5e-3;  ///< tangential offset beyond which a contact reports `slid` [m]
  ContactMode mode = ContactMode::kStatic;
  // Of sliding mode:
  double friction = 0.6;  ///< Coulomb coefficient mu [-]
  /// Stiffness along the surface of friction that holds, over that of the law [-], > 0.
  double tangential_stiffness_ratio = 0.5;
  double spin_radius = 4e-3;  ///< r_c: friction resists rotation about the normal by up to mu r_c f_n [m]
  int max_contacts = 4;       ///< greatest number of contact points of a segment, 1 to 4
  // Of static mode:
  GdpMethod method = GdpMethod::kContinuous;
  DepthOrigin depth = DepthOrigin::kContinuous;
  // Of both:
  ForceNormal normal = ForceNormal::kInterpolated;
};

}  // namespace phalanx
