// "NAME?key=value&key=value": the arguments of a generated scene.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ctu::scene {

class Parameters {
 public:
  /// Splits "NAME?key=value&..."; `where` is named in messages. Throws Error for a part without '=' or a key given
  /// twice.
  Parameters(std::string where, std::string_view text);

  const std::string& name() const { return name_; }
  /// The value of `key` or `otherwise`; Error if it is not a whole number of [low, high].
  std::uint64_t whole(const std::string& key, std::uint64_t otherwise, std::uint64_t low, std::uint64_t high);
  /// The value of `key` or `otherwise`; Error if it is not a number of [low, high].
  double real(const std::string& key, double otherwise, double low, double high);
  /// Throws Error for keys that nobody asked for, naming the nearest that somebody did.
  void expect_all_used() const;

 private:
  struct Entry {
    std::string key, value;
    bool used = false;
  };
  const std::string* find(const std::string& key);

  std::string where_, name_;
  std::vector<Entry> entries_;
  std::vector<std::string> known_;
};

}  // namespace ctu::scene
