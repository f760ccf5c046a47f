#include "tests/fuzz/input_folder.h"

#include <cstdio>

namespace ctu::fuzz {

// Removed first: some file systems flush a file that is cut to nothing and written again, which is slow.
std::string InputFolder::put(const std::string& name, Input content) const {
  const std::string to = path(name);
  std::remove(to.c_str());
  traces::test::write_bytes(to, {content.begin(), content.end()});
  return to;
}

}  // namespace ctu::fuzz
