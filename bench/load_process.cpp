// SPDX-License-Identifier: Apache-2.0
#include "load_process.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <system_error>
#include <thread>

#include "cockpit_load.h"

namespace phalanx::bench {
namespace {

constexpr std::uint64_t kHugeBytes = 100'000'000;
constexpr std::size_t kManyConnections = 1000;
constexpr auto kPause = std::chrono::milliseconds(500);

struct Order {
  Load load;
  std::uint16_t port;
};

/// Does it again and again until it goes.
class Again {
 public:
  explicit Again(std::function<void()> once)
      : thread_([once = std::move(once)](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            once();
            std::this_thread::sleep_for(kPause);
          }
        }) {}

 private:
  std::jthread thread_;
};

/// A load as long as it lives.
class Running {
 public:
  explicit Running(Order order) {
    const std::uint16_t port = order.port;
    switch (order.load) {
      case Load::kViewers:
        viewers_ = std::make_unique<CockpitViewers>(port, LoadProcess::kViewerCount);
        break;
      case Load::kStuck:
        stuck_ = std::make_unique<StuckViewer>(port);
        break;
      case Load::kHuge:
        again_ = std::make_unique<Again>([port] { static_cast<void>(send_huge_message(port, kHugeBytes)); });
        break;
      case Load::kConnections:
        again_ =
            std::make_unique<Again>([port] { static_cast<void>(connect_often(port, kManyConnections)); });
        break;
    }
  }
  [[nodiscard]] std::uint64_t messages() const { return viewers_ ? viewers_->counts().messages : 0; }

 private:
  std::unique_ptr<CockpitViewers> viewers_;
  std::unique_ptr<StuckViewer> stuck_;
  std::unique_ptr<Again> again_;
};

template <typename T>
bool send(int socket, const T& value) {
  return ::send(socket, &value, sizeof value, MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof value);
}
template <typename T>
bool receive(int socket, T& value) {
  ssize_t got = 0;
  do {
    got = ::recv(socket, &value, sizeof value, 0);
  } while (got < 0 && errno == EINTR);
  return got == static_cast<ssize_t>(sizeof value);
}

void serve(int socket) {
  Order order{};
  while (receive(socket, order)) {
    const Running running(order);
    char end = 0;
    if (!send(socket, char{1}) || !receive(socket, end) || !send(socket, running.messages())) return;
  }
}

[[noreturn]] void run_child(int socket) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpriority(PRIO_PROCESS, 0, 19);
  try {
    serve(socket);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "load: %s\n", error.what());
    ::_exit(1);
  }
  ::_exit(0);
}

}  // namespace

LoadProcess::LoadProcess() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "socketpair");
  process_ = ::fork();
  if (process_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (process_ == 0) {
    ::close(ends[0]);
    run_child(ends[1]);
  }
  ::close(ends[1]);
  socket_ = ends[0];
}

LoadProcess::~LoadProcess() {
  ::close(socket_);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void LoadProcess::begin(Load load, std::uint16_t port) {
  char on = 0;
  if (!send(socket_, Order{load, port}) || !receive(socket_, on))
    throw std::runtime_error("the process with the clients has ended");
}

std::uint64_t LoadProcess::end() {
  std::uint64_t messages = 0;
  if (!send(socket_, char{1}) || !receive(socket_, messages))
    throw std::runtime_error("the process with the clients has ended");
  return messages;
}

}  // namespace phalanx::bench
