// SPDX-License-Identifier: GPL-2.0-or-later
// A refusal is one line that a terminal can show, whatever bytes the file holds.
#include "core/bad_input.h"

#include <gtest/gtest.h>

#include "core/csv.h"

using vielto::BadInput;
using vielto::is_plain_utf8;

TEST(BadInput, NamesPlaceFaultAndMend) {
  EXPECT_STREQ(BadInput("a.csv", 3, "value", "'x' is no number", "write one").what(),
               "a.csv, line 3, column value: 'x' is no number; write one");
  EXPECT_STREQ(BadInput("a.csv", 0, "is empty", "fill it").what(), "a.csv: is empty; fill it");
}

TEST(BadInput, QuotesBytesThatAreNoText) {
  const std::string quoted = BadInput("a\n.csv", 1, "'\x1b[2J\xff\xc3\xa9\xe4'", "mend it\r").what();
  EXPECT_EQ(quoted, "a\\x0a.csv, line 1: '\\x1b[2J\\xff\xc3\xa9\\xe4'; mend it\\x0d");
  EXPECT_TRUE(is_plain_utf8(quoted));
}

// RFC 3629, section 3: no longer form than needed, no half of a UTF-16 pair, nothing beyond U+10FFFF.
TEST(PlainUtf8, IsThatOfRfc3629) {
  for (const char* good : {"", "plain", "\xc3\xa9", "\xe2\x82\xac", "\xed\x9f\xbf", "\xee\x80\x80", "\xf0\x90\x80\x80",
                           "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(is_plain_utf8(good)) << good;
  for (const char* bad :
       {"\n", "\x7f", "\x80", "\xc0\xaf", "\xc1\xbf", "\xc3", "\xc3(", "\xe0\x80\x80", "\xe0\x9f\xbf", "\xed\xa0\x80",
        "\xed\xbf\xbf", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82"})
    EXPECT_FALSE(is_plain_utf8(bad)) << bad;
}
