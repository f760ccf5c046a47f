#include "sim/sweep/space.h"

#include <algorithm>
#include <charconv>

namespace ctu::sweep {

bool Condition::fits(const std::string& value) const {
  if (!values.empty() && std::find(values.begin(), values.end(), value) == values.end()) return false;
  if (!below && !above) return true;
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size()) return false;
  return (!below || number < *below) && (!above || number > *above);
}

std::vector<std::string> Space::swept_keys() const {
  std::vector<std::string> keys;
  for (const Axis& axis : axes) keys.insert(keys.end(), axis.keys.begin(), axis.keys.end());
  return keys;
}

const char* to_string(SearchMode mode) {
  switch (mode) {
    case SearchMode::Random:
      return "random";
    case SearchMode::Pareto:
      return "pareto";
    case SearchMode::Grid:
      break;
  }
  return "grid";
}

}  // namespace ctu::sweep
