// SPDX-License-Identifier: GPL-2.0-or-later
#include "core/sha256.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto::gap {

std::string sha256_of_file(const std::string& path) {
  std::string quoted;
  for (const char c : path) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(("sha256sum < '" + quoted + "' 2>/dev/null").c_str(), "r"),
                                                   pclose);
  std::array<char, 128> buffer = {};
  const std::string line =
      pipe && fgets(buffer.data(), static_cast<int>(buffer.size()), pipe.get()) ? buffer.data() : "";
  const std::string hash = line.substr(0, line.find(' '));
  if (hash.size() != 64) throw std::runtime_error(path + ": its SHA-256 cannot be taken; check the file and sha256sum");
  return hash;
}

std::string sha256_of_text(const std::string& text) {
  std::string path = (std::filesystem::temp_directory_path() / "vielto_sha256_XXXXXX").string();
  const int file = mkstemp(path.data());
  const bool written = file >= 0 && write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (file >= 0) close(file);
  if (!written) throw std::runtime_error(path + ": cannot be written; check the space left");
  const std::string hash = sha256_of_file(path);
  std::filesystem::remove(path);
  return hash;
}

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

}  // namespace vielto::gap
