// The committed inputs: corpus/NAME/ holds seeds and what once broke something, dictionaries/NAME.dict words of the
// format as libFuzzer reads them.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/fuzz/harness.h"

namespace ctu::fuzz {

using InputBytes = std::vector<std::uint8_t>;

struct CorpusFile {
  std::string path;
  InputBytes content;
};

/// Throws Error when the file cannot be read.
CorpusFile read_input(const std::string& path);

/// The files of corpus/NAME below `folder`, by name. Throws Error when there are none.
std::vector<CorpusFile> read_corpus(const std::string& folder, std::string_view name);

/// The words of the dictionary; none when there is no dictionary.
std::vector<InputBytes> read_dictionary(const std::string& folder, std::string_view name);

}  // namespace ctu::fuzz
