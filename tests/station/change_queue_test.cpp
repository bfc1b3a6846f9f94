// SPDX-License-Identifier: Apache-2.0
#include "station/change_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::SizeIs;

ChangeRequest scene(const std::string& text) {
  return {.text = text, .work = [] {}, .done = [](const ChangeOutcome&) {}, .sets = {}, .retry = false};
}

class ChangeQueueTest : public testing::Test {
 protected:
  StationHost::Done to(int number) {
    return [this, number](const ChangeOutcome&) { answered.push_back(number); };
  }
  /// Whom it names, in order.
  std::vector<int> named(const std::vector<StationHost::Done>& waiting) {
    answered.clear();
    for (const auto& done : waiting) done({});
    return answered;
  }
  ChangeQueue queue;
  std::vector<int> answered;
};

TEST_F(ChangeQueueTest, IsInOrder) {
  queue.ask(scene("one"));
  queue.ask(scene("two"));
  EXPECT_EQ(queue.take()->text, "one");
  EXPECT_EQ(queue.take()->text, "two");
  EXPECT_FALSE(queue.take().has_value());
}

TEST_F(ChangeQueueTest, AnOldValueIsOvertakenByANewerOneAndNeverAnsweredAsDone) {
  queue.ask_set({{"a", "1"}}, to(1));
  queue.ask_set({{"b", "1"}}, to(2));
  queue.ask_set({{"a", "2"}}, to(3));
  queue.ask_set({{"a", "3"}}, to(4));
  const auto request = queue.take();
  ASSERT_TRUE(request);
  ASSERT_THAT(request->sets, SizeIs(2));
  EXPECT_THAT(request->sets[0].changes, ElementsAre(Pair("b", "1")));
  EXPECT_THAT(request->sets[1].changes, ElementsAre(Pair("a", "3")));
  EXPECT_EQ(request->text, "b = 1, a = 3");
  EXPECT_THAT(named({request->sets[0].done}), ElementsAre(2));
  EXPECT_THAT(request->sets[0].overtaken, SizeIs(0));
  EXPECT_THAT(named({request->sets[1].done}), ElementsAre(4));
  EXPECT_THAT(named(request->sets[1].overtaken), ElementsAre(1, 3));
  const ChangeAnswer answer = answer_to(request->sets[1], "why");
  EXPECT_THAT(named({answer.done}), ElementsAre(4));
  EXPECT_THAT(named(answer.overtaken), ElementsAre(1, 3));
  EXPECT_EQ(answer.refused, "why");
  EXPECT_FALSE(queue.take().has_value());
}

TEST_F(ChangeQueueTest, AValueThatIsNotSetAgainIsNotOvertaken) {
  queue.ask_set({{"a", "1"}, {"b", "1"}}, to(1));
  queue.ask_set({{"a", "2"}}, to(2));
  EXPECT_THAT(queue.take()->sets, SizeIs(2));
}

TEST_F(ChangeQueueTest, SetsDoNotJoinAcrossAnotherRequest) {
  queue.ask_set({{"a", "1"}}, to(1));
  queue.ask(scene("between"));
  queue.ask_set({{"a", "2"}}, to(2));
  EXPECT_THAT(queue.take()->sets, SizeIs(1));
  EXPECT_EQ(queue.take()->text, "between");
  EXPECT_THAT(queue.take()->sets, SizeIs(1));
}

TEST_F(ChangeQueueTest, IsBoundedInRequestsPartsAndAnswers) {
  for (std::size_t i = 0; i < ChangeQueue::kRequests * ChangeQueue::kParts; ++i)
    queue.ask_set({{std::to_string(i), "1"}}, {});
  EXPECT_THROW(queue.ask_set({{"more", "1"}}, {}), std::runtime_error);
  EXPECT_NO_THROW(queue.ask_set({{"255", "2"}}, {})) << "a newer value of one that waits needs no place";
  queue.clear();
  EXPECT_FALSE(queue.take().has_value());
  for (std::size_t i = 0; i < ChangeQueue::kAnswers; ++i) queue.ask_set({{"a", "1"}}, to(1));
  EXPECT_THROW(queue.ask_set({{"a", "1"}}, to(1)), std::runtime_error);
  EXPECT_TRUE(queue.take().has_value());
  EXPECT_NO_THROW(queue.ask_set({{"a", "1"}}, to(1))) << "taken ones count no more";
}

// "k = " and 296 letters are 300 bytes, after which one more change is told; a letter more, and it is not.
TEST_F(ChangeQueueTest, ALongTextIsCutBetweenTwoChanges) {
  const std::string most(296, 'v');
  EXPECT_EQ(text_of({{"k", most}, {"m", "1"}}), "k = " + most + ", m = 1");
  EXPECT_EQ(text_of({{"k", most + "v"}, {"m", "1"}}), "k = " + most + "v, ...");
  EXPECT_EQ(text_of({{"rate_hz", ""}}), "rate_hz = as in the scene");
}

TEST_F(ChangeQueueTest, OneTryToMakeAStationIsEnough) {
  for (int i = 0; i < 100; ++i)
    queue.ask({.text = "try", .work = [] {}, .done = {}, .sets = {}, .retry = true});
  EXPECT_TRUE(queue.take().has_value());
  EXPECT_FALSE(queue.take().has_value());
}

}  // namespace
}  // namespace phalanx
