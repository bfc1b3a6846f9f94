// SPDX-License-Identifier: Apache-2.0
#include "replay.h"

extern "C" {
int fuzz_device(const std::uint8_t* data, std::size_t size);
int fuzz_encrypted_recording(const std::uint8_t* data, std::size_t size);
int fuzz_exercise(const std::uint8_t* data, std::size_t size);
int fuzz_link(const std::uint8_t* data, std::size_t size);
int fuzz_mesh(const std::uint8_t* data, std::size_t size);
int fuzz_motion(const std::uint8_t* data, std::size_t size);
int fuzz_opengloves(const std::uint8_t* data, std::size_t size);
int fuzz_recording(const std::uint8_t* data, std::size_t size);
int fuzz_scene(const std::uint8_t* data, std::size_t size);
}

namespace phalanx {
namespace {

TEST(FuzzReplay, DeviceFiles) { test::replay("fuzz_device", fuzz_device); }
TEST(FuzzReplay, ExerciseFiles) { test::replay("fuzz_exercise", fuzz_exercise); }
TEST(FuzzReplay, LinkFrames) { test::replay("fuzz_link", fuzz_link); }
TEST(FuzzReplay, MeshFiles) { test::replay("fuzz_mesh", fuzz_mesh); }
TEST(FuzzReplay, MotionFiles) { test::replay("fuzz_motion", fuzz_motion); }
TEST(FuzzReplay, EncryptedRecordings) { test::replay("fuzz_encrypted_recording", fuzz_encrypted_recording); }
TEST(FuzzReplay, GloveMessages) { test::replay("fuzz_opengloves", fuzz_opengloves); }
TEST(FuzzReplay, Recordings) { test::replay("fuzz_recording", fuzz_recording); }
TEST(FuzzReplay, SceneFiles) { test::replay("fuzz_scene", fuzz_scene); }

}  // namespace
}  // namespace phalanx
