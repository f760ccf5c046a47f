// "2%" as users write it.
#pragma once

#include <string>

namespace ctu::ladder {

/// "2%" or "2" gives 0.02. Throws Error, at `option`, on anything else.
double parse_percentage(const std::string& option, const std::string& text);

}  // namespace ctu::ladder
