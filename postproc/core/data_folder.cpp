// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/data_folder.h"

#include <stdexcept>

namespace vielto {

namespace fs = std::filesystem;

fs::path data_folder() {
  const fs::path bin = fs::read_symlink("/proc/self/exe").parent_path();
  for (const char* const way : {"../share/vielto", "../..", "../../../share/vielto", "../../../../share/vielto"}) {
    const fs::path folder = (bin / way).lexically_normal();
    if (fs::is_regular_file(folder / "cases/law.par") && fs::is_directory(folder / "materials")) return folder;
  }
  throw std::runtime_error("cases and cards are not beside this program (share/vielto); install vielto again");
}

std::string named_in(const std::string& kind, const std::string& given, const std::string& suffix) {
  if (given.empty() || given.find('/') != std::string::npos || fs::exists(given)) return given;
  try {
    const fs::path path = data_folder() / kind / (given + suffix);
    if (fs::exists(path)) return path.string();
  } catch (const std::runtime_error&) {
  }
  return given;
}

}  // namespace vielto
