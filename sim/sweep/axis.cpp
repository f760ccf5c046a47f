#include "sim/sweep/axis.h"

#include <fmt/format.h>

#include "model/base/error.h"

namespace ctu::sweep {
namespace {
constexpr std::size_t kMostValues = 100000;
}

std::vector<std::int64_t> stepped_values(std::int64_t first, std::int64_t last, std::int64_t step,
                                         const std::string& where) {
  if (step == 0 || (step > 0) != (last >= first))
    throw Error(where, fmt::format("steps of {} do not lead from {} to {}", step, first, last),
                "write range = [first, last, step], or [first, last] for steps of 1");
  std::vector<std::int64_t> values;
  const std::uint64_t stride = step > 0 ? static_cast<std::uint64_t>(step) : -static_cast<std::uint64_t>(step);
  const std::uint64_t length = step > 0 ? static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first)
                                        : static_cast<std::uint64_t>(first) - static_cast<std::uint64_t>(last);
  if (length / stride >= kMostValues)
    throw Error(where, fmt::format("more than {} values", kMostValues), "take larger steps");
  for (std::uint64_t i = 0; i <= length / stride; ++i) values.push_back(first + static_cast<std::int64_t>(i) * step);
  return values;
}

std::vector<std::int64_t> doubled_values(std::int64_t first, std::int64_t last, const std::string& where) {
  if (first <= 0 || first > last)
    throw Error(where, fmt::format("doubling does not lead from {} to {}", first, last),
                "write log2 = [first, last], both positive, as in log2 = [8192, 131072]");
  std::vector<std::int64_t> values = {first};
  while (values.back() <= last / 2) values.push_back(values.back() * 2);
  return values;
}

}  // namespace ctu::sweep
