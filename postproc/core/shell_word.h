// SPDX-License-Identifier: GPL-2.0-or-later
// A word of a command line that people copy: in quotes if a shell would not read it back as it is.
#pragma once

#include <string>

namespace vielto {

std::string shell_word(const std::string& word);

}  // namespace vielto
