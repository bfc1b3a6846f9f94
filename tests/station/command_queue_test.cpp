// SPDX-License-Identifier: Apache-2.0
#include "station/command_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <list>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/count_allocations.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

class CommandQueueTest : public testing::Test {
 protected:
  void load(const std::string& scene) { queue.ask(LoadScene{scene}, {}); }
  void set(const Overrides& changes, int number = 0) {
    queue.ask(SetValues{changes}, [this, number](const ChangeOutcome& outcome) {
      answered.emplace_back(number, outcome.overtaken ? "overtaken" : outcome.refused);
    });
  }
  std::list<Command> take() { return queue.take(std::chrono::milliseconds(0)); }
  /// @returns the text of the next command; empty: there is none
  std::string take_text() {
    const std::list<Command> taken = take();
    return taken.empty() ? "" : text_of(taken.front());
  }
  void call_all() {
    while (const auto answer = queue.next_answer()) answer->done(answer->outcome);
  }

  CommandQueue queue;
  std::vector<std::pair<int, std::string>> answered;  ///< number and outcome of each callback, in order
};

TEST_F(CommandQueueTest, IsInOrder) {
  load("one");
  load("two");
  EXPECT_EQ(take_text(), "scene one");
  EXPECT_EQ(take_text(), "scene two");
  EXPECT_THAT(take(), IsEmpty());
}

TEST_F(CommandQueueTest, AnOldValueIsOvertakenByANewerOneAndAnsweredBeforeIt) {
  set({{"a", "1"}}, 1);
  set({{"b", "1"}}, 2);
  set({{"a", "2"}}, 3);
  set({{"a", "3"}}, 4);
  std::list<Command> taken = take();
  ASSERT_THAT(taken, SizeIs(1));
  std::list<Request>& requests = taken.front().requests;
  ASSERT_THAT(requests, SizeIs(2));
  EXPECT_THAT(std::get<SetValues>(requests.front().action).changes, ElementsAre(Pair("b", "1")));
  EXPECT_THAT(std::get<SetValues>(requests.back().action).changes, ElementsAre(Pair("a", "3")));
  EXPECT_EQ(text_of(taken.front()), "b = 1, a = 3");
  EXPECT_THAT(changes_of(taken.front()), ElementsAre(Pair("b", "1"), Pair("a", "3")));
  requests.back().refused = "why";
  call_all();
  EXPECT_THAT(answered, IsEmpty()) << "it is not made yet";
  queue.answer(std::move(taken));
  call_all();
  EXPECT_THAT(answered, ElementsAre(Pair(2, ""), Pair(1, "overtaken"), Pair(3, "overtaken"), Pair(4, "why")));
  EXPECT_THAT(take(), IsEmpty());
}

TEST_F(CommandQueueTest, AValueThatIsNotSetAgainIsNotOvertaken) {
  set({{"a", "1"}, {"b", "1"}});
  set({{"a", "2"}});
  EXPECT_THAT(take().front().requests, SizeIs(2));
}

TEST_F(CommandQueueTest, SetsDoNotJoinAcrossAnotherRequest) {
  set({{"a", "1"}});
  load("between");
  set({{"a", "2"}});
  EXPECT_EQ(take_text(), "a = 1");
  EXPECT_EQ(take_text(), "scene between");
  EXPECT_EQ(take_text(), "a = 2");
}

TEST_F(CommandQueueTest, IsBoundedInCommandsAndRequests) {
  for (std::size_t i = 0; i < CommandQueue::kCommands * CommandQueue::kRequests; ++i)
    set({{std::to_string(i), "1"}});
  EXPECT_THROW(set({{"more", "1"}}), std::runtime_error);
  EXPECT_THROW(load("more"), std::runtime_error);
  EXPECT_NO_THROW(set({{"255", "2"}})) << "a newer value of one that waits needs no place";
}

TEST_F(CommandQueueTest, IsBoundedInAnswersUntilTheOwnerHasThem) {
  for (std::size_t i = 0; i < CommandQueue::kAnswers; ++i) set({{"a", "1"}});
  EXPECT_THROW(set({{"a", "1"}}), std::runtime_error);
  queue.answer(take());
  EXPECT_THROW(set({{"a", "1"}}), std::runtime_error) << "the callbacks are still there";
  EXPECT_TRUE(queue.next_answer().has_value());
  EXPECT_NO_THROW(set({{"a", "1"}}));
}

