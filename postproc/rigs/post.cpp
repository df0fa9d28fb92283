// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/post.h"

#include <filesystem>

#include "core/csv.h"

namespace vielto {

namespace fs = std::filesystem;

std::string PostInput::run() const { return fs::path(record).parent_path().string(); }

TestLabel PostInput::label_or(const std::string& test) const {
  TestLabel named = label;
  if (named.test.empty()) named.test = test;
  return named;
}

void write_post(const PostResult& result, const RigDescription& rig, const std::string& folder, bool pictures) {
  fs::create_directories(folder);
  const auto path = [&](const std::string& name) { return (fs::path(folder) / name).string(); };
  write_observations(path("observations.csv"), result.rows);
  for (const PostFile& file : result.files) write_whole_file(path(file.name), file.text);
  write_whole_file(path("table.txt"), result.table);
  write_whole_file(path(rig.result), result.numbers_text());
  if (!pictures) return;
  for (const PostPicture& picture : result.pictures) picture.draw(path(picture.name));
}

}  // namespace vielto
