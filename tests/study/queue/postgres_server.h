// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <soci/postgresql/soci-postgresql.h>
#include <soci/soci.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "record/temporary_folder.h"

namespace phalanx::testing {

/// A server of PostgreSQL in a folder of its own, on a socket in that folder alone. It runs as an ordinary user: as
/// user 65534 if the test runs as root, as whom PostgreSQL refuses to run.
class PostgresServer {
 public:
  /// @returns the folder of the programs of PostgreSQL 15; empty: PostgreSQL is not installed.
  static std::filesystem::path programs() {
    for (const char* folder : {"/usr/lib/postgresql/15/bin", "/usr/local/bin", "/usr/bin"}) {
      if (std::filesystem::exists(std::filesystem::path(folder) / "initdb")) return folder;
    }
    return {};
  }

  PostgresServer() {
    if (::geteuid() == 0 && ::chown(folder_.path().c_str(), kNobody, kNobody) != 0)
      throw std::runtime_error("the folder of the server cannot be given to an ordinary user");
    const pid_t initdb = begin(
        {"initdb", "-D", data(), "-U", "phalanx", "-A", "trust", "--no-sync", "--locale=C", "-E", "UTF8"});
    int status = -1;
    ::waitpid(initdb, &status, 0);
    if (status != 0) throw std::runtime_error("initdb failed:\n" + read_file(folder_ / "log"));
    start();
  }
  ~PostgresServer() { stop(); }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  void start() {
    for (int tries = 0; tries < 6000; ++tries) {
      int status = 0;
      if (server_ < 0 || ::waitpid(server_, &status, WNOHANG) == server_)  // a killed one may still be there
        server_ =
            begin({"postgres", "-D", data(), "-k", folder_.path().string(), "-c", "listen_addresses=", "-F"});
      try {
        soci::session(soci::postgresql, url());
        return;
      } catch (const soci::soci_error&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
    throw std::runtime_error("the server did not start:\n" + read_file(folder_ / "log"));
  }
  /// Ends it as a failure of its machine does.
  void stop() {
    if (server_ < 0) return;
    ::kill(server_, SIGQUIT);
    ::waitpid(server_, nullptr, 0);
    server_ = -1;
  }

  [[nodiscard]] std::string url() const {
    return "postgresql://phalanx@/postgres?host=" + folder_.path().string();
  }

 private:
  static constexpr unsigned kNobody = 65534;

  [[nodiscard]] std::string data() const { return (folder_ / "data").string(); }

  [[nodiscard]] pid_t begin(std::vector<std::string> command) const {
    const std::string program = (programs() / command.front()).string();
    const std::string log = (folder_ / "log").string();
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process != 0) return process;
    if (::geteuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) ::_exit(126);
    ::prctl(PR_SET_PDEATHSIG, SIGQUIT);  // after the change of user, which would undo it
    if (::getppid() != parent) ::_exit(126);
    const int written = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    ::dup2(written, STDOUT_FILENO);
    ::dup2(written, STDERR_FILENO);
    std::vector<char*> arguments;
    for (std::string& argument : command) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    ::execv(program.c_str(), arguments.data());
    ::_exit(127);
  }

  TemporaryFolder folder_;
  pid_t server_ = -1;
};

}  // namespace phalanx::testing
