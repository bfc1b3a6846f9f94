// SPDX-License-Identifier: Apache-2.0
#include "phalanx/device/link/transport.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/serial.h>
#include <sys/fsuid.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "device/descriptor.h"
#include "phalanx/device/link/phalanx_link.h"
#include "support/count_allocations.h"

namespace phalanx {
namespace {

/// Stands in for the system calls that a test cannot bring about otherwise, as long as it lives.
struct FakeSystem {
  FakeSystem();
  ~FakeSystem();
  FakeSystem(const FakeSystem&) = delete;
  FakeSystem& operator=(const FakeSystem&) = delete;

  serial_struct driver{};        ///< what TIOCGSERIAL reads and TIOCSSERIAL writes
  bool empty_datagrams = false;  ///< each receiving call gets one
};
FakeSystem* fake_system = nullptr;  ///< null: calls go to the kernel

FakeSystem::FakeSystem() { fake_system = this; }
FakeSystem::~FakeSystem() { fake_system = nullptr; }

}  // namespace
}  // namespace phalanx

// With --wrap the linker resolves ioctl() and recvmsg() to these functions.
extern "C" int __real_ioctl(int descriptor, unsigned long request, void* argument);
extern "C" int __wrap_ioctl(int descriptor, unsigned long request, void* argument);
extern "C" int __wrap_ioctl(int descriptor, unsigned long request, void* argument) {
  if (phalanx::fake_system == nullptr || (request != TIOCGSERIAL && request != TIOCSSERIAL))
    return __real_ioctl(descriptor, request, argument);
  auto* const settings = static_cast<serial_struct*>(argument);
  if (request == TIOCGSERIAL) {
    *settings = phalanx::fake_system->driver;
  } else {
    phalanx::fake_system->driver = *settings;
  }
  return 0;
}
extern "C" ssize_t __real_recvmsg(int descriptor, msghdr* message, int flags);
extern "C" ssize_t __wrap_recvmsg(int descriptor, msghdr* message, int flags);
extern "C" ssize_t __wrap_recvmsg(int descriptor, msghdr* message, int flags) {
  if (phalanx::fake_system == nullptr || !phalanx::fake_system->empty_datagrams)
    return __real_recvmsg(descriptor, message, flags);
  return 0;
}

