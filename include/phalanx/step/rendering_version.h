// SPDX-License-Identifier: Apache-2.0
// Version of the rendering: of the way from a sample to forces and torques.
// Results of exercises state it, so that a trend does not compare what was measured against different forces.
#pragma once

namespace phalanx {

/// Version of the rendering. Results of exercises state it as the condition `rendering`, and a trend joins only
/// results of one version (docs/patients.md): the same hand must meet the same forces in both. The program's version
/// is another number, and raising it ends no trend.
///
/// Raise it if the same model, parameters and samples give other forces or torques than before. Examples are another
/// contact search, force law or stabiliser, another default of the scenes that exercises use, and other shipped
/// geometry of hands or objects. Do not raise it for more speed, other messages, or features that are off by default.
/// Last bits alone, as another compiler or libm may give them, are no change.
///
/// RenderingVersion in tests/exercise/run/rendering_version_test.cpp has the forces of short trials in the scenes of the
/// shipped exercises. It fails if they change while this number stays.
///
/// | version | since | change |
/// | --- | --- | --- |
/// | 1 | 0.1.0 | the first one |
inline constexpr int kRenderingVersion = 1;

}  // namespace phalanx
