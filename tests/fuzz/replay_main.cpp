// ctu_fuzz_replay: the harnesses without libFuzzer.
//
//   ctu_fuzz_replay                         the names of all harnesses
//   ctu_fuzz_replay NAME FILE...            these inputs
//   ctu_fuzz_replay --corpus FOLDER         all committed inputs below FOLDER
//   ctu_fuzz_replay --mutate FOLDER SECONDS [NAME...]
//                                           inputs made of them, by a seed that is printed; CTU_TEST_SEED sets it
//
// Every input is run under a limit of time and memory. Exit codes: 0 all were taken or refused, 1 one was not, 2 bad
// usage.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/fuzz/corpus.h"
#include "tests/fuzz/limits.h"
#include "tests/fuzz/mutator.h"

namespace ctu::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

/// Whether the input was taken or refused.
bool run(const Harness& harness, Input input, const std::string& file) {
  try {
    const Watch watch(harness, input, file);
    harness.run(input);
    return true;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "{}: {}\n", file, problem.what());
  }
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
  fmt::print(stderr, "replay it with: ctu_fuzz_replay {} {}\n", harness.name, file);
  return false;
}

const Harness& harness_named(const std::string& name) {
  if (const Harness* found = find_harness(name)) return *found;
  throw Error(name, "there is no such harness", "ctu_fuzz_replay alone lists them");
}

int list() {
  for (const Harness& harness : harnesses()) fmt::print("{:<14} {}\n", harness.name, harness.what);
  return 0;
}

int replay(const Harness& harness, const std::vector<CorpusFile>& files) {
  for (const CorpusFile& file : files)
    if (!run(harness, file.content, file.path)) return 1;
  fmt::print("{:<14} {} inputs\n", harness.name, files.size());
  return 0;
}

int replay_corpus(const std::string& folder) {
  for (const Harness& harness : harnesses())
    if (const int code = replay(harness, read_corpus(folder, harness.name)); code != 0) return code;
  return 0;
}

std::uint64_t chosen_seed() {
  if (const char* given = std::getenv("CTU_TEST_SEED")) return std::strtoull(given, nullptr, 0);
  return std::random_device{}();
}

int mutate(const Harness& harness, const std::string& folder, std::uint64_t seed, Clock::duration time) {
  const Mutator mutator(read_corpus(folder, harness.name), read_dictionary(folder, harness.name),
                        harness.longest_bytes);
  const Clock::time_point end = Clock::now() + time;
  std::uint64_t inputs = 0;
  for (; Clock::now() < end; ++inputs) {
    std::seed_seq words{seed, inputs};
    std::mt19937_64 random(words);
    if (!run(harness, mutator.next(random), fmt::format("fuzz-{}-{}-{}", harness.name, seed, inputs))) return 1;
  }
  fmt::print("{:<14} {} inputs\n", harness.name, inputs);
  return 0;
}

int mutate_all(const std::string& folder, double seconds, const std::vector<std::string>& names) {
  std::vector<Harness> wanted;
  for (const std::string& name : names) wanted.push_back(harness_named(name));
  if (names.empty()) wanted.assign(harnesses().begin(), harnesses().end());
  const std::uint64_t seed = chosen_seed();
  fmt::print("CTU_TEST_SEED={}\n", seed);
  std::fflush(stdout);
  const std::chrono::duration<double> each(seconds / static_cast<double>(wanted.size()));
  for (const Harness& harness : wanted)
    if (const int code = mutate(harness, folder, seed, std::chrono::duration_cast<Clock::duration>(each)); code != 0)
      return code;
  return 0;
}

int run_arguments(const std::vector<std::string>& words) {
  limit_memory(kMostBytes);
  if (words.empty()) return list();
  if (words[0] == "--corpus" && words.size() == 2) return replay_corpus(words[1]);
  if (words[0] == "--mutate" && words.size() >= 3)
    return mutate_all(words[1], std::stod(words[2]), {words.begin() + 3, words.end()});
  if (words[0].starts_with("--")) throw Error(words[0], "is no command", "see the head of replay_main.cpp");
  std::vector<CorpusFile> files;
  for (std::size_t i = 1; i < words.size(); ++i) files.push_back(read_input(words[i]));
  return replay(harness_named(words[0]), files);
}

}  // namespace
}  // namespace ctu::fuzz

int main(int argc, char** argv) {
  try {
    return ctu::fuzz::run_arguments({argv + 1, argv + argc});
  } catch (const ctu::Error& problem) {
    fmt::print(stderr, "ctu_fuzz_replay: {}\n", problem.what());
    return 2;
  }
}
