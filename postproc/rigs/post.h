// SPDX-License-Identifier: GPL-2.0-or-later
// What is made of a run's record, in one form for all rigs: RUN/post with observations.csv, table.txt, the rig's result
// file (core/rig_table.h), further tables and pictures.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/observation_table.h"
#include "core/rig_table.h"
#include "core/steady_part.h"

namespace vielto {

struct PostInput {
  std::string record;
  std::string idle;  // record of the empty machine, for a rig that takes one; may be empty
  int turns = 0;     // steady ones asked for; 0: as many as an average needs
  TestLabel label;

  // The run folder. Empty: where the program was started.
  std::string run() const;
  // The label, named `test` if it has no name.
  TestLabel label_or(const std::string& test) const;
};

struct PostFile {
  std::string name, text;
};

struct PostPicture {
  std::string name;
  std::function<void(const std::string& path)> draw;
};

struct PostResult {
  std::vector<Observation> rows;
  std::string table;  // for people
  nlohmann::ordered_json numbers;
  std::vector<PostFile> files;
  std::vector<PostPicture> pictures;
  std::function<void(const std::string& path)> film;  // of the grains (rigs/rig_picture.h)
  std::vector<std::string> warnings;

  std::string numbers_text() const { return numbers.dump(2) + "\n"; }
};

// Writes `folder`, the pictures too if asked for. What may still be refused (BadInput) comes first.
void write_post(const PostResult& result, const RigDescription& rig, const std::string& folder, bool pictures);

}  // namespace vielto
