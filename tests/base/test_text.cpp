// Quoting of text that comes from files (base/text.hpp).
#include "base/text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace odobench {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(Text, OrdinaryTextStays) {
  for (const char* text :
       {"", "abc", "r\u00f6bot \u03c3\u00b2 \u2192 \u4f60\u597d \U0001f916", "a\u200cb", "~ \\n"})
    EXPECT_EQ(printable(text), text);
}

TEST(Text, WhatSteersATerminalIsEscaped) {
  EXPECT_EQ(printable("a\x1b[31mb"), "a\\x1b[31mb");
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\u009b"), "\\x9b");  // one character that begins a control sequence
  EXPECT_EQ(printable("\u202eabc"), "\\u202eabc");
  EXPECT_EQ(printable("\u2066\u2069\ufeff\u200b"), "\\u2066\\u2069\\ufeff\\u200b");
  EXPECT_EQ(printable("\U000e0041"), "\\U000e0041");
}

TEST(Text, BytesThatAreNoUtf8AreShownAsBytes) {
  EXPECT_EQ(printable("a\xff\xfe"), "a\\xff\\xfe");
  EXPECT_EQ(printable("\xc3"), "\\xc3");                             // cut off
  EXPECT_EQ(printable("\xc0\x80"), "\\xc0\\x80");                    // overlong
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");           // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  EXPECT_FALSE(is_valid_utf8("\xf4\x90\x80\x80"));
  EXPECT_FALSE(is_valid_utf8(std::string_view("\u00e4").substr(0, 1)));  // the rest lies behind the end
  EXPECT_EQ(printable(std::string_view("\u20ac").substr(0, 2)), "\\xe2\\x82");
  for (int first = 0; first < 256; ++first)
    for (int second = 0; second < 256; ++second) {
      const std::string text{static_cast<char>(first), static_cast<char>(second)};
      EXPECT_TRUE(is_valid_utf8(printable(text))) << first << " " << second;
    }
}

std::string utf8(char32_t c) {
  if (c < 0x80) return {static_cast<char>(c)};
  if (c < 0x800) return {static_cast<char>(0xC0 | c >> 6), static_cast<char>(0x80 | (c & 0x3F))};
  if (c < 0x10000)
    return {static_cast<char>(0xE0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 0x3F)),
            static_cast<char>(0x80 | (c & 0x3F))};
  return {static_cast<char>(0xF0 | c >> 18), static_cast<char>(0x80 | (c >> 12 & 0x3F)),
          static_cast<char>(0x80 | (c >> 6 & 0x3F)), static_cast<char>(0x80 | (c & 0x3F))};
}

TEST(Text, EveryCharacterOfUnicodeIsOne) {
  for (const char32_t c :
       {0x20u, 0x7Eu, 0x80u, 0x7FFu, 0x800u, 0xD7FFu, 0xE000u, 0xFFFFu, 0x10000u, 0x10FFFFu}) {
    const CodePoint found = code_point_at("x" + utf8(c) + "x", 1);
    EXPECT_TRUE(found.valid) << std::hex << static_cast<unsigned>(c);
    EXPECT_EQ(found.value, c);
    EXPECT_EQ(found.bytes, utf8(c).size());
  }
  for (const char32_t c : {0xD800u, 0xDFFFu, 0x110000u}) {
    EXPECT_FALSE(is_valid_utf8(utf8(c))) << std::hex << static_cast<unsigned>(c);
    EXPECT_EQ(code_point_at(utf8(c), 0).bytes, 1u);
  }
  EXPECT_EQ(printable("\xe4\xbd"), "\\xe4\\xbd");                    // cut off
  EXPECT_EQ(printable("\xe4\xbdx"), "\\xe4\\xbdx");                  // a letter where a byte is missing
  EXPECT_EQ(printable("\xf0\x80\x80\x80"), "\\xf0\\x80\\x80\\x80");  // overlong
}

