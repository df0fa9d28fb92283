// SPDX-License-Identifier: GPL-2.0-or-later
// What `vielto post` does with the record of each rig; post_command.cpp holds the options and tells the rigs apart.
#pragma once

#include <filesystem>
#include <string>

#include "core/observation_table.h"
#include "core/steady_part.h"

namespace vielto {

struct PostOptions {
  std::string run, idle;
  int turns = kLeastAveragedTurns;
  bool json = false, pictures = false;
  TestLabel label{"", "fit", "", {}};
};

// A run folder stands for the record in it: torque.csv, shear.csv, heap.csv or bed_1.csv.
std::filesystem::path record_path(const std::string& run);

void post_mixer(const std::filesystem::path& record, const PostOptions& options);
void post_shear(const std::filesystem::path& record, const PostOptions& options);
void post_drum(const std::filesystem::path& record, const PostOptions& options);
void post_repose(const std::filesystem::path& record, const PostOptions& options);

}  // namespace vielto
