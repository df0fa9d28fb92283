// SPDX-License-Identifier: GPL-2.0-or-later
// What the fuzzers of readers share (libFuzzer). A reader takes any bytes whatever: it reads them, or refuses them with
// BadInput, whose text is one line that a terminal can show. Any other exception, a crash, over 2 s or 1 GB is a fault.
//   VIELTO_FUZZ("table.csv") { vielto::read_observations(path); }
// is a program that writes each input to table.csv in a folder of its own in /dev/shm and calls the block.
#pragma once

#include <stdlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/bad_input.h"
#include "core/csv.h"

namespace vielto_fuzz {

// Removed at the end of the program.
class Folder {
 public:
  Folder() {
    char name[] = "/dev/shm/vielto-fuzz-XXXXXX";
    if (!mkdtemp(name)) abort();
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline const Folder& folder() {
  static const Folder folder;
  return folder;
}

inline void write(const std::string& path, const void* data, std::size_t size) {
  std::FILE* out = std::fopen(path.c_str(), "wb");
  if (!out || std::fwrite(data, 1, size, out) != size || std::fclose(out) != 0) abort();
}
inline void write(const std::string& path, const std::string& text) { write(path, text.data(), text.size()); }

// Stops the fuzzer unless `holds`.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fault: %s\n", what);
  abort();
}

template <class Read>
int one(const char* name, const std::uint8_t* data, std::size_t size, Read read) {
  const std::string path = folder().file(name);
  write(path, data, size);
  try {
    read(path);
  } catch (const vielto::BadInput& refusal) {
    demand(vielto::is_plain_utf8(refusal.what()), "the refusal is not one line of plain text");
  }
  return 0;
}

}  // namespace vielto_fuzz

#define VIELTO_FUZZ(name)                                                             \
  static void read_input(const std::string& path);                                    \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    return vielto_fuzz::one(name, data, size, read_input);                            \
  }                                                                                   \
  static void read_input([[maybe_unused]] const std::string& path)
