// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/seal.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/sha256.h"

namespace vielto {

void seal(const std::string& path) {
  write_whole_file(path + ".sha256",
                   fmt::format("{}  {}\n", sha256_of_file(path), std::filesystem::path(path).filename().string()));
}

bool seal_holds(const std::string& path) {
  std::ifstream in(path + ".sha256");
  std::string hash;
  if (!(in >> hash)) throw BadInput(path + ".sha256", 0, "cannot be read", "seal the file first");
  return hash == sha256_of_file(path);
}

}  // namespace vielto
