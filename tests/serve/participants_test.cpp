// SPDX-License-Identifier: Apache-2.0
#include "serve/participants.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace phalanx {
namespace {

using ::testing::HasSubstr;

const ClientInfo kHere{.address = "127.0.0.1", .may_operate = true};
const ClientInfo kViewer{.address = "192.0.2.7", .may_operate = false};

class ParticipantsTest : public ::testing::Test {
 protected:
  PageId connect(const ClientInfo& client = kHere, const std::string& secret = "") {
    const PageId page = ++last;
    participants.join(page, client, "secret" + std::to_string(page), now);
    participants.reconnect(page, secret, now);
    return page;
  }
  std::string secret(PageId page) { return participants.find(page)->secret; }
  [[nodiscard]] std::string operator_label() const {
    const Participant* participant = participants.current_operator(now);
    return participant != nullptr ? participant->label() : "";
  }
  Participants participants;
  PageId last = 0;
  double now = 100.0;
};

TEST_F(ParticipantsTest, TheFirstPageThatMayOperateIsTheOperator) {
  const PageId viewer = connect(kViewer);
  EXPECT_EQ(operator_label(), "");
  const PageId first = connect();
  const PageId second = connect();
  EXPECT_FALSE(participants.operates(viewer));
  EXPECT_TRUE(participants.operates(first));
  EXPECT_FALSE(participants.operates(second));
  EXPECT_EQ(operator_label(), "page 2 (127.0.0.1)");
  EXPECT_EQ(participants.count(), 3U);
}

TEST_F(ParticipantsTest, APageThatHasNotSaidHelloDoesNotOperate) {
  participants.join(1, kHere, "s", now);
  EXPECT_EQ(operator_label(), "");
}

TEST_F(ParticipantsTest, ControlIsTakenFromTheOperatorButNotByAViewer) {
  const PageId first = connect();
  participants.name(first, "Anna");
  const PageId second = connect();
  const PageId viewer = connect(kViewer);
  EXPECT_THROW(participants.take_control(viewer, now), std::invalid_argument);
  EXPECT_THROW(participants.take_control(99, now), std::invalid_argument);
  EXPECT_EQ(participants.take_control(second, now), "page 1 (127.0.0.1), Anna");
  EXPECT_FALSE(participants.operates(first));
  EXPECT_TRUE(participants.operates(second));
}

TEST_F(ParticipantsTest, AReloadKeepsTheRoleForTenSeconds) {
  const PageId first = connect();
  const std::string own = secret(first);
  const PageId second = connect();
  participants.leave(first, now);
  now += 9.9;
  EXPECT_FALSE(participants.operates(second));
  const PageId again = connect(kHere, own);
  EXPECT_TRUE(participants.operates(again));
  EXPECT_EQ(participants.find(again)->number, 1U);
  participants.leave(again, now);
  now += 10.1;
  EXPECT_EQ(operator_label(), "");
  EXPECT_FALSE(participants.operates(second)) << "not before give_to_only_page()";
  EXPECT_EQ(participants.take_control(second, now), "") << "there was no operator";
  const PageId late = connect(kHere, own);
  EXPECT_FALSE(participants.operates(late));
  EXPECT_EQ(participants.find(late)->number, 1U) << "but it is the same page";
}

// Closed and opened again within kGrace: the new page connects while the old participant is
// still the operator.
TEST_F(ParticipantsTest, TheOnlyPageThatMayOperateBecomesTheOperatorAfterTheGrace) {
  const PageId first = connect();
  participants.leave(first, now);
  const PageId second = connect();
  connect(kViewer);
  participants.join(++last, kHere, "has not said hello", now);
  now += Participants::kGrace - 1e-9;
  EXPECT_EQ(participants.give_to_only_page(now), nullptr) << "the first may reconnect";
  EXPECT_FALSE(participants.operates(second));
  now += 1e-6;
  EXPECT_EQ(participants.give_to_only_page(now), participants.find(second));
  EXPECT_TRUE(participants.operates(second));
  EXPECT_EQ(participants.give_to_only_page(now), nullptr) << "once";
}

TEST_F(ParticipantsTest, OfSeveralPagesNoneIsGivenControl) {
  const PageId first = connect();
  connect();
  const PageId third = connect();
  participants.leave(first, now);
  now += Participants::kGrace;
  EXPECT_EQ(participants.give_to_only_page(now), nullptr);
  EXPECT_EQ(operator_label(), "");
  participants.leave(third, now);
  EXPECT_NE(participants.give_to_only_page(now), nullptr);
}

TEST_F(ParticipantsTest, APageThatHasReleasedControlIsNotGivenItAgain) {
  const PageId only = connect();
  EXPECT_TRUE(participants.release_control(only));
  EXPECT_EQ(participants.give_to_only_page(now), nullptr);
  participants.take_control(only, now);
  EXPECT_TRUE(participants.operates(only));
}

TEST_F(ParticipantsTest, TheNextPageThatJoinsOperatesIfThereIsNoOperator) {
  const PageId first = connect();
  EXPECT_TRUE(participants.release_control(first));
  EXPECT_FALSE(participants.release_control(first));
  EXPECT_EQ(operator_label(), "");
  EXPECT_TRUE(participants.operates(connect()));
}

TEST_F(ParticipantsTest, APageReplacesItsOldConnectionThatStillCountsAsOpen) {
  const PageId first = connect();
  participants.name(first, "Anna");
  const PageId other = connect();
  const std::string own = secret(first);
  const PageId again = ++last;
  participants.join(again, kHere, "fresh", now);
  const Participants::Reconnection reconnection = participants.reconnect(again, own, now);
  EXPECT_EQ(reconnection.replaced, first);
  EXPECT_FALSE(reconnection.became_operator) << "it operated before";
  EXPECT_EQ(participants.find(first), nullptr);
  EXPECT_TRUE(participants.operates(again));
  EXPECT_EQ(operator_label(), "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(participants.with_secret(own), participants.find(again));
  EXPECT_EQ(participants.count(), 2U);
  participants.leave(first, now);  // the end of its connection
  now += 11.0;
  EXPECT_EQ(operator_label(), "page 1 (127.0.0.1), Anna");
  EXPECT_FALSE(participants.operates(other));
  EXPECT_EQ(participants.reconnect(again, own, now).replaced, 0U) << "a page does not replace itself";
  EXPECT_NE(participants.find(again), nullptr);
}

TEST_F(ParticipantsTest, AnUnknownSecretGivesNothing) {
  const PageId first = connect();
  const PageId stranger = connect(kHere, "guessed");
  EXPECT_FALSE(participants.operates(stranger));
  EXPECT_NE(participants.find(stranger)->number, participants.find(first)->number);
  EXPECT_EQ(participants.with_secret(""), nullptr);
  EXPECT_EQ(participants.with_secret("guessed"), nullptr);
  EXPECT_EQ(participants.with_secret(secret(first)), participants.find(first));
}

TEST_F(ParticipantsTest, BecomingTheOperatorIsReported) {
  const auto becomes_operator = [this](const ClientInfo& client) {
    ++last;
    participants.join(last, client, "s" + std::to_string(last), now);
    return participants.reconnect(last, "", now).became_operator;
  };
  EXPECT_FALSE(becomes_operator(kViewer));
  EXPECT_TRUE(becomes_operator(kHere));
  EXPECT_FALSE(becomes_operator(kHere));
}

TEST_F(ParticipantsTest, AnOperatorWhoReconnectsWithTheViewersLinkIsAViewer) {
  const PageId first = connect();
  const std::string own = secret(first);
  participants.leave(first, now);
  const PageId again = connect(kViewer, own);
  EXPECT_FALSE(participants.operates(again));
  EXPECT_FALSE(participants.find(again)->client.may_operate);
  EXPECT_EQ(operator_label(), "");
}

TEST_F(ParticipantsTest, ASecretIsForgottenAfterItsTimeAndSoAreTheOldestOfTooMany) {
  const PageId first = connect();
  const std::string own = secret(first);
  participants.leave(first, now);
  now += Participants::kRemember + 1.0;
  EXPECT_NE(participants.find(connect(kHere, own))->number, 1U);
  const PageId early = connect();
  const std::string earliest = secret(early);
  const std::uint32_t number = participants.find(early)->number;
  participants.leave(early, now);
  for (std::size_t i = 0; i <= Participants::kRemembered; ++i) {
    now += 0.001;
    participants.leave(connect(), now);
  }
  EXPECT_NE(participants.find(connect(kHere, earliest))->number, number);
}

// The interval is [0, kGrace): at its end there is no operator.
TEST_F(ParticipantsTest, TheGraceEndsAfterExactlyTenSeconds) {
  const PageId first = connect();
  participants.leave(first, now);
  now += Participants::kGrace - 1e-9;
  EXPECT_NE(operator_label(), "");
  now = 100.0 + Participants::kGrace;
  EXPECT_EQ(operator_label(), "");
  EXPECT_TRUE(participants.operates(connect()));
}

// The oldest of kRemembered participants is known, the oldest of one more is not. Exactly kRemember is
// not too long.
TEST_F(ParticipantsTest, ExactlySoManyAreRememberedForExactlySoLong) {
  for (const std::size_t others : {Participants::kRemembered - 1, Participants::kRemembered}) {
    const PageId oldest = connect();
    const std::string own = secret(oldest);
    const std::uint32_t number = participants.find(oldest)->number;
    participants.leave(oldest, now);
    now += 1e-3;
    for (std::size_t i = 0; i < others; ++i) participants.leave(connect(), now);
    const PageId back = connect(kHere, own);
    EXPECT_EQ(participants.find(back)->number == number, others < Participants::kRemembered) << others;
    now += 2.0 * Participants::kRemember;
  }
  now = 0.0;
  Participants fresh;
  fresh.join(1, kHere, "mine", now);
  const std::uint32_t number = fresh.find(1)->number;
  fresh.leave(1, now);
  now = Participants::kRemember;
  fresh.join(2, kHere, "other", now);
  fresh.reconnect(2, "mine", now);
  EXPECT_EQ(fresh.find(2)->number, number);
}

// kRemembered participants are kept. One that has reconnected does not count among them.
TEST_F(ParticipantsTest, APageThatHasReconnectedIsNoneOfThoseThatHaveLeft) {
  const PageId oldest = connect();
  const PageId reloaded = connect();
  const std::string own = secret(oldest);
  const std::string theirs = secret(reloaded);
  const std::uint32_t number = participants.find(oldest)->number;
  participants.leave(oldest, now);
  now += 1e-3;
  participants.leave(reloaded, now);
  connect(kHere, theirs);
  now += 1e-3;
  for (std::size_t i = 1; i < Participants::kRemembered; ++i) participants.leave(connect(), now);
  EXPECT_EQ(participants.find(connect(kHere, own))->number, number);
}

TEST_F(ParticipantsTest, ANameIsOneShortLine) {
  const PageId page = connect();
  participants.name(page, "A\nn\u202Ena");
  EXPECT_EQ(participants.find(page)->label(), "page 1 (127.0.0.1), Anna");
  participants.name(page, std::string(1000, 'x') + "\xFF");
  EXPECT_EQ(participants.find(page)->name.size(), Participants::kNameLength);
  participants.name(99, "unknown");
}

TEST_F(ParticipantsTest, ThePatientsScreenNeverOperates) {
  const PageId screen = ++last;
  participants.join(screen, kHere, "of the screen", now);
  EXPECT_FALSE(participants.reconnect(screen, "", now, true).became_operator);
  EXPECT_EQ(operator_label(), "");
  EXPECT_EQ(participants.give_to_only_page(now), nullptr);
  EXPECT_THROW(participants.take_control(screen, now), std::invalid_argument);
  EXPECT_TRUE(participants.any_patient_screen());
  const PageId cockpit = connect();
  EXPECT_TRUE(participants.operates(cockpit)) << "the screen does not stand in its way";
  const std::string mine = secret(cockpit);
  participants.leave(cockpit, now);
  const PageId again = ++last;
  participants.join(again, kHere, "another", now);
  participants.reconnect(again, mine, now, true);
  EXPECT_FALSE(participants.operates(again)) << "the operator's page comes back as the patient's screen";
  EXPECT_EQ(operator_label(), "");
}

TEST_F(ParticipantsTest, AnAccountThatSignsOutWhileItsPageIsAwayIsNotThereAfterwards) {
  const PageId page = connect();
  participants.sign_in(secret(page), "screen1", Role::kPatientScreen);
  EXPECT_EQ(participants.find(page)->role, Role::kPatientScreen);
  const std::string mine = secret(page);
  participants.leave(page, now);
  participants.sign_in(mine, "");
  const PageId again = connect(kHere, mine);
  EXPECT_EQ(participants.find(again)->account, "");
  EXPECT_EQ(participants.find(again)->role, Role::kLookOn);
}

}  // namespace
}  // namespace phalanx
