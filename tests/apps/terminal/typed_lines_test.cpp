// SPDX-License-Identifier: Apache-2.0
// `stop` as it is typed in a hurry.
#include "terminal/typed_lines.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "apps/run/running_station.h"
#include "apps/run/starved_thread.h"

namespace phalanx::testing {
namespace {

class TypedLinesTest : public ::testing::Test {
 protected:
  TypedLinesTest() : kept_(::dup(STDIN_FILENO)) {
    SessionSettings settings;
    settings.device = "sliders";
    settings.ask_for_realtime = false;
    session = std::make_unique<Session>(settings, clock_);
  }
  ~TypedLinesTest() override {
    if (kept_ < 0) return;
    ::dup2(kept_, STDIN_FILENO);
    ::close(kept_);
  }
  /// Types it at a new standard input, which then ends.
  void type(const std::string& text) {
    typed.reset();  // a reader that has not seen the end of its input must not read the new one
    Ends input = pipe_to_program();
    ::dup2(input.theirs.number(), STDIN_FILENO);
    typed = std::make_unique<TypedLines>(*session);
    write_text(input.ours, text);
  }
  /// @returns false: it was not so within minutes
  [[nodiscard]] static bool eventually(const std::function<bool()>& so) {
    const double give_up = wall_seconds() + 240.0;
    while (!so()) {
      if (wall_seconds() > give_up) return false;
      sleep_seconds(0.001);
    }
    return true;
  }
  /// The next line, once it has come.
  [[nodiscard]] std::string line() const {
    std::string text = "none came";
    static_cast<void>(eventually([&] {
      const auto next = typed->next();
      if (next) text = next->text;
      return next.has_value();
    }));
    return text;
  }

  std::unique_ptr<Session> session;
  std::unique_ptr<TypedLines> typed;

 private:
  const Clock clock_;
  int kept_;
};

TEST_F(TypedLinesTest, StopActsInCapitalsAmongBlanksAndWithoutALineFeedAtTheEndOfTheInput) {
  for (const std::string text : {"STOP\n", "sToP\n", "  stop\n", "\t stop \t\r\n", "stop", " Stop "}) {
    const std::uint64_t before = session->stops();
    type(text);
    EXPECT_EQ(line(), "stop") << '"' << text << '"';
    EXPECT_EQ(session->stops(), before + 1) << '"' << text << '"';
    EXPECT_TRUE(session->held_stopped());
  }
}

// An owner that sees the stop without its line would bring the forces back.
TEST_F(TypedLinesTest, TheLineOfAStopIsThereAsSoonAsItsEffect) {
  for (int i = 0; i < 200; ++i) {
    const std::uint64_t before = session->stops();
    type("stop\n");
    const double give_up = wall_seconds() + 240.0;
    while (session->stops() == before && wall_seconds() < give_up) {
    }
    ASSERT_TRUE(typed->next().has_value()) << i;
  }
}

TEST_F(TypedLinesTest, NothingElseIsAStop) {
  for (const std::string text : {"stopp\n", "sto\n", "s top\n", "set stop\n", "resume\n", "3TOP\n"}) {
    type(text);
    EXPECT_NE(line(), "stop") << text;
    EXPECT_EQ(session->stops(), 0U) << text;
  }
}

// Each line wakes both readers; the one that comes second finds nothing and must not wait for more.
TEST_F(TypedLinesTest, AnotherReaderOfTheSameInputHangsNothing) {
  const Ends input = pipe_to_program();
  ::dup2(input.theirs.number(), STDIN_FILENO);
  typed = std::make_unique<TypedLines>(*session);
  const Descriptor other(::open("/proc/self/fd/0", O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  ASSERT_GE(other.number(), 0);
  std::array<char, 16> taken;
  std::size_t lines = 0;
  for (int i = 0; i < 2000; ++i) {
    write_text(input.ours, "hello\n");
    while (::read(other.number(), taken.data(), taken.size()) > 0) ++lines;
  }
  EXPECT_GT(lines, 0U);
  typed.reset();
  EXPECT_EQ(::fcntl(STDIN_FILENO, F_GETFL) & O_NONBLOCK, 0) << "the flag is shared with the shell";
}

// Nothing is known of the line then, and it may have been `stop`.
TEST_F(TypedLinesTest, ALineForWhichThereIsNoMemoryStops) {
  const StarvedThread starved("phalanx-typed");
  type("set force.stiffness_n_per_mm=0.9 # a line that is long enough to need memory\n");
  EXPECT_TRUE(eventually([&] { return session->stops() == 1; }));
  EXPECT_TRUE(eventually([&] { return typed->take_left_out() == 1; })) << "its owner is told";
}

}  // namespace
}  // namespace phalanx::testing
