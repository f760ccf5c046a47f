// Modules that were synthesised before, each in a file of its own, so that only what a configuration changes is
// synthesised again.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "sim/area/module_area.h"

namespace ctu::area {

class AreaCache {
 public:
  /// `folder` empty: the user's, $XDG_CACHE_HOME/ctusim/area or ~/.cache/ctusim/area.
  explicit AreaCache(const std::filesystem::path& folder = {});

  using Identities = std::map<std::string, std::string>;

  /// Nothing when the file is not there, or is not one of ours.
  std::optional<ModuleArea> find(const std::string& key) const;
  /// A cache that cannot be written is no mistake: it is left as it is.
  void keep(const std::string& key, const ModuleArea& area) const;
  /// The same of what Elaboration::identities said of a whole unit, so that it need not be read again.
  std::optional<Identities> find_identities(const std::string& key) const;
  void keep_identities(const std::string& key, const Identities& identities) const;

 private:
  void write(const std::string& key, const std::string& text) const;
  std::filesystem::path file(const std::string& key) const { return folder_ / (key + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace ctu::area
