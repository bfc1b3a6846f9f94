// SPDX-License-Identifier: Apache-2.0
// A counter of opened files, and a scene whose files are all in one folder.
#pragma once

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <system_error>

namespace phalanx::test {

/// Counter of how often any process opens each file of a folder.
class OpenedFiles {
 public:
  explicit OpenedFiles(const std::filesystem::path& folder)
      : events_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    // With the closes between them, no two opens of the same file are joined into one event.
    if (events_ < 0 || ::inotify_add_watch(events_, folder.c_str(), IN_OPEN | IN_CLOSE) < 0)
      throw std::system_error(errno, std::generic_category(), "inotify");
  }
  ~OpenedFiles() { ::close(events_); }
  OpenedFiles(const OpenedFiles&) = delete;
  OpenedFiles& operator=(const OpenedFiles&) = delete;

  /// @returns the counts since the last call, by name.
  [[nodiscard]] std::map<std::string, int> take() const {
    std::map<std::string, int> count;
    alignas(inotify_event) std::array<char, 4096> buffer;
    for (;;) {
      const ssize_t size = ::read(events_, buffer.data(), buffer.size());
      if (size <= 0) return count;
      for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
        const auto* event = reinterpret_cast<const inotify_event*>(&buffer[at]);
        if ((event->mask & IN_OPEN) != 0 && event->len > 0) ++count[event->name];
        at += sizeof(inotify_event) + event->len;
      }
    }
  }

 private:
  int events_;
};

/// Writes the scene first_touch with capsules, and its hand, device and patient, into `folder`.
/// @returns its path
inline std::string write_first_touch(const std::filesystem::path& folder) {
  const std::filesystem::path source = PHALANX_SOURCE_DIR;
  std::filesystem::copy_file(source / "assets/hands/adult.toml", folder / "hand.toml");
  std::filesystem::copy_file(source / "assets/devices/beihang.toml", folder / "device.toml");
  std::filesystem::copy_file(source / "assets/patients/adult.toml", folder / "patient.toml");
  std::ifstream in(source / "scenes/first_touch.toml");
  std::stringstream text;
  text << in.rdbuf();
  std::string scene = text.str();
  const std::string planned = "type = \"sphere\"";  // this hand's meshes would need another plan
  scene.replace(scene.find(planned), planned.size(), "type = \"none\"");
  const auto add = [&](const std::string& table, const std::string& lines) {
    const std::size_t at = scene.find("\n" + table);
    EXPECT_NE(at, std::string::npos) << table;
    if (at != std::string::npos) scene.insert(scene.find('\n', at + 1) + 1, lines);
  };
  add("[hand]", "file = \"hand.toml\"\nmeshes = \"capsules\"\n");
  add("[patient]", "file = \"patient.toml\"\n");
  const std::string file = folder / "scene.toml";
  std::ofstream(file) << scene << "\n[device]\nfile = \"device.toml\"\n";
  return file;
}

}  // namespace phalanx::test
