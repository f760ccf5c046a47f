#include "sim/sweep/pareto.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ctu::sweep {

bool dominates(const Objectives& a, const Objectives& b) {
  bool better = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] > b[i]) return false;
    better |= a[i] < b[i];
  }
  return better;
}

std::vector<std::size_t> pareto_front(const std::vector<Objectives>& points) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    bool stays = true;
    for (std::size_t j = 0; j < points.size() && stays; ++j)
      stays = !dominates(points[j], points[i]) && (j >= i || points[j] != points[i]);
    if (stays) front.push_back(i);
  }
  return front;
}

double hypervolume(std::vector<Objectives> points, const Objectives& reference) {
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Objectives& point) {
                                for (std::size_t i = 0; i < reference.size(); ++i)
                                  if (!(point[i] < reference[i])) return true;
                                return false;
                              }),
               points.end());
  if (points.empty()) return 0;
  const std::size_t last = reference.size() - 1;
  std::sort(points.begin(), points.end(), [&](const Objectives& a, const Objectives& b) { return a[last] < b[last]; });
  if (last == 0) return reference[0] - points[0][0];
  // Between the planes of two neighbours, the volume is that of all points below, one objective less.
  double volume = 0;
  std::vector<Objectives> below;
  const Objectives face(reference.begin(), reference.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    below.emplace_back(points[i].begin(), points[i].end() - 1);
    const double depth = (i + 1 < points.size() ? points[i + 1][last] : reference[last]) - points[i][last];
    if (depth > 0) volume += depth * hypervolume(below, face);
  }
  return volume;
}

std::vector<int> front_numbers(const std::vector<Objectives>& points) {
  std::vector<int> numbers(points.size(), -1);
  std::vector<std::size_t> left(points.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  for (int number = 0; !left.empty(); ++number) {
    std::vector<std::size_t> behind;
    for (const std::size_t i : left) {
      const bool first =
          std::none_of(left.begin(), left.end(), [&](std::size_t j) { return dominates(points[j], points[i]); });
      if (first)
        numbers[i] = number;
      else
        behind.push_back(i);
    }
    left = std::move(behind);
  }
  return numbers;
}

std::vector<double> crowding_distances(const std::vector<Objectives>& front) {
  std::vector<double> distances(front.size(), 0);
  if (front.empty()) return distances;
  std::vector<std::size_t> order(front.size());
  for (std::size_t k = 0; k < front[0].size(); ++k) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return front[a][k] < front[b][k]; });
    const double range = front[order.back()][k] - front[order.front()][k];
    distances[order.front()] = distances[order.back()] = std::numeric_limits<double>::infinity();
    if (range <= 0) continue;
    for (std::size_t i = 1; i + 1 < order.size(); ++i)
      distances[order[i]] += (front[order[i + 1]][k] - front[order[i - 1]][k]) / range;
  }
  return distances;
}

}  // namespace ctu::sweep
