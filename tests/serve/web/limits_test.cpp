// SPDX-License-Identifier: Apache-2.0
#include "serve/web/limits.h"

#include <gmock/gmock.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace phalanx::web {
namespace {

using std::chrono::milliseconds;

TEST(MessageRateLimit, AllowsItsNumberInAnySecond) {
  MessageRateLimit rate(3);
  const MessageRateLimit::Time start{std::chrono::hours(1)};
  for (const int at : {0, 500, 999}) EXPECT_TRUE(rate.allow(start + milliseconds(at)));
  EXPECT_TRUE(rate.allow(start + milliseconds(1000))) << "the first is a second ago";
  EXPECT_FALSE(rate.allow(start + milliseconds(1499))) << "500, 999 and 1000 are not";
}

/// A pending connection that gives up its slot when it is evicted.
struct Pending {
  Pending(ConnectionLimiter& limiter, const std::string& address)
      : slot(std::in_place, limiter.admit(address, [this] { slot.reset(); })) {}
  [[nodiscard]] bool has_slot() const { return slot.has_value(); }
  std::optional<ConnectionLimiter::Slot> slot;
};

TEST(ConnectionLimiter, ANewConnectionEvictsTheOldestOfItsAddressAndThenOfAll) {
  ConnectionLimiter limiter(3, 2);
  Pending a1(limiter, "a");
  Pending b1(limiter, "b");
  Pending b2(limiter, "b");
  Pending b3(limiter, "b");
  EXPECT_FALSE(b1.has_slot()) << "b has two";
  EXPECT_TRUE(a1.has_slot()) << "other addresses keep theirs";
  Pending c1(limiter, "c");
  EXPECT_FALSE(a1.has_slot()) << "three in all";
  EXPECT_EQ(limiter.pending(), 3U);
  b2.slot.reset();
  Pending d1(limiter, "d");
  for (const Pending* one : {&b3, &c1, &d1}) EXPECT_TRUE(one->has_slot());
}

TEST(ConnectionLimiter, TheAddressesOfOneNetworkOfIPv6AreOne) {
  ConnectionLimiter limiter(9, 2);
  Pending first(limiter, "2001:db8::1");
  Pending other(limiter, "2001:db8:0:1::1");
  Pending mapped(limiter, "::ffff:10.0.0.1");
  Pending mapped_too(limiter, "::ffff:10.0.0.2");
  Pending mapped_three(limiter, "::ffff:10.0.0.3");
  Pending second(limiter, "2001:db8::2");
  EXPECT_TRUE(first.has_slot());
  Pending third(limiter, "2001:db8::ffff:3");
  EXPECT_FALSE(first.has_slot());
  for (const Pending* one : {&other, &mapped, &mapped_too, &mapped_three, &second, &third})
    EXPECT_TRUE(one->has_slot());
}

TEST(OutgoingQueue, AcceptsAMessageLargerThanItsLimitWhenEmpty) {
  OutgoingQueue queue(2, 10);
  const auto long_one = std::make_shared<const std::string>(100, 'x');
  const auto short_one = std::make_shared<const std::string>("y");
  EXPECT_TRUE(queue.push(long_one));
  EXPECT_FALSE(queue.push(short_one));
  EXPECT_FALSE(queue.set_newest(long_one));
  EXPECT_TRUE(queue.set_newest(short_one)) << "it replaces the first";
  EXPECT_EQ(queue.pop(), long_one);
  EXPECT_EQ(queue.pop(), short_one);
  EXPECT_EQ(queue.pop(), nullptr);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(queue.push(short_one));
  EXPECT_FALSE(queue.push(short_one));
}

TEST(OutgoingQueue, KindsOfNewestMessagesTakeTurns) {
  OutgoingQueue queue(2, 10);
  const auto a = std::make_shared<const std::string>("a");
  const auto b = std::make_shared<const std::string>("b");
  const auto c = std::make_shared<const std::string>("c");
  EXPECT_FALSE(queue.set_newest(a, 0));
  EXPECT_FALSE(queue.set_newest(b, 1)) << "another kind replaces none";
  EXPECT_EQ(queue.pop(), a);
  EXPECT_FALSE(queue.set_newest(a, 0));
  EXPECT_EQ(queue.pop(), b) << "kind 0 does not go first each time";
  EXPECT_FALSE(queue.set_newest(b, 1));
  EXPECT_TRUE(queue.set_newest(c, 1));
  EXPECT_EQ(queue.pop(), a);
  EXPECT_EQ(queue.pop(), c);
  EXPECT_EQ(queue.pop(), nullptr);
  EXPECT_FALSE(queue.set_newest(c, 1));
  queue.clear();
  EXPECT_EQ(queue.pop(), nullptr);
}

// 32,000 bytes at 16 kB/s: 2 s more.
TEST(TransferTimeout, IsTheIdleTimeoutAndTheTimeOfASlowTransfer) {
  EXPECT_EQ(transfer_timeout(20.0, 0), 20.0);
  EXPECT_EQ(transfer_timeout(20.0, 32'000), 22.0);
}

}  // namespace
}  // namespace phalanx::web
