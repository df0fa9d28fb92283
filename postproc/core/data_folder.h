// SPDX-License-Identifier: GPL-2.0-or-later
// Where cases, cards and libraries lie beside the running program.
#pragma once

#include <filesystem>
#include <string>

namespace vielto {

// The folder that holds cases/, materials/ and libraries/: PREFIX/share/vielto of an installed program, the repository
// of one that lies in its build folder. Nothing is compiled in, so that a prefix may be moved.
// Errors: std::runtime_error if neither is there.
std::filesystem::path data_folder();

// `given` if it exists or has a path's form (a '/' in it); otherwise the file or folder KIND/given[suffix] of
// data_folder() if that exists, or else `given`. So `--library millet` and `--material hulled_millet` find what came
// with the program.
std::string named_in(const std::string& kind, const std::string& given, const std::string& suffix = "");

}  // namespace vielto
