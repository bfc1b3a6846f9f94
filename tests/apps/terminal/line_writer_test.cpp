// SPDX-License-Identifier: Apache-2.0
// Lines that are left out are counted, whatever becomes of those beside them.
#include "terminal/line_writer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <string>

#include "apps/run/running_station.h"
#include "apps/run/starved_thread.h"

namespace phalanx::testing {
namespace {

/// A pipe that holds one page, and what has come out of it.
class Reader {
 public:
  Reader() : ends_(pipe_from_program()) {
    EXPECT_EQ(::fcntl(ends_.theirs.number(), F_SETPIPE_SZ, 4096), 4096);
  }
  [[nodiscard]] int descriptor() const { return ends_.theirs.number(); }
  void wait_for_bytes() const {
    pollfd input{.fd = ends_.ours.number(), .events = POLLIN, .revents = 0};
    EXPECT_EQ(::poll(&input, 1, 240'000), 1);
  }
  /// Reads until these words have come. @returns false: they did not within minutes
  [[nodiscard]] bool reads(const std::string& words) {
    const double give_up = wall_seconds() + 240.0;
    while (text.find(words) == std::string::npos && wall_seconds() < give_up) {
      text += read_waiting(ends_.ours);
      sleep_seconds(0.001);
    }
    return text.find(words) != std::string::npos;
  }

  std::string text;

 private:
  Ends ends_;
};

constexpr const char* kFiveMissing = "(5 lines are missing here: they were not read in time)\n";

// The first line is longer than the pipe holds: it is being written while 1,000 wait.
TEST(LineWriter, SaysThatTheLastLinesWereLeftOut) {
  Reader reader;
  LineWriter out(reader.descriptor());
  out.line(std::string(8000, 'x'));
  reader.wait_for_bytes();
  for (std::size_t i = 0; i < LineWriter::kWaiting + 5; ++i) out.line("line");
  EXPECT_TRUE(reader.reads(kFiveMissing)) << "no later line brings it";
}

// "1 lines": of what there was no memory for.
TEST(LineWriter, CountsALineForWhichThereIsNoMemory) {
  Reader reader;
  LineWriter out(reader.descriptor());
  const std::string text(100, 'x');  // more than a string holds in itself
  out.line("first");
  {
    const StarvedThread starved;
    out.line(text);
  }
  EXPECT_TRUE(reader.reads("first\n(1 lines are missing here: they were not read in time)\n")) << reader.text;
}

}  // namespace
}  // namespace phalanx::testing
