// The one exception type for mistakes that a user can make: bad usage, configuration or input.
// `main` catches it, prints one message and exits with code 2. Our own mistakes are assertions.
#pragma once

#include <stdexcept>
#include <string>

namespace ctu {

/// What went wrong, where (file and line, element, key), and what the user can do about it.
class Error : public std::runtime_error {
 public:
  Error(std::string where, std::string what, std::string remedy)
      : std::runtime_error(where + ": " + what + (remedy.empty() ? "" : "\n  remedy: " + remedy)),
        where_(std::move(where)),
        problem_(std::move(what)),
        remedy_(std::move(remedy)) {}

  const std::string& where() const { return where_; }
  const std::string& problem() const { return problem_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::string where_, problem_, remedy_;
};

}  // namespace ctu
