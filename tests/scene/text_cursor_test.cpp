#include "model/scene/text_cursor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/base/error.h"

namespace ctu::scene::test {
namespace {

TEST(ParseNumber, takes_whole_words_only) {
  float value = 0;
  EXPECT_TRUE(parse_number("+1.5", value));
  EXPECT_EQ(value, 1.5f);
  EXPECT_TRUE(parse_number("-.25e1", value));
  EXPECT_EQ(value, -2.5f);
  EXPECT_TRUE(parse_number("1e+006", value));
  EXPECT_EQ(value, 1e6f);
  for (const char* word : {"", "+", "-", "1.5x", "++1", "+-1x", "nan", "inf", "-infinity", "1e39", "0x1p3", "1,5"})
    EXPECT_FALSE(parse_number(word, value)) << word;
}

TEST(ParseNumber, too_small_becomes_zero_of_its_sign_and_subnormals_stay) {
  float value = 1;
  for (const char* word : {"1e-60", "0.00000000000000000000000000000000000000000000000000001", "123e-70"}) {
    EXPECT_TRUE(parse_number(word, value)) << word;
    EXPECT_EQ(value, 0);
    EXPECT_FALSE(std::signbit(value));
  }
  EXPECT_TRUE(parse_number("-1e-60", value));
  EXPECT_TRUE(std::signbit(value));
  EXPECT_TRUE(parse_number("1e-45", value));
  EXPECT_EQ(value, std::nextafter(0.0f, 1.0f));
  double wide = 1;
  EXPECT_TRUE(parse_number("1e-400", wide));
  EXPECT_EQ(wide, 0);
  EXPECT_FALSE(parse_number("1e400", wide));
  EXPECT_FALSE(parse_number(std::string(400, '9'), wide));
}

TEST(TextCursor, says_the_line_of_the_word_that_is_wrong) {
  const SourceFile file{"a.txt", "", "one # two\n\n 3 x"};
  TextCursor text(file, '#');
  EXPECT_EQ(text.word("a word"), "one");
  EXPECT_EQ(text.integer("a number"), 3);
  try {
    text.number("a coordinate");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "a.txt:3");
    EXPECT_EQ(error.problem(), "'x' is not a finite binary32 number, where a coordinate should be");
  }
  EXPECT_THROW(text.word("more"), Error);
}

}  // namespace
}  // namespace ctu::scene::test
