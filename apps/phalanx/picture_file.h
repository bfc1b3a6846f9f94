// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "phalanx/figures/picture.h"
#include "phalanx/record/output_file.h"

namespace phalanx {

/// Writes a PNG file, of which there is all or nothing. @throws as write_png() and write_then_rename()
inline void save_picture(const Image& image, const std::filesystem::path& file) {
  write_then_rename(file, [&](const std::filesystem::path& partial) { write_png(image, partial); });
}

}  // namespace phalanx