namespace phalanx {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::HasSubstr;

// Far beyond what a busy machine needs; reached only where a frame does not come at all.
constexpr double kTransportPatience = 60.0;

struct Received {
  Bytes frame;
  Peer from = 99;  ///< what the transport has to replace
};

std::optional<Received> next(Transport& transport, double patience = kTransportPatience) {
  Received received;
  std::array<std::uint8_t, PHX_FRAME_MAX> buffer{};
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::size_t size = transport.receive(buffer, received.from);
    if (size > 0) {
      received.frame.assign(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
      return received;
    }
    if (!transport.wait(patience / 100)) continue;
  }
  return std::nullopt;
}

// A frame in form only: transports do not look inside.
Bytes frame_of(std::uint8_t first, std::size_t size = 40) {
  Bytes frame(size, 0);
  for (std::size_t i = 0; i < size; ++i) frame[i] = static_cast<std::uint8_t>(first + i);
  return frame;
}

std::string after_scheme(const Transport& transport) {
  const std::string address = transport.address();
  return address.substr(address.find(':') + 1);
}

std::string message_of(const std::function<void()>& opening) {
  try {
    opening();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "opened";
}

// ---- UDP ----

TEST(UdpTransport, CarriesFramesBothWaysAndTellsItsPeersApart) {
  const auto server = listen_udp("127.0.0.1:0");
  const auto first = connect_udp(after_scheme(*server));
  const auto second = connect_udp(after_scheme(*server));
  ASSERT_TRUE(first->send(frame_of(1), 0));
  const auto from_first = next(*server);
  ASSERT_TRUE(second->send(frame_of(2), 0));
  const auto from_second = next(*server);
  ASSERT_TRUE(from_first && from_second);
  EXPECT_EQ(from_first->frame, frame_of(1));
  EXPECT_EQ(from_second->frame, frame_of(2));
  EXPECT_NE(from_first->from, from_second->from);
  ASSERT_TRUE(server->send(frame_of(3), from_second->from));
  const auto answer = next(*second);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->frame, frame_of(3));
  EXPECT_EQ(answer->from, 0u);
  EXPECT_FALSE(next(*first, 0.05));
}

// A controller that is not up answers "connection refused", which must not end anything.
TEST(UdpTransport, SurvivesAControllerThatIsNotUpYetAndOneThatComesBack) {
  std::string address;
  {
    const auto reserved = listen_udp("127.0.0.1:0");
    address = after_scheme(*reserved);
  }
  const auto host = connect_udp(address);
  std::array<std::uint8_t, PHX_FRAME_MAX> buffer{};
  Peer from = 0;
  for (int start = 0; start < 2; ++start) {
    for (int i = 0; i < 5; ++i) {
      host->send(frame_of(9), 0);
      host->wait(0.01);
      EXPECT_EQ(host->receive(buffer, from), 0u);
      EXPECT_FALSE(host->lost());
    }
    const auto controller = listen_udp(address);
    ASSERT_TRUE(host->send(frame_of(5), 0));
    const auto heard = next(*controller);
    ASSERT_TRUE(heard);
    EXPECT_EQ(heard->frame, frame_of(5));
  }
}

TEST(UdpTransport, DropsAndCountsWhatIsLargerThanAFrameAndWhatIsEmpty) {
  const auto server = listen_udp("127.0.0.1:0");
  const auto host = connect_udp(after_scheme(*server));
  ASSERT_TRUE(host->send(frame_of(1, PHX_FRAME_MAX), 0));
  ASSERT_TRUE(host->send(frame_of(2, PHX_FRAME_MAX + 1), 0));
  ASSERT_TRUE(host->send(frame_of(3, 9000), 0));
  ASSERT_TRUE(host->send({}, 0));
  ASSERT_TRUE(host->send(frame_of(4), 0));
  const auto largest = next(*server);
  const auto last = next(*server);
  ASSERT_TRUE(largest && last);
  EXPECT_EQ(largest->frame, frame_of(1, PHX_FRAME_MAX));
  EXPECT_EQ(last->frame, frame_of(4));
  EXPECT_EQ(server->dropped(), 3u);
}

// Datagrams without a frame come without end: one call drops 64 of them and returns.
TEST(UdpTransport, DropsAtMostSixtyFourDatagramsACall) {
  const auto server = listen_udp("127.0.0.1:0");
  std::array<std::uint8_t, PHX_FRAME_MAX> buffer{};
  Peer from = 0;
  FakeSystem system;
  system.empty_datagrams = true;
  EXPECT_EQ(server->receive(buffer, from), 0u);
  EXPECT_EQ(server->dropped(), 64u);
  EXPECT_EQ(server->receive(buffer, from), 0u);
  EXPECT_EQ(server->dropped(), 128u);
}

TEST(UdpTransport, SaysWhatIsWrongWithAnAddress) {
  const auto server = listen_udp("127.0.0.1:0");
  const std::string taken = after_scheme(*server);
  EXPECT_THAT(message_of([&] { (void)listen_udp(taken); }), HasSubstr("end the other program"));
  EXPECT_THAT(message_of([] { (void)listen_udp("192.0.2.1:47800"); }), HasSubstr("address of this computer"));
  for (const char* address :
       {"127.0.0.1", "127.0.0.1:", ":47800", "127.0.0.1:0", "127.0.0.1:65536", "127.0.0.1:1x", ""})
    EXPECT_THAT([&] { (void)connect_udp(address); },
                ::testing::ThrowsMessage<std::invalid_argument>(HasSubstr("expected HOST:PORT")))
        << address;
  EXPECT_THAT(message_of([] { (void)connect_udp("no-such-host.invalid:47800"); }), HasSubstr("no host"));
}

// ---- serial ----

TEST(SerialTransport, CarriesFramesBothWaysOverAPseudoTerminal) {
  const auto controller = open_pseudo_terminal();
  const auto host = open_serial(after_scheme(*controller));
  for (std::uint8_t i = 0; i < 20; ++i) {
    ASSERT_TRUE(host->send(frame_of(i, 20u + 40u * i), 0));
    const auto heard = next(*controller);
    ASSERT_TRUE(heard);
    EXPECT_EQ(heard->frame, frame_of(i, 20u + 40u * i));
    EXPECT_EQ(heard->from, 0U);
    ASSERT_TRUE(controller->send(heard->frame, heard->from));
    const auto echo = next(*host);
    ASSERT_TRUE(echo);
    EXPECT_EQ(echo->frame, heard->frame);
    EXPECT_EQ(echo->from, 0U);
  }
  EXPECT_EQ(host->dropped() + controller->dropped(), 0u);
}

// What one read brought and receive() has not handed out yet is there without any further byte on the line.
TEST(SerialTransport, DoesNotWaitWhileItHoldsAFrame) {
  const auto controller = open_pseudo_terminal();
  const auto host = open_serial(after_scheme(*controller));
  for (int i = 0; i < 20; ++i) {  // the terminal may hand over the two one by one; seldom each time
    ASSERT_TRUE(host->send(frame_of(1), 0));
    ASSERT_TRUE(host->send(frame_of(2), 0));
    ASSERT_TRUE(next(*controller));
    ASSERT_TRUE(controller->wait(kTransportPatience));
    const auto second = next(*controller);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->frame, frame_of(2));
  }
}

