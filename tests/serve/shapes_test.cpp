// SPDX-License-Identifier: Apache-2.0
#include "serve/shapes.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <utility>

#include "phalanx/geometry.pb.h"

namespace phalanx {
namespace {

std::shared_ptr<const HostGeometry> shape_of(std::uint32_t revision) {
  auto shape = std::make_shared<HostGeometry>();
  shape->revision = revision;
  return shape;
}

/// Waits for it: another thread may give it.
WebAnswer answer_to(Shapes& shapes, std::uint32_t revision) {
  const auto answered = std::make_shared<std::promise<WebAnswer>>();
  shapes.ask(shape_of(revision), [answered](WebAnswer answer) { answered->set_value(std::move(answer)); });
  return answered->get_future().get();
}

/// No thread can be started while it lives: its stack would exceed the address space.
class NoThreads {
 public:
  NoThreads() {
    EXPECT_EQ(::pthread_getattr_default_np(&before_), 0);
    pthread_attr_t huge;
    EXPECT_EQ(::pthread_attr_init(&huge), 0);
    EXPECT_EQ(::pthread_attr_setstacksize(&huge, std::size_t{1} << 60U), 0);
    EXPECT_EQ(::pthread_setattr_default_np(&huge), 0);
    ::pthread_attr_destroy(&huge);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;
  ~NoThreads() {
    EXPECT_EQ(::pthread_setattr_default_np(&before_), 0);
    ::pthread_attr_destroy(&before_);
  }

 private:
  pthread_attr_t before_{};
};

TEST(Shapes, ARevisionIsEncodedOnce) {
  const auto shapes = std::make_shared<Shapes>();
  const WebAnswer first = answer_to(*shapes, 3);
  ASSERT_EQ(first.status, 200);
  ASSERT_NE(first.body, nullptr);
  EXPECT_EQ(first.type, "application/x-protobuf");
  EXPECT_EQ(answer_to(*shapes, 3).body, first.body) << "the very same bytes";
  const WebAnswer next = answer_to(*shapes, 4);
  ASSERT_NE(next.body, nullptr);
  wire::Geometry message;
  ASSERT_TRUE(message.ParseFromString(*next.body));
  EXPECT_EQ(message.revision(), 4U);
}

TEST(Shapes, WhereNoThreadIsToBeHadThePageIsToldAtOnceAndMayAskAgain) {
  const auto shapes = std::make_shared<Shapes>();
  int refused = 0;
  {
    const NoThreads none;
    shapes->ask(shape_of(3), [&refused](const WebAnswer& answer) {
      ++refused;
      EXPECT_EQ(answer.status, 500);
      EXPECT_EQ(answer.body, nullptr);
    });
    EXPECT_EQ(refused, 1);
  }
  EXPECT_EQ(answer_to(*shapes, 3).status, 200);
  EXPECT_EQ(refused, 1) << "it is not asked for any more";
}

}  // namespace
}  // namespace phalanx
