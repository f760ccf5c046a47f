#include "model/base/version.h"

namespace ctu {

const char* tool_version() { return CTU_VERSION; }

}  // namespace ctu
