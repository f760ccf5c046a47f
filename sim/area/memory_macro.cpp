#include "sim/area/memory_macro.h"

#include <sstream>

namespace ctu::area {
namespace {

constexpr const char* kReads[] = {"read_slot_i", "read_word_i"};
constexpr const char* kRead = "read_o";
constexpr int kWritePorts = 2;  ///< lines from memory, lines of the cache

}  // namespace

std::optional<ModuleArea> memory_macro(const std::string& name, const ElaboratedModule& module) {
  if (name != "line_buffer") return std::nullopt;
  const auto& parameters = module.parameters;
  const std::int64_t slots = std::int64_t{1} << parameters.at("SLOT_BITS");
  const std::int64_t line_words = parameters.at("LINE_BYTES") / 4;
  // Words that begin anywhere in a line.
  const std::int64_t read_lines = (line_words - 1 + parameters.at("READ_WORDS") + line_words - 1) / line_words;
  ModuleArea area;
  area.memories[{static_cast<std::uint64_t>(slots * parameters.at("LINES")),
                 static_cast<std::uint32_t>(32 * line_words), static_cast<std::uint32_t>(read_lines), kWritePorts}] = 1;
  std::istringstream words(module.ports);
  for (std::string word; words >> word;)
    if (word.starts_with('\\') && word != std::string("\\") + kRead) area.paths.capture[word.substr(1)] = 0;
  area.paths.launch[kRead] = 1;
  for (const char* input : kReads) {
    area.paths.capture.erase(input);
    area.paths.pass[{input, kRead}] = 1;
  }
  return area;
}

}  // namespace ctu::area
