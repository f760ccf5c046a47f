#include "tests/timeline/kanata_reader.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

namespace ctu::test {
namespace {

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line)
    if (c == '\t')
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

class Reader {
 public:
  KanataLog read(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "Kanata\t0004");
    while (std::getline(lines, line)) {
      SCOPED_TRACE(line);
      command(fields_of(line));
    }
    log_.last_cycle = now_;
    for (KanataOp& op : log_.ops) {
      if (!op.retired && !op.flushed) op.end = now_;
      if (!op.stages.empty() && !op.stages.back().ended) op.stages.back().end = now_;
    }
    return log_;
  }

 private:
  void command(const std::vector<std::string>& f) {
    static const std::map<std::string, std::size_t> kFields = {{"C=", 2}, {"C", 2}, {"I", 4}, {"L", 4},
                                                               {"S", 4},  {"E", 4}, {"R", 4}, {"W", 4}};
    const auto known = kFields.find(f[0]);
    ASSERT_NE(known, kFields.end()) << "unknown command";
    ASSERT_EQ(f.size(), known->second);
    if (f[0] == "C=") {
      log_.first_cycle = now_ = std::stoull(f[1]);
    } else if (f[0] == "C") {
      EXPECT_GT(std::stoull(f[1]), 0u);
      now_ += std::stoull(f[1]);
    } else if (f[0] == "I") {
      ASSERT_EQ(std::stoull(f[1]), log_.ops.size()) << "numbers of the file are given in order";
      KanataOp& op = log_.ops.emplace_back();
      op.ray = std::stoull(f[2]);
      op.thread = std::stoull(f[3]);
      op.begin = now_;
    } else {
      const std::size_t id = std::stoull(f[1]);
      ASSERT_LT(id, log_.ops.size()) << "not begun";
      ASSERT_FALSE(log_.ops[id].retired || log_.ops[id].flushed) << "over";
      of_op(f, id, log_.ops[id]);
    }
  }

  void of_op(const std::vector<std::string>& f, std::size_t id, KanataOp& op) {
    if (f[0] == "L") {
      ASSERT_TRUE(f[2] == "0" || f[2] == "1");
      (f[2] == "0" ? op.label : op.detail) += f[3];
    } else if (f[0] == "S") {
      ASSERT_EQ(f[2], "0");
      ASSERT_TRUE(op.stages.empty() || op.stages.back().ended);
      op.stages.push_back({f[3], now_, now_});
    } else if (f[0] == "E") {
      ASSERT_EQ(op.stages.back().name, f[3]);
      op.stages.back().end = now_;
      op.stages.back().ended = true;
    } else if (f[0] == "R") {
      ASSERT_TRUE(op.stages.back().ended);
      ASSERT_TRUE(retirements_.insert(std::stoull(f[2])).second);
      (f[3] == "0" ? op.retired : op.flushed) = true;
      op.end = now_;
    } else {
      ASSERT_LT(std::stoull(f[2]), id) << "an arrow from an operation that has not begun";
      op.producers.push_back(std::stoull(f[2]));
    }
  }

  KanataLog log_;
  std::uint64_t now_ = 0;
  std::set<std::uint64_t> retirements_;
};

}  // namespace

KanataLog read_kanata(const std::string& text) { return Reader().read(text); }

}  // namespace ctu::test
