#include "sim/timeline/kanata_log.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sim/timeline/ray_visit.h"

namespace ctu::sim {
namespace {

using pipeline::Cycle;

enum class Kind : std::uint8_t { EndStage, Retire, Begin, BeginStage };

struct Command {
  Cycle cycle;
  Kind kind;
  std::size_t op;
  pipeline::Place place = pipeline::Place::RaySetup;  ///< of stages

  /// In a cycle what ends stands before what begins, as one place ends where the next one begins.
  auto key() const { return std::tuple(cycle, kind >= Kind::Begin, op); }
};

class Log {
 public:
  explicit Log(const pipeline::Timeline& timeline) : end_(timeline.end()), visits_(ray_visits(timeline)) {
    std::vector<std::size_t> order(visits_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(visits_[a].begin(), visits_[a].slot) < std::pair(visits_[b].begin(), visits_[b].slot);
    });
    op_of_.resize(visits_.size());
    for (std::size_t op = 0; op < order.size(); ++op) op_of_[order[op]] = op;
    visit_of_ = std::move(order);
    for (std::size_t op = 0; op < visits_.size(); ++op) add_commands(op);
    std::stable_sort(commands_.begin(), commands_.end(),
                     [](const Command& a, const Command& b) { return a.key() < b.key(); });
  }

  std::string text(Cycle first) {
    write("Kanata\t0004\nC=\t{}\n", first);
    Cycle now = first;
    for (const Command& command : commands_) {
      pass(now, command.cycle);
      write(command);
    }
    pass(now, end_);
    return std::move(text_);
  }

 private:
  const RayVisit& visit(std::size_t op) const { return visits_[visit_of_[op]]; }

  void add_commands(std::size_t op) {
    const RayVisit& visit = this->visit(op);
    commands_.push_back({visit.begin(), Kind::Begin, op});
    for (const pipeline::RayStay& stay : visit.stays) {
      commands_.push_back({stay.begin, Kind::BeginStage, op, stay.place});
      if (stay.end < end_ || stay.leaves) commands_.push_back({stay.end, Kind::EndStage, op, stay.place});
    }
    if (visit.end() < end_ || visit.leaves()) commands_.push_back({visit.end(), Kind::Retire, op});
  }

  template <class... Values>
  void write(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }

  void pass(Cycle& now, Cycle next) {
    if (next > now) write("C\t{}\n", next - now);
    now = next;
  }

  void write(const Command& command) {
    const std::size_t op = command.op;
    switch (command.kind) {
      case Kind::EndStage:
        return write("E\t{}\t0\t{}\n", op, pipeline::name_of(command.place));
      case Kind::Retire:
        return write("R\t{}\t{}\t{}\n", op, retired_++, is_all_culled(visit(op)) ? 1 : 0);
      case Kind::Begin:
        return write_begin(op);
      case Kind::BeginStage:
        return write("S\t{}\t0\t{}\n", op, pipeline::name_of(command.place));
    }
  }

  void write_begin(std::size_t op) {
    const RayVisit& visit = this->visit(op);
    write("I\t{}\t{}\t{}\n", op, visit.ray, visit.slot);
    write("L\t{}\t0\tray {} {}\n", op, visit.ray, describe(visit));
    write("L\t{}\t1\tcycles {} to {}", op, visit.begin(), visit.end() - 1);
    for (const pipeline::RayStay& stay : visit.stays)
      write("\\n{} {}", pipeline::name_of(stay.place), stay.end - stay.begin);
    text_ += '\n';
    if (visit.follows) write("W\t{}\t{}\t0\n", op, op_of_[visit_of_[op] - 1]);
  }

  Cycle end_;
  std::vector<RayVisit> visits_;
  std::vector<std::size_t> visit_of_, op_of_;  ///< operations are numbered in the order in which they begin
  std::vector<Command> commands_;
  std::size_t retired_ = 0;
  std::string text_;
};

}  // namespace

std::string kanata_log(const pipeline::Timeline& timeline) { return Log(timeline).text(timeline.first()); }

}  // namespace ctu::sim
