// SPDX-License-Identifier: Apache-2.0
// A glove's serial port by its name: alone, refused, lost and found again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>
#include <thread>

#include "device/opengloves/glove_firmware.h"
#include "device/opengloves/quick_settings.h"
#include "phalanx/device/opengloves/opengloves_device.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using test::GloveFirmware;
using test::quick;
using ::testing::HasSubstr;

constexpr const char* kOpenHand = "A0B0C0D0E0F2047G2047";

// Polls; false after 10 s.
bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 10000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

TEST(OpenGlovesPort, OpensAPortByNameForItselfAlone) {
  GloveFirmware firmware(kOpenHand);
  Clock clock;
  const auto device = make_opengloves_device(firmware.port(), 115200, clock, quick());
  device->open();
  EXPECT_EQ(device->info().serial, firmware.port()) << "no USB adapter that had a number";
  const auto second = make_opengloves_device(firmware.port(), 115200, clock, quick());
  EXPECT_THROW(second->open(), DeviceError);
  device->close();
  EXPECT_NO_THROW(second->open()) << "free again";
  second->close();
}

TEST(OpenGlovesPort, NamesAPortThatIsNotThereAndABaudRateThatNobodyHas) {
  const Clock clock;
  const auto message = [&](const std::string& port, unsigned baud) -> std::string {
    try {
      make_opengloves_device(port, baud, clock)->open();
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message("/dev/no-such-glove", 115200), HasSubstr("/dev/serial/by-id"));
  EXPECT_THAT(message("/dev/null", 115200), HasSubstr("is it a serial port?"));
  EXPECT_THAT(message("/dev/null", 12345), HasSubstr("12345 baud"));
}

// A name that stays the same while the port behind it changes, as those in /dev/serial/by-id do.
TEST(OpenGlovesPort, IsOpenedAgainAtAResetAndNotBefore) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path name = folder / "glove";
  auto firmware = std::make_unique<GloveFirmware>(kOpenHand);
  std::filesystem::create_symlink(firmware->port(), name);
  Clock clock;
  const auto device = make_opengloves_device(name, 115200, clock, quick());
  device->open();
  firmware->unplug();
  ASSERT_TRUE(eventually([&] { return device->connection_fault() == Fault::kDeviceLost; }));

  std::filesystem::remove(name);
  firmware = std::make_unique<GloveFirmware>(kOpenHand);
  std::filesystem::create_symlink(firmware->port(), name);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(device->connection_fault(), Fault::kDeviceLost) << "nobody has asked for it";
  EXPECT_TRUE(firmware->answers().empty());

  device->reset();
  EXPECT_TRUE(eventually([&] { return device->connection_fault() == Fault::kNone; }));
  EXPECT_TRUE(firmware->wait_for_answers(3));
  std::array<DeviceSample, 64> inbox;
  EXPECT_TRUE(eventually([&] { return device->receive(0.0, inbox) > 0; }));
  device->close();
}

}  // namespace
}  // namespace phalanx
