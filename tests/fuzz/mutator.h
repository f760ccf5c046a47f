// New inputs from old ones, for builds without libFuzzer: nothing guides it but the corpus and the dictionary.
#pragma once

#include <random>
#include <vector>

#include "tests/fuzz/corpus.h"

namespace ctu::fuzz {

class Mutator {
 public:
  /// `corpus` is not empty; inputs grow to `longest_bytes` at most.
  Mutator(std::vector<CorpusFile> corpus, std::vector<InputBytes> dictionary, std::size_t longest_bytes);

  /// A member of the corpus with one to eight changes. The same for the same state of `random`.
  InputBytes next(std::mt19937_64& random) const;

 private:
  void change(InputBytes& bytes, std::mt19937_64& random) const;

  std::vector<CorpusFile> corpus_;
  std::vector<InputBytes> dictionary_;
  std::size_t longest_bytes_;
};

}  // namespace ctu::fuzz
