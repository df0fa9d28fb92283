// SPDX-License-Identifier: GPL-2.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "core/bad_input.h"
#include "core/data_folder.h"
#include "core/shell_word.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

// What a user works with; in a repository the rest stays there.
constexpr const char* kParts[] = {
    "cases",   "materials", "libraries",           "studies",
    "scripts", "tools",     "liggghts_addons/law", "liggghts_addons/plugin/laws"};  // libraries hash the laws

// What runs have left in a repository.
bool is_left_over(const fs::path& path) {
  const std::string name = path.filename().string();
  return name == "results" || name == "__pycache__" || name == "log.liggghts";
}

void copy_tree(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
    if (is_left_over(entry.path())) continue;
    const fs::path there = to / entry.path().filename();
    if (entry.is_directory())
      copy_tree(entry.path(), there);
    else
      fs::copy_file(entry.path(), there);
  }
}

void copy(const std::string& folder) {
  if (fs::exists(folder)) throw BadInput(folder, 0, "is there already", "name a folder that is to be made");
  const fs::path source = data_folder(), partial = folder + ".partial";
  std::error_code ignored;
  try {
    fs::remove_all(partial);
    for (const char* const part : kParts)
      if (fs::is_directory(source / part)) copy_tree(source / part, partial / part);
    fs::rename(partial, folder);
  } catch (const fs::filesystem_error& error) {
    fs::remove_all(partial, ignored);
    throw BadInput(folder, 0, fmt::format("cannot be made ({})", error.code().message()),
                   "name a folder that can be written, with 5 MB left");
  }
  // installed, our program has a name of its own (cmake/Install.cmake)
  const bool repository = fs::exists(source / "CMakeLists.txt");
  fmt::print("cases, cards, libraries and studies: {}\nfirst run: cd {} && {} -in in.mixer -var run results/first\n",
             folder, shell_word(folder + "/cases/mixer"), repository ? "liggghts" : "liggghts-vielto");
}

}  // namespace

void add_copy_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("copy", "a working copy of the cases, cards, libraries and studies");
  command->footer(
      "Input scripts read files beside them (../law.par, ../../materials), and runs are written beside them: work in "
      "a\n"
      "copy. scripts/campaign and the others of scripts/ work in it too.\n\n"
      "  vielto copy mixing && cd mixing/cases/mixer && liggghts-vielto -in in.mixer\n\n"
      "In a repository, not installed, the program is build/bin/liggghts.");
  const auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "folder to be made")->required();
  command->callback([folder] { copy(*folder); });
}

}  // namespace vielto
