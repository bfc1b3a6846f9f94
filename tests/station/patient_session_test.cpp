// SPDX-License-Identifier: Apache-2.0
// A device without a watchdog may be tried out, and is refused for a patient's session.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "device/link/controller_thread.h"
#include "device/opengloves/glove_firmware.h"
#include "phalanx/station/station_model.h"
#include "station/session_fixture.h"
#include "station/small_station.h"

namespace phalanx {
namespace {

using test::GloveFirmware;
using test::SessionFixture;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Overrides kProfile = {{"hand.profile", "\"small-woman\""}};
constexpr const char* kOpenHand = "A0B0C0D0E0F2047G2047";

TEST(PatientSession, AProfileOrAClinicianMakesIt) {
  const auto patient = [](const Overrides& overrides, const std::string& clinician) {
    return make_station_model(load_scene("grasp_teapot", overrides), clinician).safety.patient;
  };
  EXPECT_EQ(patient({}, ""), "");
  EXPECT_EQ(patient({{"hand.profile", "\"small-woman\""}}, ""), "hand.profile = small-woman");
  EXPECT_EQ(patient({}, "Dr A"), "--clinician Dr A");
}

TEST(PatientSession, IsRefusedToADeviceOnAWireThatHasNoWatchdog) {
  DeviceInfo glove;
  glove.name = "glove";
  glove.serial = "L-7";
  SafetySettings settings;
  EXPECT_NO_THROW(check_watchdog(settings, glove)) << "it is tried out";
  settings.patient = "hand.profile = small-woman";
  EXPECT_THAT([&] { check_watchdog(settings, glove); },
              ThrowsMessage<std::invalid_argument>(AllOf(
                  HasSubstr("hand.profile = small-woman"), HasSubstr("glove (serial L-7) has no watchdog"),
                  HasSubstr("--watchdog-ms MS"), HasSubstr("docs/device.md"))));
  glove.watchdog = 0.1;
  EXPECT_NO_THROW(check_watchdog(settings, glove));
  glove.watchdog.reset();
  glove.actuated = false;
  EXPECT_NO_THROW(check_watchdog(settings, glove)) << "it holds nothing";
  glove.actuated = true;
  glove.simulated = true;
  EXPECT_NO_THROW(check_watchdog(settings, glove)) << "it ends with the program";
}

/// Says that it is on a wire.
class RealDevice final : public Device {
 public:
  RealDevice() : device_(test::resting_device()), info_(device_->info()) { info_.simulated = false; }
  void open() override { device_->open(); }
  void close() noexcept override { device_->close(); }
  [[nodiscard]] const DeviceInfo& info() const override { return info_; }
  [[nodiscard]] std::size_t receive(double now, std::span<DeviceSample> out) noexcept override {
    return device_->receive(now, out);
  }
  void send(const DeviceCommand& command) noexcept override { device_->send(command); }
  void reset() noexcept override { device_->reset(); }

 private:
  std::unique_ptr<Device> device_;
  DeviceInfo info_;
};

// Hence also with a driver that is not part of Phalanx.
TEST(PatientSession, IsRefusedByTheStationItself) {
  const Clock clock;
  EXPECT_NO_THROW(static_cast<void>(test::small_station(std::make_unique<RealDevice>(), clock)));
  EXPECT_THROW(
      static_cast<void>(test::small_station(std::make_unique<RealDevice>(), clock, "--clinician Dr A")),
      std::invalid_argument);
}

class GloveSession : public SessionFixture {
 protected:
  [[nodiscard]] SessionSettings with_glove(const Overrides& overrides) const {
    SessionSettings settings = with("opengloves:" + firmware.port(), "grasp_teapot");
    settings.overrides = overrides;
    return settings;
  }
  GloveFirmware firmware{kOpenHand};
};

TEST_F(GloveSession, AGloveIsTriedOutButRefusedForAPatient) {
  start(with_glove({}));
  ASSERT_TRUE(until_running());
  EXPECT_FALSE(session->info()->device.watchdog);
  records.clear();
  EXPECT_THAT(set(kProfile), AllOf(HasSubstr("hand.profile = small-woman"), HasSubstr("has no watchdog")));
  pass(0.1);
  for (const StepRecord& step : records)
    ASSERT_EQ(step.state, SafetyState::kRunning) << "the trial goes on undisturbed";
  EXPECT_FALSE(records.empty());
  EXPECT_EQ(value("hand.profile"), "");
  EXPECT_EQ(session->info()->patient, "");
  session.reset();
  EXPECT_THAT([&] { start(with_glove(kProfile)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("has no watchdog")));
}

// What is known of the glove does not depend on the scene: another one keeps it.
TEST_F(GloveSession, AGloveWhoseFirmwareIsKnownToLetGoServesAPatientInEveryScene) {
  SessionSettings settings = with_glove({});
  settings.watchdog = 0.2;
  settings.clinician = "Dr A";
  start(settings);
  EXPECT_EQ(session->info()->patient, "--clinician Dr A");
  EXPECT_EQ(load("grasp_box"), "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(session->info()->device.watchdog, 0.2);
  EXPECT_EQ(session->info()->patient, "--clinician Dr A");
}

// Not even a key of the device file: it would be any page's, and any scene's.
TEST_F(GloveSession, NoKeyOfASceneStatesAWatchdog) {
  EXPECT_THAT([&] { start(with_glove({{"device.controller.watchdog_ms", "200"}})); },
              ThrowsMessage<SceneError>(HasSubstr("watchdog_ms")));
}

TEST_F(GloveSession, AGloveThatOnlySensesServesAPatient) {
  SessionSettings settings = with_glove(kProfile);
  settings.force_feedback = false;
  start(settings);
  EXPECT_FALSE(session->info()->device.actuated);
  EXPECT_FALSE(holds_without_host(session->info()->device));
}

TEST_F(GloveSession, APatientsSessionStaysOneUntilTheProgramEnds) {
  SessionSettings settings = with_glove(kProfile);
  settings.watchdog = 0.2;
  start(settings);
  EXPECT_EQ(session->info()->patient, "hand.profile = small-woman");
  EXPECT_EQ(load("grasp_box"), "");
  EXPECT_EQ(value("hand.profile"), "");
  EXPECT_EQ(session->info()->patient, "hand.profile = small-woman");
}

using LinkedSession = SessionFixture;

TEST_F(LinkedSession, AControllerOnTheLinkServesAPatient) {
  test::ControllerThread controller(listen_udp("127.0.0.1:0"), clock);
  SessionSettings settings = with(controller.address(), "grasp_teapot");
  settings.overrides = kProfile;
  start(settings);
  EXPECT_EQ(session->info()->device.watchdog, 0.02) << "the link's rule of ages";
}

}  // namespace
}  // namespace phalanx
