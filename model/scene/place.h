// A place in a file, kept as it is found and put into words only when a message needs it.
#pragma once

#include <cstddef>
#include <string>

#include "model/scene/source_file.h"

namespace ctu::scene {

class Place {
 public:
  /// A place already in words.
  Place(std::string words) : words_(std::move(words)) {}  // NOLINT(google-explicit-constructor): a name is a place
  /// A byte of a text file, which must outlive the place.
  Place(const SourceFile& file, std::size_t offset) : file_(&file), offset_(offset) {}

  /// "file:line", or the words. Counts lines: linear in the offset.
  std::string text() const;

 private:
  std::string words_;
  const SourceFile* file_ = nullptr;
  std::size_t offset_ = 0;
};

}  // namespace ctu::scene