TEST(SerialTransport, HostsComeAndGoAtAPseudoTerminal) {
  const auto controller = open_pseudo_terminal();
  for (std::uint8_t i = 0; i < 3; ++i) {
    const auto host = open_serial(after_scheme(*controller));
    ASSERT_TRUE(host->send(frame_of(i), 0));
    const auto heard = next(*controller);
    ASSERT_TRUE(heard);
    EXPECT_EQ(heard->frame, frame_of(i));
    EXPECT_FALSE(controller->lost());
  }
}

TEST(SerialTransport, FindsTheNextFrameAfterNoise) {
  const auto controller = open_pseudo_terminal();
  const auto host = open_serial(after_scheme(*controller));
  const int line = ::open(after_scheme(*controller).c_str(), O_RDWR | O_NOCTTY);
  ASSERT_GE(line, 0);
  Bytes noise(3000, 0x55);  // no frame is as long
  ASSERT_EQ(::write(line, noise.data(), noise.size()), static_cast<ssize_t>(noise.size()));
  ::close(line);
  ASSERT_TRUE(host->send(frame_of(1), 0));  // ends the noise, or is lost with it
  ASSERT_TRUE(host->send(frame_of(2), 0));
  const auto heard = next(*controller);
  ASSERT_TRUE(heard);
  EXPECT_THAT(heard->frame, testing::AnyOf(frame_of(1), frame_of(2)));
  EXPECT_GE(controller->dropped(), 1u);
}

// What another program has half sent ends at the zero byte that a host begins with, so that its first frame
// is read.
TEST(SerialTransport, AHostsFirstFrameIsReadAfterHalfAFrameOfAnother) {
  const auto controller = open_pseudo_terminal();
  const int line = ::open(after_scheme(*controller).c_str(), O_RDWR | O_NOCTTY);
  ASSERT_GE(line, 0);
  const Bytes half = {20, 1, 2, 3};  // 16 bytes of the block are to come
  ASSERT_EQ(::write(line, half.data(), half.size()), static_cast<ssize_t>(half.size()));
  ::close(line);
  std::array<std::uint8_t, PHX_FRAME_MAX> buffer{};
  Peer from = 0;
  ASSERT_TRUE(controller->wait(kTransportPatience));
  ASSERT_EQ(controller->receive(buffer, from), 0u);
  const auto host = open_serial(after_scheme(*controller));
  ASSERT_TRUE(host->send(frame_of(7), 0));
  const auto heard = next(*controller);
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->frame, frame_of(7));
  EXPECT_EQ(controller->dropped(), 1u) << "the half one";
}

