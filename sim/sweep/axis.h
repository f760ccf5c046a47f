// What varies in a sweep: keys with the values that they take, alone or together with others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ctu::sweep {

struct Setting {
  std::string key, value;  ///< as in --set
  bool operator==(const Setting&) const = default;
};
using Settings = std::vector<Setting>;

/// Keys that take their values together: an axis of a grid. One key, or several of a [[zip]].
struct Axis {
  std::vector<std::string> keys;
  std::vector<std::vector<std::string>> choices;  ///< the values of the keys, in their order
};

/// From `first` on in steps of `step` up to `last`, which is in it if a step ends there. Throws Error, at `where`, when
/// the step leads away from `last` or there are more than a hundred thousand values.
std::vector<std::int64_t> stepped_values(std::int64_t first, std::int64_t last, std::int64_t step,
                                         const std::string& where);

/// `first`, doubled again and again up to `last`. Throws Error when `first` is not positive or exceeds `last`.
std::vector<std::int64_t> doubled_values(std::int64_t first, std::int64_t last, const std::string& where);

}  // namespace ctu::sweep
