// SPDX-License-Identifier: Apache-2.0
// The parts that need no socket.
#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <utility>

#include "serve/web/doorstep.h"
#include "serve/web/message_rate.h"
#include "serve/web/page_queue.h"
#include "serve/web/patience.h"
#include "serve/web/request_path.h"

namespace phalanx::web {
namespace {

using std::chrono::milliseconds;

TEST(MessageRate, AllowsSoManyInAnySecond) {
  MessageRate rate(3);
  const MessageRate::Time start{std::chrono::hours(1)};
  for (const int at : {0, 500, 999}) EXPECT_TRUE(rate.allows_one(start + milliseconds(at)));
  EXPECT_TRUE(rate.allows_one(start + milliseconds(1000))) << "the first is a second ago";
  EXPECT_FALSE(rate.allows_one(start + milliseconds(1499))) << "500, 999 and 1000 are not";
}

/// Somebody on a doorstep.
struct Guest {
  Guest(Doorstep& doorstep, const std::string& address)
      : stay(std::in_place, doorstep.come(address, [this] { stay.reset(); })) {}
  [[nodiscard]] bool waits() const { return stay.has_value(); }
  std::optional<Doorstep::Stay> stay;
};

TEST(Doorstep, ANewOneTakesThePlaceOfTheOldestOfItsAddressAndThenOfAll) {
  Doorstep doorstep(3, 2);
  Guest a1(doorstep, "a");
  Guest b1(doorstep, "b");
  Guest b2(doorstep, "b");
  Guest b3(doorstep, "b");
  EXPECT_FALSE(b1.waits()) << "b has two";
  EXPECT_TRUE(a1.waits()) << "others do not notice";
  Guest c1(doorstep, "c");
  EXPECT_FALSE(a1.waits()) << "three in all";
  EXPECT_EQ(doorstep.waiting(), 3U);
  b2.stay.reset();
  Guest d1(doorstep, "d");
  for (const Guest* guest : {&b3, &c1, &d1}) EXPECT_TRUE(guest->waits());
}

TEST(Doorstep, TheAddressesOfOneNetworkOfIPv6AreOne) {
  Doorstep doorstep(9, 2);
  Guest first(doorstep, "2001:db8::1");
  Guest other(doorstep, "2001:db8:0:1::1");
  Guest mapped(doorstep, "::ffff:10.0.0.1");
  Guest mapped_too(doorstep, "::ffff:10.0.0.2");
  Guest mapped_three(doorstep, "::ffff:10.0.0.3");
  Guest second(doorstep, "2001:db8::2");
  EXPECT_TRUE(first.waits());
  Guest third(doorstep, "2001:db8::ffff:3");
  EXPECT_FALSE(first.waits());
  for (const Guest* guest : {&other, &mapped, &mapped_too, &mapped_three, &second, &third})
    EXPECT_TRUE(guest->waits());
}

TEST(PageQueue, TakesWhatIsLargerThanItselfWhenEmpty) {
  PageQueue queue(2, 10);
  const auto long_one = std::make_shared<const std::string>(100, 'x');
  const auto short_one = std::make_shared<const std::string>("y");
  EXPECT_TRUE(queue.push(long_one));
  EXPECT_FALSE(queue.push(short_one));
  EXPECT_FALSE(queue.put_newest(long_one));
  EXPECT_TRUE(queue.put_newest(short_one)) << "in its place";
  EXPECT_EQ(queue.take(), long_one);
  EXPECT_EQ(queue.take(), short_one);
  EXPECT_EQ(queue.take(), nullptr);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(queue.push(short_one));
  EXPECT_FALSE(queue.push(short_one));
}

TEST(ReadTarget, TakesUtf8AndNothingBroken) {
  EXPECT_EQ(read_target("/W%C3%BCrfel.stl?q=%2F")->path, "/W\u00fcrfel.stl");
  EXPECT_EQ(read_target("/W%C3%BCrfel.stl?q=%2F")->query, "q=%2F");
  for (const char* broken : {"/%C3", "/%C0%80", "/%ED%A0%80", "/%F5%80%80%80", "/%80", "/%0A", "/%7F", ""}) {
    EXPECT_FALSE(read_target(broken)) << broken;
  }
}

TEST(ReadTarget, TakesNoSegmentThatIsEmptyOrLeadsElsewhere) {
  for (const char* odd :
       {"//", "//a", "/.", "/..", "/./a", "/../a", "/a//", "/a//b", "/a/.", "/a/..", "/a/./b", "/a/../b"})
    EXPECT_FALSE(read_target(odd)) << odd;
  for (const char* plain : {"/", "/a", "/a/", "/a.", "/.a", "/a./b", "/a../b", "/...", "/a/.b/"})
    EXPECT_TRUE(read_target(plain)) << plain;
}

// 32,000 bytes at 16 kB/s: 2 s more.
TEST(Patience, IsTheTimeToBeIdleAndThatOfASlowLine) {
  EXPECT_EQ(patience(20.0, 0), 20.0);
  EXPECT_EQ(patience(20.0, 32'000), 22.0);
}

TEST(AcceptsGzip, ReadsWeights) {
  for (const char* yes : {"gzip", "br, gzip", "gzip;q=0.1", "deflate , gzip ; q=1"})
    EXPECT_TRUE(accepts_gzip(yes));
  for (const char* no : {"", "br", "gzip;q=0", "gzip;q=0.000", "xgzip"}) EXPECT_FALSE(accepts_gzip(no)) << no;
}

}  // namespace
}  // namespace phalanx::web