// A frame of 40 bytes fits into 40; into 39 it does not, and is dropped and counted.
TEST(SerialTransport, AFrameMayBeAsLargeAsTheRoomForItAndNotLarger) {
  const auto controller = open_pseudo_terminal();
  const auto host = open_serial(after_scheme(*controller));
  ASSERT_TRUE(host->send(frame_of(1), 0));
  ASSERT_TRUE(host->send(frame_of(2), 0));
  std::array<std::uint8_t, 40> room{};
  Peer from = 0;
  const auto take = [&](std::span<std::uint8_t> into, const std::function<bool()>& there) {
    for (int i = 0; i < 1000 && !there(); ++i) {
      if (const std::size_t size = controller->receive(into, from); size > 0) return size;
      controller->wait(kTransportPatience / 1000);
    }
    return std::size_t{0};
  };
  EXPECT_EQ(take(room, [] { return false; }), 40u);
  EXPECT_EQ(take(std::span(room).first(39), [&] { return controller->dropped() > 0; }), 0u);
  EXPECT_EQ(controller->dropped(), 1u);
}

// Nobody reads: what the line cannot hold is dropped by whole frames, whatever the system took of one.
TEST(SerialTransport, AFullLineDropsFramesWhole) {
  const auto controller = open_pseudo_terminal();
  const auto host = open_serial(after_scheme(*controller));
  std::vector<Bytes> queued;
  int dropped = 0;
  for (std::uint32_t i = 0; dropped < 100 && i < 100000; ++i) {
    Bytes frame = frame_of(static_cast<std::uint8_t>(i), 200 + i % 700);
    if (host->send(frame, 0)) {
      queued.push_back(std::move(frame));
    } else {
      ++dropped;
    }
  }
  ASSERT_EQ(dropped, 100);
  std::size_t count = 0;
  for (; count < queued.size(); ++count) {
    host->wait(0.0);  // lets it pass on what it still holds
    const auto heard = next(*controller);
    ASSERT_TRUE(heard) << count << " of " << queued.size();
    ASSERT_EQ(heard->frame, queued[count]) << count;
  }
  EXPECT_EQ(controller->dropped(), 0u);
}

TEST(SerialTransport, IsLostWhenItsOtherEndGoes) {
  auto controller = open_pseudo_terminal();
  const auto host = open_serial(after_scheme(*controller));
  controller.reset();
  std::array<std::uint8_t, PHX_FRAME_MAX> buffer{};
  Peer from = 0;
  EXPECT_EQ(host->receive(buffer, from), 0u);
  EXPECT_TRUE(host->lost());
  EXPECT_FALSE(host->send(frame_of(1), 0));
  EXPECT_FALSE(host->wait(0.001));
}

TEST(SerialTransport, IsLostWhenWhatIsSentHasNowhereToGo) {
  auto controller = open_pseudo_terminal();
  const auto host = open_serial(after_scheme(*controller));
  controller.reset();
  EXPECT_FALSE(host->send(frame_of(1), 0));
  EXPECT_TRUE(host->lost());
}