TEST(Text, HiddenCharactersEndWhereTheyEnd) {
  for (const auto& [first, last] : std::vector<std::pair<unsigned, unsigned>>{{0x7F, 0x9F},
                                                                              {0xAD, 0xAD},
                                                                              {0x61C, 0x61C},
                                                                              {0x180E, 0x180E},
                                                                              {0x200B, 0x200B},
                                                                              {0x200E, 0x200F},
                                                                              {0x2028, 0x202E},
                                                                              {0x2060, 0x206F},
                                                                              {0xFEFF, 0xFEFF},
                                                                              {0xFFF0, 0xFFFB},
                                                                              {0xE0000, 0xE0FFF}}) {
    for (const char32_t c : {first, last}) EXPECT_NE(printable(utf8(c)), utf8(c)) << std::hex << first;
    for (const char32_t c : {first - 1, last + 1})
      EXPECT_EQ(printable(utf8(c)), utf8(c)) << std::hex << first;
  }
  EXPECT_EQ(printable("\x1f "), "\\x1f ");
}

TEST(Text, QuotesAreOfBoundedLength) {
  EXPECT_EQ(shown(std::string(80, 'x')), std::string(80, 'x'));
  EXPECT_EQ(shown(std::string(81, 'x')), std::string(77, 'x') + "...");
  const std::string million = shown(std::string(1 << 20, 'x'));
  EXPECT_EQ(million.size(), 80u);
  std::string umlauts;
  for (int i = 0; i < 100; ++i) umlauts += "\u00e4";
  EXPECT_EQ(shown(umlauts).size(), 2u * 77 + 3);  // characters, not bytes
  const std::string escaped = shown(std::string(100, '\x01'));
  EXPECT_EQ(escaped.size(), 4u * 19 + 3);
  EXPECT_THAT(escaped, EndsWith("\\x01..."));  // no escape is cut in the middle
  EXPECT_EQ(shown("123456789", 8), "12345...");
  EXPECT_EQ(shown("123456789", 3), "12345...");  // at least 8
  EXPECT_EQ(shown("12345678", 8), "12345678");
  EXPECT_EQ(shown("\U000e0041", 8), "...");
}

TEST(Text, MessagesAreOneLineOfBoundedLength) {
  EXPECT_EQ(one_line_message("a\nb"), "a b");
  EXPECT_EQ(one_line_message(std::string(2000, 'x')), std::string(2000, 'x'));
  const std::string message =
      one_line_message("set.json:3: found " + std::string(1 << 20, '\x1b') + ", expected 5");
  EXPECT_LE(message.size(), 2000u);
  // The first 1,496 characters and the last 500, of which those of a long text are looked for near its end.
  const auto all = [](std::size_t n, char c) { return std::string(n, c); };
  EXPECT_EQ(one_line_message(all(2001, 'x')), all(1496, 'x') + "... " + all(500, 'x'));
  EXPECT_EQ(one_line_message(all(8000, 'a') + all(2000, 'b')), all(1496, 'a') + "... " + all(500, 'b'));
  EXPECT_EQ(one_line_message(all(8000, 'a') + "b"), all(1496, 'a') + "... b");
  EXPECT_EQ(one_line_message(all(9000, 'a') + "\n" + all(499, 'b')),
            all(1496, 'a') + "...  " + all(499, 'b'));
  EXPECT_THAT(message, StartsWith("set.json:3: found \\x1b"));
  EXPECT_THAT(message, EndsWith(", expected 5"));
  EXPECT_THAT(one_line_message(std::string(3000, 'x') + "\u00e4"), EndsWith("x\u00e4"));
  for (std::size_t n = 1990; n < 2010; ++n) {
    std::string text;
    for (std::size_t k = 0; k < n; ++k) text += "\u20ac";
    EXPECT_TRUE(is_valid_utf8(one_line_message(text))) << n;
  }
}

TEST(Text, JsonStaysTheSameDocument) {
  const nlohmann::json given = {{"a\u202e", "\u009b\x7f\U000e0041\u03c3"}, {"b", 1.5}};
  const std::string text = safe_json(given.dump(1));
  EXPECT_EQ(nlohmann::json::parse(text), given);
  EXPECT_THAT(text, HasSubstr("\\u202e"));
  EXPECT_THAT(text, HasSubstr("\\u009b\\u007f\\udb40\\udc41"));
  EXPECT_EQ(safe_json("\"\U000e0fff\ufffc\u00a0\""), "\"\\udb43\\udfff\ufffc\u00a0\"");
  EXPECT_THAT(text, HasSubstr("\u03c3"));
  EXPECT_THAT(text, Not(HasSubstr("\u009b")));
  EXPECT_THAT(text, Not(HasSubstr("\x7f")));
}

}  // namespace
}  // namespace odobench
