// SPDX-License-Identifier: GPL-2.0-or-later
#include "picture/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "core/bad_input.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

constexpr double kSeconds = 4;  // of a film
constexpr double kSlowest = 6;  // pictures a second
constexpr const char* kWidth = "960";

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

void need_film_program() {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0)
    throw BadInput("ffmpeg", 0, "is not there: it joins the pictures of a film", "install the package ffmpeg");
}

Film::Film(const std::string& path) : path_(path), folder_(path + ".partial.frames") {
  fs::remove_all(folder_);
  fs::create_directories(folder_);
}

Film::~Film() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string Film::next_frame() { return fmt::format("{}/{:05d}.png", folder_, frames_++); }

void Film::finish() {
  const double rate = std::max(kSlowest, frames_ / kSeconds);
  const std::string partial = path_ + ".partial";
  const std::string command = fmt::format(
      "ffmpeg -nostdin -loglevel error -y -framerate {:.3f} -i {} "
      "-vf scale={}:-2 -c:v libvpx-vp9 -crf 36 -b:v 0 -pix_fmt "
      "yuv420p -an -f webm {}",
      rate, quoted(folder_ + "/%05d.png"), kWidth, quoted(partial));
  if (std::system(command.c_str()) != 0) {
    fs::remove(partial);
    throw std::runtime_error(path_ + ": ffmpeg could not join the pictures; its message stands above");
  }
  fs::rename(partial, path_);
}

}  // namespace vielto
