#include "sim/tailor/tailored_config.h"

#include "sim/config_parts.h"

namespace ctu::sim {

TailoredConfig load_tailored_config(const std::string& path, const std::vector<std::string>& sets) {
  PartValues values;
  TailoredConfig tailored;
  tailored.config = load_config_with_parts(path, sets, values);
  if (!values.empty()) tailored.parts = tailor::parts_from(values, path);
  return tailored;
}

}  // namespace ctu::sim
