// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/open_device.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace phalanx {
namespace {

std::string refusal(const std::string& spec) {
  const Clock clock;
  try {
    static_cast<void>(open_device(spec, clock));
  } catch (const std::invalid_argument& error) {
    return error.what();
  } catch (const DeviceError& error) {
    return std::string("wire: ") + error.what();
  }
  return "";
}

TEST(OpenDevice, AnAddressThatIsNoneIsAnsweredWithWhatIsPossible) {
  for (const char* spec :
       {"", "udp", "usb:0", "serial:", "udp:", "tcp:127.0.0.1:1", "serial:/dev/null:fast"}) {
    const std::string said = refusal(spec);
    EXPECT_NE(said.find("udp:HOST:PORT"), std::string::npos) << spec << ": " << said;
    EXPECT_NE(said.find("serial:PORT"), std::string::npos) << spec << ": " << said;
  }
}

TEST(OpenDevice, SaysWhichPartOfAnAddressIsWrong) {
  for (const auto& [spec, said] : {std::pair{"udp", "not an address"},
                                   {"tcp:127.0.0.1:1", "no kind of device is called 'tcp'"},
                                   {"serial::9600", "no port"},
                                   {"serial:/dev/null:fast", "'fast' is no baud rate"},
                                   {"serial:/dev/null:12x", "'12x' is no baud rate"},
                                   {"serial:/dev/null:0", "'0' is no baud rate"},
                                   {"opengloves:/dev/null:", "'' is no baud rate"}})
    EXPECT_NE(refusal(spec).find(said), std::string::npos) << spec << ": " << refusal(spec);
}

TEST(OpenDevice, APortThatIsNotThereIsNamed) {
  for (const char* rate : {"", ":9600"})
    EXPECT_EQ(refusal(std::string("serial:/dev/phalanx-has-no-such-port") + rate)
                  .find("wire: serial:/dev/phalanx-has-no-such-port: cannot open"),
              0U);
}

// A serial wire's address ends in its rate, and a glove that does not answer is asked whether it has that
// rate.
TEST(OpenDevice, AWireIsOpenedAtTheRateThatIsTypedOrElseAtTheUsualOne) {
  EXPECT_EQ(open_transport("udp:127.0.0.1:9")->address(), "udp:127.0.0.1:9");
  const auto terminal = open_pseudo_terminal();
  const std::string serial = terminal->address();
  const std::string glove = "opengloves" + serial.substr(serial.find(':'));
  EXPECT_EQ(open_transport(serial)->address(), serial + ":2000000");
  EXPECT_EQ(open_transport(serial + ":9600")->address(), serial + ":9600");
  const Clock clock;
  LinkSettings settings;
  settings.hello_timeout = 0.05;
  for (const auto& [rate, expected] : {std::pair{"", "115200"}, {":9600", "9600"}}) {
    const auto device = open_device(glove + rate, clock, settings);
    try {
      device->open();
      ADD_FAILURE() << "nobody is there";
    } catch (const DeviceError& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("is ") + expected + " its baud rate"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(OpenDevice, AGloveDoesNotSpeakTheLink) {
  EXPECT_THROW(static_cast<void>(open_transport("opengloves:/dev/ttyUSB0")), std::invalid_argument);
}

TEST(OpenDevice, AControllerThatDoesNotAnswerIsSaidSoAndHoldsNobodyUp) {
  const Clock clock;
  LinkSettings settings;
  settings.hello_timeout = 0.2;
  const auto device = open_device("udp:127.0.0.1:9", clock, settings);
  EXPECT_THROW(device->open(), DeviceError);
}

}  // namespace
}  // namespace phalanx
