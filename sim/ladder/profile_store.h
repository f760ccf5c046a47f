// Profiles that were counted before, each in a file of its own: a sweep asks for the same one again and again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/ladder/visit_profile.h"

namespace ctu::ladder {

class ProfileStore {
 public:
  /// `folder` empty: the user's, $XDG_CACHE_HOME/ctusim/profiles or ~/.cache/ctusim/profiles.
  explicit ProfileStore(std::filesystem::path folder = {});

  /// Nothing when the file is not there, or is not one that this program wrote for this key.
  std::optional<VisitProfile> find(const std::string& key) const;
  /// A folder that cannot be written is no mistake: the profile is counted again the next time.
  void keep(const std::string& key, const VisitProfile& profile) const;

 private:
  std::filesystem::path file(const std::string& key) const;
  std::filesystem::path folder_;
};

}  // namespace ctu::ladder
