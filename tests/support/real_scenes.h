// Where the real scenes are: CTU_SCENES names their folder (else ../shared/scenes beside the repository),
// CTU_SCENES_UNPACKED where they are unpacked (else build/scenes).
#pragma once

#include <filesystem>

namespace ctu::test {

/// The unpacked folder, unpacked now if it is not there yet; empty if there are no shared scenes.
std::filesystem::path unpacked_scenes();

}  // namespace ctu::test
