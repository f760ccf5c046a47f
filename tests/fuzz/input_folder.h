// Where inputs become files: a folder of this process, gone when it ends.
#pragma once

#include <string>
#include <string_view>

#include "tests/fuzz/harness.h"
#include "tests/traces/test_support.h"

namespace ctu::fuzz {

class InputFolder {
 public:
  /// Writes a file in place of one of the same name and returns its path.
  std::string put(const std::string& name, Input content) const;
  std::string put(const std::string& name, std::string_view content) const {
    return put(name, Input(reinterpret_cast<const std::uint8_t*>(content.data()), content.size()));
  }
  std::string path(const std::string& name) const { return folder_.file(name); }

 private:
  traces::test::TemporaryFolder folder_;
};

}  // namespace ctu::fuzz
