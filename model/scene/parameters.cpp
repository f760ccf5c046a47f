#include "model/scene/parameters.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <numeric>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "model/scene/text_cursor.h"

namespace ctu::scene {

Parameters::Parameters(std::string where, std::string_view text) : where_(std::move(where)) {
  const std::size_t question = text.find('?');
  name_ = text.substr(0, question);
  if (question == std::string_view::npos) return;
  text.remove_prefix(question + 1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throw Error(where_, fmt::format("'{}' is not key=value", part),
                  "write it as in gen:hair-ball?strands=2000&seed=1");
    Entry entry{std::string(part.substr(0, equals)), std::string(part.substr(equals + 1))};
    for (const Entry& other : entries_)
      if (other.key == entry.key) throw Error(where_, fmt::format("'{}' is given twice", entry.key), "give it once");
    entries_.push_back(std::move(entry));
  }
}

const std::string* Parameters::find(const std::string& key) {
  known_.push_back(key);
  for (Entry& entry : entries_)
    if (entry.key == key) {
      entry.used = true;
      return &entry.value;
    }
  return nullptr;
}

std::uint64_t Parameters::whole(const std::string& key, std::uint64_t otherwise, std::uint64_t low,
                                std::uint64_t high) {
  const std::string* text = find(key);
  if (text == nullptr) return otherwise;
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc{} || end != text->data() + text->size() || value < low || value > high)
    throw Error(where_, fmt::format("{}={} is not a whole number from {} to {}", key, *text, low, high),
                fmt::format("leave it out to have {}", otherwise));
  return value;
}

double Parameters::real(const std::string& key, double otherwise, double low, double high) {
  const std::string* text = find(key);
  if (text == nullptr) return otherwise;
  double value = 0;
  if (!parse_number(*text, value) || value < low || value > high)
    throw Error(where_, fmt::format("{}={} is not a number from {} to {}", key, *text, low, high),
                fmt::format("leave it out to have {}", otherwise));
  return value;
}

void Parameters::expect_all_used() const {
  for (const Entry& entry : entries_)
    if (!entry.used)
      throw Error(where_, fmt::format("{} has no key '{}'", name_, entry.key),
                  fmt::format("did you mean '{}'? Known: {}", nearest_name(entry.key, known_),
                              std::accumulate(known_.begin(), known_.end(), std::string{},
                                              [](const std::string& all, const std::string& one) {
                                                return all.empty() ? one : all + ", " + one;
                                              })));
}

}  // namespace ctu::scene
