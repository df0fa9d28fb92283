// SPDX-License-Identifier: GPL-2.0-or-later
// SHA-256 of a file, by the `sha256sum` of every Debian system. Seals and staleness checks rest on it.
#pragma once

#include <string>

namespace vielto::gap {

// 64 hexadecimal digits. Errors: std::runtime_error if the file cannot be read or sha256sum is missing.
std::string sha256_of_file(const std::string& path);

std::string sha256_of_text(const std::string& text);

// Writes PATH.sha256 beside PATH in the format of `sha256sum -c`.
void seal(const std::string& path);

// False if PATH is not what PATH.sha256 says. Errors: BadInput if there is no seal.
bool seal_holds(const std::string& path);

}  // namespace vielto::gap
