// Sections of Markdown pages that programs write.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "model/base/error.h"
#include "sim/paper/page_section.h"
#include "tests/sim/program.h"

namespace ctu::sim::paper {
namespace {

using test::read_text;

class PageSection : public testing::Test {
 protected:
  PageSection() : page_((folder_.path() / "page.md").string()) {
    test::write_text(page_,
                     "before\n<!-- begin: a -->\nold\n<!-- end: a -->\nbetween\n<!-- begin: b -->\n<!-- end: b -->\n"
                     "<!-- end: c -->\n<!-- begin: c -->\nafter\n");
  }
  test::ScratchFolder folder_;
  std::string page_;
};

TEST_F(PageSection, a_section_is_replaced_and_nothing_else) {
  put_section(page_, "a", "new\n");
  put_section(page_, "b", "first\n");
  put_section(page_, "a", "newer\n");
  EXPECT_EQ(read_text(page_),
            "before\n<!-- begin: a -->\n\nnewer\n\n<!-- end: a -->\nbetween\n<!-- begin: b -->\n\nfirst\n\n"
            "<!-- end: b -->\n<!-- end: c -->\n<!-- begin: c -->\nafter\n");
}

TEST_F(PageSection, a_page_without_the_section_or_with_its_end_first_is_refused_and_kept) {
  const std::string before = read_text(page_);
  for (const char* name : {"d", "c"}) {
    EXPECT_THROW(require_section(page_, name), Error) << name;
    EXPECT_THROW(put_section(page_, name, "text"), Error) << name;
  }
  EXPECT_THROW(require_section((folder_.path() / "none.md").string(), "a"), Error);
  EXPECT_EQ(read_text(page_), before);
}

TEST_F(PageSection, what_is_printed_is_kept_and_printed) {
  testing::internal::CaptureStdout();
  const std::string kept = printed_by([] { fmt::print("{} lines\n", 2); });
  EXPECT_EQ(kept, "2 lines\n");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "2 lines\n");
}

}  // namespace
}  // namespace ctu::sim::paper
