// A build of the RTL unit from other sources than the program is not run: its calls may mean something else.
#include <gtest/gtest.h>

#include <string>

#include "model/base/error.h"
#include "sim/cosim/rtl_builds.h"
#include "tests/sim/program.h"

namespace ctu::cosim {
namespace {

const std::string kStamp = "rtl ";

/// Where the library's bytes say what it was built from: the stamp and 64 hexadecimal digits.
std::size_t stamp_in(const std::string& bytes) {
  for (std::size_t at = bytes.find(kStamp); at != std::string::npos; at = bytes.find(kStamp, at + 1)) {
    const std::size_t digits = at + kStamp.size();
    if (bytes.find_first_not_of("0123456789abcdef", digits) == digits + 64 && bytes[digits + 64] == 0) return digits;
  }
  return std::string::npos;
}

TEST(StaleBuild, a_library_from_other_sources_is_refused_and_one_from_the_same_is_loaded) {
  const test::ScratchFolder folder;
  std::string bytes = test::read_text(CTU_RTL_LIBRARY);
  const std::string same = folder.path() / "same.so", other = folder.path() / "other.so";
  test::write_text(same, bytes);
  EXPECT_NE(load_rtl_unit(same), nullptr);

  const std::size_t digit = stamp_in(bytes);
  ASSERT_NE(digit, std::string::npos) << "the library does not say what it was built from";
  bytes[digit] = bytes[digit] == '0' ? '1' : '0';
  test::write_text(other, bytes);
  try {
    load_rtl_unit(other);
    FAIL() << "loaded";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("other sources"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("./dev rtl"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace ctu::cosim
