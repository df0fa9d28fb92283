// SPDX-License-Identifier: GPL-2.0-or-later
// A seal: the SHA-256 of a file, taken before something else is known, so that a later change shows.
#pragma once

#include <string>

namespace vielto {

// Writes PATH.sha256 beside PATH in the format of `sha256sum -c`.
void seal(const std::string& path);

// False if PATH is not what PATH.sha256 says. Errors: BadInput if there is no seal.
bool seal_holds(const std::string& path);

}  // namespace vielto
