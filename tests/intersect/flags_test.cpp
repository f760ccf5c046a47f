#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/intersect/flag_kernel.h"
#include "tests/intersect/hostile_boxes.h"
#include "tests/oracle/seed.h"

namespace ctu::intersect {
namespace {

constexpr std::size_t kCases = 60'000;

/// Hostile boxes, and as the triangle three corners of the first box (finite: the first lane that is not empty).
std::vector<float> numbers() {
  std::vector<float> all;
  HostileBoxes source(oracle::test_seed() + 3);
  while (all.size() < kCases * kNumbersPerCase) {
    const BoxCase c = source.next();
    int lane = 0;
    while (lane < kLanes && c.boxes.lo[0][lane] > c.boxes.hi[0][lane]) ++lane;
    if (lane == kLanes) continue;
    const Ray& r = c.ray;
    for (const float x :
         {r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y, r.direction.z, r.tmin, r.tmax})
      all.push_back(x);
    const std::size_t at = all.size();
    all.resize(at + 24);
    std::memcpy(&all[at], &c.boxes, sizeof c.boxes);
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis)
        all.push_back(axis == corner ? c.boxes.hi[axis][lane] : c.boxes.lo[axis][lane]);
    }
  }
  return all;
}

std::vector<std::uint32_t> results(IntersectKernel kernel, const std::vector<float>& cases) {
  std::vector<std::uint32_t> out(kCases * kResultsPerCase);
  kernel(cases.data(), kCases, out.data());
  return out;
}

void expect_same(const std::vector<std::uint32_t>& is, const std::vector<std::uint32_t>& should) {
  SCOPED_TRACE(oracle::seed_note());
  for (std::size_t i = 0; i < is.size(); ++i) {
    ASSERT_EQ(is[i], should[i]) << "first difference: result " << i % kResultsPerCase << " of case "
                                << i / kResultsPerCase;
  }
}

TEST(CompilerFlags, optimization_does_not_change_a_bit_of_the_intersection_tests) {
  const std::vector<float> cases = numbers();
  expect_same(results(intersect_kernel_o3, cases), results(intersect_kernel_o0, cases));
}

TEST(CompilerFlags, the_instruction_set_does_not_change_a_bit_of_the_intersection_tests) {
  const std::vector<float> cases = numbers();
  expect_same(results(intersect_kernel_o3_native, cases), results(intersect_kernel_o0, cases));
}

}  // namespace
}  // namespace ctu::intersect
