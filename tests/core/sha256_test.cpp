// SPDX-License-Identifier: GPL-2.0-or-later
// SHA-256 against the values of the standard (FIPS 180-4 and the NIST examples of it), of texts and of files.
#include "core/sha256.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;

const char* const kOfNothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
const char* const kOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
const char* const kOfMillionA = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(Sha256, OfTheStandardsTexts) {
  EXPECT_EQ(vielto::sha256_of_text(""), kOfNothing);
  EXPECT_EQ(vielto::sha256_of_text("abc"), kOfAbc);
  EXPECT_EQ(vielto::sha256_of_text("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(vielto::sha256_of_text(std::string(1000000, 'a')), kOfMillionA);
}

// Longer than a buffer, empty, and under a name that a shell would take apart.
TEST(Sha256, OfFiles) {
  const fs::path folder = fs::temp_directory_path() / ("vielto sha256 '$(x)' " + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "a") << std::string(1000000, 'a');
  std::ofstream(folder / "none");
  EXPECT_EQ(vielto::sha256_of_file((folder / "a").string()), kOfMillionA);
  EXPECT_EQ(vielto::sha256_of_file((folder / "none").string()), kOfNothing);
  EXPECT_THROW(vielto::sha256_of_file((folder / "missing").string()), std::runtime_error);
  EXPECT_THROW(vielto::sha256_of_file(folder.string()), std::runtime_error);
  fs::remove_all(folder);
}

}  // namespace
