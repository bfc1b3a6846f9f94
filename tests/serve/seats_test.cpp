// SPDX-License-Identifier: Apache-2.0
// Who operates: one page at a time, taken over only openly.
#include "serve/seats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace phalanx {
namespace {

using ::testing::HasSubstr;

const Visitor kHere{.address = "127.0.0.1", .may_operate = true};
const Visitor kViewer{.address = "192.0.2.7", .may_operate = false};

class SeatsTest : public ::testing::Test {
 protected:
  PageId come(const Visitor& visitor = kHere, const std::string& secret = "") {
    const PageId page = ++last;
    seats.join(page, visitor, "secret" + std::to_string(page), now);
    seats.come_back(page, secret, now);
    return page;
  }
  std::string secret(PageId page) { return seats.find(page)->secret; }
  [[nodiscard]] std::string operating() const {
    const Seat* seat = seats.operating(now);
    return seat != nullptr ? seat->label() : "";
  }
  Seats seats;
  PageId last = 0;
  double now = 100.0;
};

TEST_F(SeatsTest, TheFirstWhoMayOperateDoesAndOthersDoNot) {
  const PageId viewer = come(kViewer);
  EXPECT_EQ(operating(), "");
  const PageId first = come();
  const PageId second = come();
  EXPECT_FALSE(seats.operates(viewer));
  EXPECT_TRUE(seats.operates(first));
  EXPECT_FALSE(seats.operates(second));
  EXPECT_EQ(operating(), "page 2 (127.0.0.1)");
  EXPECT_EQ(seats.here(), 3U);
}

TEST_F(SeatsTest, APageThatHasNotSaidHelloDoesNotOperate) {
  seats.join(1, kHere, "s", now);
  EXPECT_EQ(operating(), "");
}

TEST_F(SeatsTest, ControlIsTakenFromWhoeverHasItButNotByAViewer) {
  const PageId first = come();
  seats.name(first, "Anna");
  const PageId second = come();
  const PageId viewer = come(kViewer);
  EXPECT_THROW(seats.take(viewer, now), std::invalid_argument);
  EXPECT_THROW(seats.take(99, now), std::invalid_argument);
  EXPECT_EQ(seats.take(second, now), "page 1 (127.0.0.1), Anna");
  EXPECT_FALSE(seats.operates(first));
  EXPECT_TRUE(seats.operates(second));
}

TEST_F(SeatsTest, AReloadKeepsTheRoleForTenSeconds) {
  const PageId first = come();
  const std::string mine = secret(first);
  const PageId second = come();
  seats.leave(first, now);
  now += 9.9;
  EXPECT_FALSE(seats.operates(second));
  const PageId again = come(kHere, mine);
  EXPECT_TRUE(seats.operates(again));
  EXPECT_EQ(seats.find(again)->number, 1U);
  seats.leave(again, now);
  now += 10.1;
  EXPECT_EQ(operating(), "");
  EXPECT_FALSE(seats.operates(second)) << "not before give_to_only_page()";
  EXPECT_EQ(seats.take(second, now), "") << "from nobody";
  const PageId late = come(kHere, mine);
  EXPECT_FALSE(seats.operates(late));
  EXPECT_EQ(seats.find(late)->number, 1U) << "but it is the same page";
}

// Closed and opened again within the grace: the new page comes while the old one's seat is kept.
TEST_F(SeatsTest, TheOnlyPageThatMayOperateDoesOnceTheGraceIsOver) {
  const PageId first = come();
  seats.leave(first, now);
  const PageId second = come();
  come(kViewer);
  seats.join(++last, kHere, "has not said hello", now);
  now += Seats::kGrace - 1e-9;
  EXPECT_EQ(seats.give_to_only_page(now), nullptr) << "the first may come back";
  EXPECT_FALSE(seats.operates(second));
  now += 1e-6;
  EXPECT_EQ(seats.give_to_only_page(now), seats.find(second));
  EXPECT_TRUE(seats.operates(second));
  EXPECT_EQ(seats.give_to_only_page(now), nullptr) << "once";
}

TEST_F(SeatsTest, OfSeveralPagesNoneIsGivenControl) {
  const PageId first = come();
  come();
  const PageId third = come();
  seats.leave(first, now);
  now += Seats::kGrace;
  EXPECT_EQ(seats.give_to_only_page(now), nullptr);
  EXPECT_EQ(operating(), "");
  seats.leave(third, now);
  EXPECT_NE(seats.give_to_only_page(now), nullptr);
}

TEST_F(SeatsTest, APageThatHasReleasedControlIsNotGivenItAgain) {
  const PageId only = come();
  EXPECT_TRUE(seats.release(only));
  EXPECT_EQ(seats.give_to_only_page(now), nullptr);
  seats.take(only, now);
  EXPECT_TRUE(seats.operates(only));
}

TEST_F(SeatsTest, WhoeverComesNextSitsWhereNobodyDoes) {
  const PageId first = come();
  EXPECT_TRUE(seats.release(first));
  EXPECT_FALSE(seats.release(first));
  EXPECT_EQ(operating(), "");
  EXPECT_TRUE(seats.operates(come()));
}

TEST_F(SeatsTest, APageWhoseOldLineStillCountsAsOpenTakesItsOwnPlace) {
  const PageId first = come();
  seats.name(first, "Anna");
  const PageId other = come();
  const std::string mine = secret(first);
  const PageId again = ++last;
  seats.join(again, kHere, "fresh", now);
  const Seats::Return back = seats.come_back(again, mine, now);
  EXPECT_EQ(back.replaced, first);
  EXPECT_FALSE(back.sat_down) << "it operated before";
  EXPECT_EQ(seats.find(first), nullptr);
  EXPECT_TRUE(seats.operates(again));
  EXPECT_EQ(operating(), "page 1 (127.0.0.1), Anna");
  EXPECT_EQ(seats.with_secret(mine), seats.find(again));
  EXPECT_EQ(seats.here(), 2U);
  seats.leave(first, now);  // its line's end
  now += 11.0;
  EXPECT_EQ(operating(), "page 1 (127.0.0.1), Anna");
  EXPECT_FALSE(seats.operates(other));
  EXPECT_EQ(seats.come_back(again, mine, now).replaced, 0U) << "not by itself";
  EXPECT_NE(seats.find(again), nullptr);
}

TEST_F(SeatsTest, AnUnknownSecretGivesNothing) {
  const PageId first = come();
  const PageId guest = come(kHere, "guessed");
  EXPECT_FALSE(seats.operates(guest));
  EXPECT_NE(seats.find(guest)->number, seats.find(first)->number);
  EXPECT_EQ(seats.with_secret(""), nullptr);
  EXPECT_EQ(seats.with_secret("guessed"), nullptr);
  EXPECT_EQ(seats.with_secret(secret(first)), seats.find(first));
}

TEST_F(SeatsTest, WhoSitsDownBecauseNobodyOperatesIsSaid) {
  const auto sits = [this](const Visitor& visitor) {
    ++last;
    seats.join(last, visitor, "s" + std::to_string(last), now);
    return seats.come_back(last, "", now).sat_down;
  };
  EXPECT_FALSE(sits(kViewer));
  EXPECT_TRUE(sits(kHere));
  EXPECT_FALSE(sits(kHere));
}

TEST_F(SeatsTest, AnOperatorWhoComesBackByTheViewersLinkIsAViewer) {
  const PageId first = come();
  const std::string mine = secret(first);
  seats.leave(first, now);
  const PageId again = come(kViewer, mine);
  EXPECT_FALSE(seats.operates(again));
  EXPECT_FALSE(seats.find(again)->visitor.may_operate);
  EXPECT_EQ(operating(), "");
}

TEST_F(SeatsTest, ASecretIsForgottenInTheEndAndSoAreTheOldestOfTooMany) {
  const PageId first = come();
  const std::string mine = secret(first);
  seats.leave(first, now);
  now += Seats::kRemember + 1.0;
  EXPECT_NE(seats.find(come(kHere, mine))->number, 1U);
  const PageId early = come();
  const std::string earliest = secret(early);
  const std::uint32_t number = seats.find(early)->number;
  seats.leave(early, now);
  for (std::size_t i = 0; i <= Seats::kRemembered; ++i) {
    now += 0.001;
    seats.leave(come(), now);
  }
  EXPECT_NE(seats.find(come(kHere, earliest))->number, number);
}

// The grace is [0, kGrace): at its end the seat is free.
TEST_F(SeatsTest, TheGraceEndsAfterExactlyTenSeconds) {
  const PageId first = come();
  seats.leave(first, now);
  now += Seats::kGrace - 1e-9;
  EXPECT_NE(operating(), "");
  now = 100.0 + Seats::kGrace;
  EXPECT_EQ(operating(), "");
  EXPECT_TRUE(seats.operates(come()));
}

// The oldest of kRemembered is known, the oldest of one more is not; and an hour to the second is not too
// long.
TEST_F(SeatsTest, ExactlySoManyAreRememberedForExactlySoLong) {
  for (const std::size_t others : {Seats::kRemembered - 1, Seats::kRemembered}) {
    const PageId oldest = come();
    const std::string mine = secret(oldest);
    const std::uint32_t number = seats.find(oldest)->number;
    seats.leave(oldest, now);
    now += 1e-3;
    for (std::size_t i = 0; i < others; ++i) seats.leave(come(), now);
    const PageId back = come(kHere, mine);
    EXPECT_EQ(seats.find(back)->number == number, others < Seats::kRemembered) << others;
    now += 2.0 * Seats::kRemember;
  }
  now = 0.0;
  Seats fresh;
  fresh.join(1, kHere, "mine", now);
  const std::uint32_t number = fresh.find(1)->number;
  fresh.leave(1, now);
  now = Seats::kRemember;
  fresh.join(2, kHere, "other", now);
  fresh.come_back(2, "mine", now);
  EXPECT_EQ(fresh.find(2)->number, number);
}

// kRemembered visitors are kept. The oldest one is forgotten, one that has left and come back is not.
TEST_F(SeatsTest, APageThatIsBackIsNoneOfThoseThatHaveLeft) {
  const PageId oldest = come();
  const PageId reloaded = come();
  const std::string mine = secret(oldest);
  const std::string theirs = secret(reloaded);
  const std::uint32_t number = seats.find(oldest)->number;
  seats.leave(oldest, now);
  now += 1e-3;
  seats.leave(reloaded, now);
  come(kHere, theirs);
  now += 1e-3;
  for (std::size_t i = 1; i < Seats::kRemembered; ++i) seats.leave(come(), now);
  EXPECT_EQ(seats.find(come(kHere, mine))->number, number);
}

TEST_F(SeatsTest, ANameIsOneShortLine) {
  const PageId page = come();
  seats.name(page, "A\nn\u202Ena");
  EXPECT_EQ(seats.find(page)->label(), "page 1 (127.0.0.1), Anna");
  seats.name(page, std::string(1000, 'x') + "\xFF");
  EXPECT_EQ(seats.find(page)->name.size(), Seats::kNameLength);
  seats.name(99, "nobody");
}

}  // namespace
}  // namespace phalanx
