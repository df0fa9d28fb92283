// SPDX-License-Identifier: GPL-2.0-or-later
#include "picture/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/program.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

constexpr double kSeconds = 4;  // of a film
constexpr double kSlowest = 6;  // pictures a second
constexpr const char* kWidth = "960";

// % in a name would be taken for a number by ffmpeg.
std::string literal(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '%' ? std::string("%%") : std::string(1, c);
  return out;
}

}  // namespace

void need_film_program() {
  if (run_program({"ffmpeg", "-version"}, {"", "/dev/null"}) != 0)
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
  // file: what stands before a name that is none of ffmpeg's protocols
  if (run_program({"ffmpeg",
                   "-nostdin",
                   "-loglevel",
                   "error",
                   "-y",
                   "-framerate",
                   fmt::format("{:.3f}", rate),
                   "-i",
                   "file:" + literal(folder_) + "/%05d.png",
                   "-vf",
                   fmt::format("scale={}:-2", kWidth),
                   "-c:v",
                   "libvpx-vp9",
                   "-crf",
                   "36",
                   "-b:v",
                   "0",
                   "-pix_fmt",
                   "yuv420p",
                   "-an",
                   "-f",
                   "webm",
                   "file:" + partial}) != 0) {
    fs::remove(partial);
    throw std::runtime_error(path_ + ": ffmpeg could not join the pictures; its message stands above");
  }
  fs::rename(partial, path_);
}

}  // namespace vielto