TEST_F(CommandQueueTest, AnEmptyCallbackIsLeftOut) {
  load("one");
  queue.answer(take());
  EXPECT_FALSE(queue.next_answer().has_value());
}

// So a change can be refused for want of memory, and the refusal arrives.
TEST_F(CommandQueueTest, OnlyAskingNeedsMemory) {
  set({{"a", "1"}}, 1);
  set({{"a", "2"}}, 2);
  const std::size_t before = test::allocations_of_this_thread();
  std::list<Command> taken = take();
  taken.front().requests.front().refused = "out of memory";
  queue.answer(std::move(taken));
  const std::optional<Answer> older = queue.next_answer();
  const std::optional<Answer> newer = queue.next_answer();
  EXPECT_EQ(test::allocations_of_this_thread(), before);
  EXPECT_TRUE(older.value().outcome.overtaken);
  EXPECT_EQ(newer.value().outcome.refused, "out of memory");
}

// Time passes while all threads sleep (held clock): after sleep_for() the worker waits, and nothing but a
// notification ends its wait.
TEST_F(CommandQueueTest, AThreadThatWaitsIsWokenByACommandAndByTheEnd) {
  std::promise<std::string> first;
  std::size_t second = 1;
  std::thread worker([&] {
    first.set_value(text_of(queue.take(std::nullopt).front()));
    second = queue.take(std::nullopt).size();
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  load("one");
  EXPECT_EQ(first.get_future().get(), "scene one");
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  queue.end();
  worker.join();
  EXPECT_EQ(second, 0U);
}

TEST_F(CommandQueueTest, OnceItHasEndedItRefusesCommandsAndDropsThoseThatWait) {
  set({{"a", "1"}}, 1);
  EXPECT_FALSE(queue.ended());
  queue.end();
  EXPECT_TRUE(queue.ended());
  EXPECT_THAT(take(), IsEmpty());
  EXPECT_THAT([&] { load("late"); }, ThrowsMessage<std::runtime_error>(HasSubstr("has ended")));
  EXPECT_THAT(take(), IsEmpty());
  call_all();
  EXPECT_THAT(answered, IsEmpty());
}

// "k = " and 296 letters are 300 bytes, after which one more change is told; a letter more, and it is not.
TEST_F(CommandQueueTest, ALongTextIsCutBetweenTwoChanges) {
  const std::string most(296, 'v');
  EXPECT_EQ(text_of(Overrides{{"k", most}, {"m", "1"}}), "k = " + most + ", m = 1");
  EXPECT_EQ(text_of(Overrides{{"k", most + "v"}, {"m", "1"}}), "k = " + most + "v, ...");
  EXPECT_EQ(text_of(Overrides{{"rate_hz", ""}}), "rate_hz = as in the scene");
}

TEST_F(CommandQueueTest, EachKindOfCommandHasAText) {
  queue.ask(SelectSource{HandSource::kSliders}, {});
  queue.ask(SelectSource{HandSource::kPatient}, {});
  queue.ask(WizardStep{.kind = WizardStep::Kind::kSkip}, {});
  queue.ask(MakeStation{}, {});
  for (const char* text : {"sliders", "simulated patient", "calibration", "another try"})
    EXPECT_EQ(take_text(), text);
}

TEST_F(CommandQueueTest, ATryToMakeAStationIsAcceptedWhenNothingElseIs) {
  for (std::size_t i = 0; i < CommandQueue::kCommands; ++i) load("one");
  EXPECT_THROW(load("more"), std::runtime_error);
  EXPECT_NO_THROW(queue.ask(MakeStation{}, {}));
  for (std::size_t i = 0; i < CommandQueue::kCommands; ++i) EXPECT_EQ(take_text(), "scene one");
  EXPECT_EQ(take_text(), "another try");
}

TEST_F(CommandQueueTest, ATryToMakeAStationIsAcceptedBesideUnfetchedAnswers) {
  for (std::size_t i = 0; i < CommandQueue::kAnswers; ++i) set({{"a", "1"}});
  queue.answer(take());
  EXPECT_THROW(load("more"), std::runtime_error);
  EXPECT_NO_THROW(queue.ask(MakeStation{}, {}));
  EXPECT_EQ(take_text(), "another try");
}

TEST_F(CommandQueueTest, OneTryToMakeAStationIsEnough) {
  for (int i = 0; i < 100; ++i) queue.ask(MakeStation{}, {});
  EXPECT_THAT(take(), SizeIs(1));
  EXPECT_THAT(take(), IsEmpty());
}

}  // namespace
}  // namespace phalanx
