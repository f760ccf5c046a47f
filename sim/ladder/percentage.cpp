#include "sim/ladder/percentage.h"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::ladder {

double parse_percentage(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string rest = end;
  if (end == text.c_str() || (!rest.empty() && rest != "%") || !std::isfinite(value))
    throw Error(option, fmt::format("\"{}\" is no percentage", text), "write it as in 2%");
  return value / 100;
}

}  // namespace ctu::ladder
