// SPDX-License-Identifier: GPL-2.0-or-later
// A film from pictures, joined by ffmpeg (a Debian package): WebM with VP9,
// which every browser plays.
#pragma once

#include <string>

namespace vielto {

// Errors: BadInput if there is no ffmpeg.
void need_film_program();

class Film {
 public:
  explicit Film(const std::string& path);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  // Where the next picture (PNG) is to be written.
  std::string next_frame();
  // Joins the pictures: PATH.partial, then renamed. Errors: std::runtime_error
  // if ffmpeg fails.
  void finish();

 private:
  std::string path_, folder_;
  int frames_ = 0;
};

}  // namespace vielto
