// The stack of lines against caches of every capacity that are simulated one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <random>

#include "sim/ladder/line_stack.h"

namespace {

using namespace ctu::ladder;

/// Lines by their last use, the last one first; the position is the number of other lines used since.
class PlainStack {
 public:
  /// -1: never used before.
  int use(std::uint64_t line) {
    int position = 0;
    for (auto at = lines_.begin(); at != lines_.end(); ++at, ++position)
      if (*at == line) {
        lines_.splice(lines_.begin(), lines_, at);
        return position;
      }
    lines_.push_front(line);
    return -1;
  }

 private:
  std::list<std::uint64_t> lines_;
};

int group_of(int position) {
  if (position < 0) return kCapacities;
  int group = 0;
  while (group < kCapacities && static_cast<int>(capacity(group)) <= position) ++group;
  return group;
}

TEST(line_stack, says_which_capacities_would_have_held_each_line) {
  const unsigned seed = std::random_device{}();
  RecordProperty("seed", std::to_string(seed));
  std::mt19937 random(seed);
  for (const std::uint64_t lines : {1u, 7u, 8u, 9u, 40u, 300u, 1500u}) {
    LineStack stack(lines);
    PlainStack plain;
    std::geometric_distribution<std::uint64_t> near(8.0 / static_cast<double>(lines + 8));
    for (int i = 0; i < 6000; ++i) {
      const std::uint64_t line = (random() % 4 == 0 ? random() : near(random)) % lines;
      ASSERT_EQ(stack.use(line).group, group_of(plain.use(line)))
          << "seed " << seed << ", " << lines << " lines, use " << i;
    }
  }
}

TEST(line_stack, gives_each_line_a_place_of_its_own_that_stays) {
  LineStack stack(100);
  std::vector<std::uint32_t> places(100);
  for (std::uint64_t line = 0; line < 100; ++line) places[line] = stack.use(99 - line).place;
  for (std::uint64_t line = 0; line < 100; ++line) EXPECT_EQ(stack.use(99 - line).place, places[line]);
  std::sort(places.begin(), places.end());
  EXPECT_EQ(std::unique(places.begin(), places.end()), places.end());
  EXPECT_EQ(stack.distinct(), 100u);
}

}  // namespace
