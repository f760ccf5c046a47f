#include "tests/support/real_scenes.h"

#include <cstdlib>
#include <string>

namespace ctu::test {
namespace {

std::filesystem::path from_environment(const char* variable, const std::filesystem::path& otherwise) {
  const char* value = std::getenv(variable);
  return value == nullptr ? otherwise : std::filesystem::path(value);
}

}  // namespace

std::filesystem::path unpacked_scenes() {
  const std::filesystem::path repository = CTU_REPOSITORY;
  const auto shared = from_environment("CTU_SCENES", repository / "../shared/scenes");
  const auto unpacked = from_environment("CTU_SCENES_UNPACKED", repository / "build/scenes");
  if (std::filesystem::exists(unpacked / "index.txt")) return unpacked;
  if (!std::filesystem::is_directory(shared)) return {};
  const std::string command =
      (repository / "tools/unpack_scenes.sh").string() + " '" + shared.string() + "' '" + unpacked.string() + "'";
  return std::system(command.c_str()) == 0 ? unpacked : std::filesystem::path{};
}

}  // namespace ctu::test
