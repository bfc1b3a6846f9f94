// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/open_device.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

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

TEST(OpenDevice, APortThatIsNotThereIsNamed) {
  EXPECT_NE(refusal("serial:/dev/phalanx-has-no-such-port").find("/dev/phalanx-has-no-such-port"),
            std::string::npos);
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
