// SPDX-License-Identifier: Apache-2.0
// A glove's serial port by its name: alone, refused, lost and found again.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <utility>

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
  EXPECT_THAT([&] { second->open(); },
              ::testing::ThrowsMessage<DeviceError>(::testing::AllOf(HasSubstr("in use by another program"),
                                                                     HasSubstr("end the other program"))));
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

/// Calls `use` with a port's settings, and sets them to what it leaves.
void with_settings(const std::string& port, const std::function<void(termios&)>& use) {
  const int descriptor = ::open(port.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  EXPECT_EQ(::tcgetattr(descriptor, &settings), 0);
  use(settings);
  EXPECT_EQ(::tcsetattr(descriptor, TCSANOW, &settings), 0);
  ::close(descriptor);
}

// 8 bits, no parity, one stop bit, no handshake, no echo, whatever the port had been left with. The glove is
// silent, so that each opening fails and leaves the port as it was set up.
TEST(OpenGlovesPort, IsSetUpForBytesAtTheRateThatIsAskedFor) {
  constexpr tcflag_t kFraming = CSIZE | CSTOPB | PARENB | CRTSCTS;
  constexpr tcflag_t kEightBits = CS8;
  constexpr tcflag_t kLine = CLOCAL | CREAD;
  constexpr tcflag_t kEditing = ICANON | ECHO | ISIG;
  GloveFirmware firmware("");
  const Clock clock;
  auto settings = quick();
  settings.hello_timeout = 1e-3;
  for (const auto& [baud, speed] : {std::pair<unsigned, speed_t>{9600, B9600},
                                    {19200, B19200},
                                    {38400, B38400},
                                    {57600, B57600},
                                    {115200, B115200},
                                    {230400, B230400},
                                    {460800, B460800},
                                    {921600, B921600},
                                    {1000000, B1000000},
                                    {2000000, B2000000}}) {
    with_settings(firmware.port(), [&](termios& port) {
      port.c_cflag = (port.c_cflag & ~kLine) | CSTOPB | CRTSCTS;
      port.c_lflag |= kEditing;
      ::cfsetspeed(&port, B300);
    });
    EXPECT_THROW(make_opengloves_device(firmware.port(), baud, clock, settings)->open(), DeviceError);
    with_settings(firmware.port(), [&, rate = speed](termios& port) {
      EXPECT_EQ(::cfgetispeed(&port), rate);
      EXPECT_EQ(::cfgetospeed(&port), rate);
      EXPECT_EQ(port.c_cflag & kFraming, kEightBits);
      EXPECT_EQ(port.c_cflag & kLine, kLine);
      EXPECT_EQ(port.c_lflag & kEditing, tcflag_t{0});
    });
  }
}

// The first time the glove sends a splay, the second time two curls only. Each time, the bytes before the
// first line end that the host sees may be the second half of a line.
TEST(OpenGlovesPort, IsLearntAnewEachTimeItIsOpened) {
  GloveFirmware firmware("");
  const Clock clock;
  const auto device = make_opengloves_device(firmware.port(), 115200, clock, quick());
  const auto open_and_hear = [&](const std::string& bytes) {
    std::thread glove([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      firmware.blurt(bytes);
    });
    EXPECT_NO_THROW(device->open());
    glove.join();
  };
  open_and_hear("\nA0B0C0D0E0(AB)0\n");
  EXPECT_EQ(device->info().channels.size(), 6U);
  device->close();
  open_and_hear("47(AB)3000\nA0B0\n");
  EXPECT_EQ(device->info().channels.size(), 2U);
  device->close();
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
