// Modules that were synthesised before, each in a file of its own, so that only what a configuration changes is
// synthesised again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/area/module_area.h"

namespace ctu::area {

class AreaCache {
 public:
  /// `folder` empty: the user's, $XDG_CACHE_HOME/ctusim/area or ~/.cache/ctusim/area.
  explicit AreaCache(const std::filesystem::path& folder = {});

  /// Nothing when the file is not there, or is not one of ours.
  std::optional<ModuleArea> find(const std::string& key) const;
  /// A cache that cannot be written is no mistake: it is left as it is.
  void keep(const std::string& key, const ModuleArea& area) const;

 private:
  std::filesystem::path file(const std::string& key) const { return folder_ / (key + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace ctu::area