// Another program may have left the port with two stop bits and flow control, which a pseudo-terminal keeps,
// too. (It has neither parity nor seven bits.)
TEST(SerialTransport, SetsOneStopBitAndNoFlowControlWhateverThePortHadBefore) {
  const auto controller = open_pseudo_terminal();
  const Descriptor line(::open(after_scheme(*controller).c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  termios settings{};
  ASSERT_EQ(::tcgetattr(line.value(), &settings), 0);
  settings.c_cflag |= CSTOPB | CRTSCTS;
  settings.c_iflag |= IXON | IXOFF;
  ASSERT_EQ(::tcsetattr(line.value(), TCSANOW, &settings), 0);
  ASSERT_EQ(::tcgetattr(line.value(), &settings), 0);
  ASSERT_EQ(settings.c_cflag & (CSTOPB | CRTSCTS), CSTOPB | CRTSCTS) << "the terminal took them";
  ASSERT_EQ(settings.c_iflag & (IXON | IXOFF), static_cast<tcflag_t>(IXON | IXOFF));

  const auto host = open_serial(after_scheme(*controller));
  ASSERT_EQ(::tcgetattr(line.value(), &settings), 0);
  EXPECT_EQ(settings.c_cflag & (CSTOPB | CRTSCTS), 0U);
  EXPECT_EQ(settings.c_iflag & (IXON | IXOFF), 0U);
}

TEST(SerialTransport, AsksTheDriverForLowLatencyAndLeavesItsOtherSettings) {
  const auto controller = open_pseudo_terminal();
  FakeSystem system;
  system.driver.flags = ASYNC_SKIP_TEST;
  system.driver.closing_wait = 77;
  const auto host = open_serial(after_scheme(*controller));
  EXPECT_EQ(system.driver.flags, static_cast<int>(ASYNC_SKIP_TEST | ASYNC_LOW_LATENCY));
  EXPECT_EQ(system.driver.closing_wait, 77);
}

TEST(SerialTransport, BelongsToOneProgramAtATime) {
  const auto controller = open_pseudo_terminal();
  auto host = open_serial(after_scheme(*controller));
  const auto again = [&] { (void)open_serial(after_scheme(*controller)); };
  EXPECT_THAT(message_of(again), HasSubstr("in use by another program"));
  host.reset();
  EXPECT_EQ(message_of(again), "opened");
}

TEST(SerialTransport, SaysWhatIsWrongWithAPort) {
  EXPECT_THAT(message_of([] { (void)open_serial("/dev/ttyNotThere"); }), HasSubstr("/dev/serial/by-id"));
  const std::string file = testing::TempDir() + "not_a_port_" + std::to_string(::getpid());
  std::ofstream(file) << "x";
  EXPECT_THAT(message_of([&] { (void)open_serial(file); }), HasSubstr("is it a serial port?"));
  std::filesystem::remove(file);
  const auto controller = open_pseudo_terminal();
  EXPECT_THAT(message_of([&] { (void)open_serial(after_scheme(*controller), 12345); }),
              HasSubstr("12345 baud"));
}

// Ports belong to a group. Root may open them all, unless its thread gives that up for a moment.
TEST(SerialTransport, SaysWhichGroupAPortBelongsTo) {
  const std::string file = testing::TempDir() + "not_my_port_" + std::to_string(::getpid());
  std::ofstream(file) << "x";
  std::filesystem::permissions(file, std::filesystem::perms::none);
  const int self = ::setfsuid(65534);
  const Descriptor plain(::open(file.c_str(), O_RDWR | O_CLOEXEC));
  const bool refused = plain.value() < 0 && errno == EACCES;
  const std::string said = message_of([&] { (void)open_serial(file); });
  ::setfsuid(static_cast<uid_t>(self));
  ::prctl(PR_SET_DUMPABLE, 1);  // setfsuid() clears it, and the leak checker needs it
  std::filesystem::remove(file);
  if (!refused) GTEST_SKIP() << "whoever runs this may open everything";
  EXPECT_THAT(said, HasSubstr("group dialout"));
}

TEST(Transports, WaitSaysWhetherThereIsSomething) {
  const auto server = listen_udp("127.0.0.1:0");
  const auto client = connect_udp(after_scheme(*server));
  const auto terminal = open_pseudo_terminal();
  const auto port = open_serial(after_scheme(*terminal));
  EXPECT_FALSE(server->wait(0.001));
  EXPECT_FALSE(terminal->wait(0.001));
  ASSERT_TRUE(client->send(frame_of(1), 0));
  ASSERT_TRUE(port->send(frame_of(1), 0));
  EXPECT_TRUE(server->wait(kTransportPatience));
  EXPECT_TRUE(terminal->wait(kTransportPatience));
}

TEST(Transports, AllocateNothingOnceOpen) {
  const auto server = listen_udp("127.0.0.1:0");
  const auto client = connect_udp(after_scheme(*server));
  const auto terminal = open_pseudo_terminal();
  const auto port = open_serial(after_scheme(*terminal));
  const Bytes frame = frame_of(7);
  std::array<std::uint8_t, PHX_FRAME_MAX> buffer{};
  Peer from = 0;
  std::size_t received = 0;
  const std::size_t before = test::allocations_of_this_thread();
  for (int i = 0; i < 100; ++i) {
    client->send(frame, 0);
    port->send(frame, 0);
    server->wait(0.1);
    terminal->wait(0.1);
    received += server->receive(buffer, from);
    server->send(frame, from);
    received += terminal->receive(buffer, from);
    client->wait(0.1);
    received += client->receive(buffer, from);
  }
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_GT(received, 0u);
}

}  // namespace
}  // namespace phalanx
