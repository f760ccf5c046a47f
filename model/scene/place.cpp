#include "model/scene/place.h"

#include <fmt/core.h>

#include <algorithm>

namespace ctu::scene {

std::string Place::text() const {
  if (file_ == nullptr) return words_;
  const auto end = file_->bytes.begin() + static_cast<std::ptrdiff_t>(std::min(offset_, file_->bytes.size()));
  return fmt::format("{}:{}", file_->path, 1 + std::count(file_->bytes.begin(), end, '\n'));
}

}  // namespace ctu::scene
