// The version of this tool, as the build names it.
#pragma once

namespace ctu {

const char* tool_version();

}  // namespace ctu
