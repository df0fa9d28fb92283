// SPDX-License-Identifier: GPL-2.0-or-later
// SHA-256, by OpenSSL's libcrypto. Seals and staleness checks rest on it.
#pragma once

#include <string>
#include <string_view>

namespace vielto {

// 64 hexadecimal digits. Errors: std::runtime_error if the file cannot be read.
std::string sha256_of_file(const std::string& path);

std::string sha256_of_text(std::string_view text);

}  // namespace vielto
