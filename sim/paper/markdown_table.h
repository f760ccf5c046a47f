// A Markdown table: some columns of text, then columns of numbers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace ctu::sim::paper {

using Cells = std::vector<std::string>;

class MarkdownTable {
 public:
  MarkdownTable(const Cells& titles, std::size_t texts) {
    add(titles);
    Cells rule;
    for (std::size_t i = 0; i < titles.size(); ++i) rule.push_back(i < texts ? "---" : "---:");
    add(rule);
  }
  void add(const Cells& cells) {
    text_ += "|";
    for (const std::string& cell : cells) text_ += " " + cell + " |";
    text_ += "\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace ctu::sim::paper
