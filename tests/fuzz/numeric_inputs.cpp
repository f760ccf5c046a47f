#include "tests/fuzz/numeric_inputs.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "model/cull/comparators.h"
#include "model/cull/ideal.h"
#include "model/cull/mask_test.h"
#include "model/cull/object_masks.h"
#include "model/intersect/slab_kernels.h"
#include "model/intersect/triangle_test.h"
#include "model/numeric/round.h"
#include "tests/cull/cases.h"
#include "tests/intersect/stated_triangle.h"
#include "tests/oracle/exact_box.h"
#include "tests/oracle/exact_cells.h"
#include "tests/oracle/exact_round.h"
#include "tests/oracle/exact_triangle.h"

namespace ctu::fuzz {
namespace {

using intersect::Box4;
using intersect::PreparedRay;
using intersect::Ray;
using intersect::SlabTimes;
using numeric::bits;
using numeric::Round;

/// Takes values from the front of an input.
class Words {
 public:
  explicit Words(Input input) : rest_(input) {}
  bool holds(std::size_t bytes) const { return rest_.size() >= bytes; }
  std::uint8_t byte() {
    const std::uint8_t value = rest_[0];
    rest_ = rest_.subspan(1);
    return value;
  }
  float number() {
    std::uint32_t word;
    std::memcpy(&word, rest_.data(), sizeof word);
    rest_ = rest_.subspan(sizeof word);
    return numeric::from_bits(word);
  }
  Vec3 vector() {
    Vec3 v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = number();
    return v;
  }
  Ray ray() {
    Ray r;
    r.origin = vector();
    r.tmin = number();
    r.direction = vector();
    r.tmax = number();
    return r;
  }

 private:
  Input rest_;
};
constexpr std::size_t kRayBytes = 32, kVectorBytes = 12;

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// --- operations ---------------------------------------------------------------------------------------------------

template <Round M>
float computed(oracle::Operation operation, float a, float b) {
  switch (operation) {
    case oracle::Operation::Add:
      return numeric::add<M>(a, b);
    case oracle::Operation::Sub:
      return numeric::sub<M>(a, b);
    case oracle::Operation::Mul:
      return numeric::mul<M>(a, b);
    default:
      return numeric::div<M>(a, b);
  }
}

void check_operation(oracle::Operation operation, Round round, float a, float b) {
  const float is = round == Round::Nearest ? computed<Round::Nearest>(operation, a, b)
                   : round == Round::Down  ? computed<Round::Down>(operation, a, b)
                                           : computed<Round::Up>(operation, a, b);
  require(bits(is) == bits(oracle::exact_operation(operation, round, a, b)), "an operation rounds its exact result");
}

void check_order(float a, float b) {
  const float low = numeric::min(a, b), high = numeric::max(a, b);
  require(std::isnan(low) == (std::isnan(a) && std::isnan(b)), "min of a NaN and a number is the number");
  require(std::isnan(high) == std::isnan(low), "max is a NaN when min is");
  if (!std::isnan(a) && !std::isnan(b)) require(low <= high, "min is not above max");
  if (!std::isnan(a)) require(numeric::next_down(a) <= a && a <= numeric::next_up(a), "neighbours enclose");
}

// --- boxes --------------------------------------------------------------------------------------------------------

bool same_bytes(const SlabTimes& a, const SlabTimes& b) {
  return std::memcmp(a.near_down, b.near_down, sizeof a.near_down) == 0 &&
         std::memcmp(a.near_up, b.near_up, sizeof a.near_up) == 0 &&
         std::memcmp(a.far_down, b.far_down, sizeof a.far_down) == 0 &&
         std::memcmp(a.far_up, b.far_up, sizeof a.far_up) == 0 && std::memcmp(a.t0, b.t0, sizeof a.t0) == 0 &&
         std::memcmp(a.t1, b.t1, sizeof a.t1) == 0 && a.hit == b.hit;
}

void check_span(const Ray& ray, const Vec3& lo, const Vec3& hi, const SlabTimes& times) {
  const oracle::ExactBoxSpan exact = oracle::exact_box_span(ray, lo, hi, ray.tmin, ray.tmax);
  require(!std::isnan(times.t0[0]) && !std::isnan(times.t1[0]), "the slab test gives no NaN");
  if (!exact.hit) return;
  require((times.hit & 1) != 0, "a box that the ray meets is hit");
  require(times.t0[0] <= exact.entry.down && times.t1[0] >= exact.exit.up, "t0 and t1 enclose the exact span");
}

using CellSet = std::vector<std::uint8_t>;

/// Every cell of `exact`, occupied alone, must pass.
void check_cells(const cull::MaskTester& tester, const CellSet& exact, const PreparedRay& ray, const SlabTimes& times,
                 const Box4& boxes) {
  const auto words = static_cast<std::size_t>(cull::words_per_mask(tester.options().resolution));
  for (std::size_t cell = 0; cell < exact.size(); ++cell) {
    if (exact[cell] == 0) continue;
    std::vector<std::uint64_t> masks(4 * words);
    masks[cell / 64] = std::uint64_t{1} << (cell % 64);
    require((tester.test(ray, times, boxes, {masks.data(), nullptr}).pass & 1) != 0,
            "a cell that the ray touches is not culled, " + std::string(to_string(tester.design())));
  }
}

constexpr int kLargestResolution = 4;

/// The designs that find cells, R = 2 to kLargestResolution.
const std::vector<cull::MaskTester>& testers() {
  static const std::vector<cull::MaskTester> all = [] {
    std::vector<cull::MaskTester> made;
    for (int r = cull::kMinResolution; r <= kLargestResolution; ++r)
      for (const cull::Design design : {cull::Design::Comparators, cull::Design::Ideal, cull::Design::Projection})
        made.emplace_back(design, cull::MaskOptions{.resolution = r, .ray_resolution = r + (r == 3 ? 2 : 0)});
    return made;
  }();
  return all;
}

void check_box(Ray ray, Vec3 lo, Vec3 hi, int resolution) {
  if (!is_finite(lo) || !is_finite(hi)) return;
  for (int axis = 0; axis < 3; ++axis)
    if (lo[axis] > hi[axis]) std::swap(lo[axis], hi[axis]);
  const PreparedRay prepared = intersect::prepare_ray(ray);
  require(prepared.valid == intersect::is_valid(ray), "a ray is prepared iff it is valid");
  if (!prepared.valid) return;
  const Box4 boxes = test::box_in_lane_0(lo, hi);
  const SlabTimes times = intersect::slab_test(prepared, boxes, ray.tmax);
  require(same_bytes(times, intersect::portable::slab_test(prepared, boxes, ray.tmax)), "all forms give the same bits");
  SlabTimes outer{};
  intersect::slab_test_outer(prepared, boxes, ray.tmax, outer);
  require(outer.hit == times.hit && bits(outer.t0[0]) == bits(times.t0[0]) && bits(outer.t1[0]) == bits(times.t1[0]),
          "the outer form gives the same bits");
  check_span(ray, lo, hi, times);
  if ((times.hit & 1) == 0) return;
  const auto cells = [&](oracle::Cells kind) {
    return oracle::exact_ray_cells(ray, lo, hi, resolution, ray.tmin, ray.tmax, kind);
  };
  const CellSet closed = cells(oracle::Cells::Closed), half_open = cells(oracle::Cells::HalfOpen);
  for (const cull::MaskTester& tester : testers()) {
    if (tester.options().resolution != resolution) continue;
    check_cells(tester, cull::reads_tables(tester.design()) ? half_open : closed, prepared, times, boxes);
  }
}

// --- triangles ----------------------------------------------------------------------------------------------------

void check_triangle(const Ray& ray, const Vec3 (&v)[3]) {
  const PreparedRay prepared = intersect::prepare_ray(ray);
  if (!prepared.valid) return;
  for (const Vec3& vertex : v)
    if (!is_finite(vertex)) return;
  const intersect::TriangleResult is = intersect::triangle_test(prepared, v[0], v[1], v[2], ray.tmax);
  const intersect::TriangleResult should = intersect::stated_triangle_test(prepared, v, ray.tmax);
  require(is.hit == should.hit && bits(is.t) == bits(should.t) && bits(is.u) == bits(should.u) &&
              bits(is.v) == bits(should.v),
          "the triangle test gives its stated bits");
  if (!oracle::exact_ray_triangle(ray, v[0], v[1], v[2], ray.tmin, ray.tmax).hit) return;
  const accel::Bvh4 bvh = test::one_leaf({{v[0], v[1], v[2], 0}});
  const SlabTimes times = intersect::slab_test(prepared, bvh.nodes[0].boxes, ray.tmax);
  require((times.hit & 1) != 0, "the box of a triangle that the ray meets is hit");
  for (const cull::MaskTester& tester : testers()) {
    const cull::ObjectMasks masks = cull::build_object_masks(bvh, {.resolution = tester.options().resolution}, 1);
    require((tester.test(prepared, times, bvh.nodes[0].boxes, masks.of(0)).pass & 1) != 0,
            "a triangle that the ray meets is not culled, " + std::string(to_string(tester.design())));
  }
}

}  // namespace

void check_operations(Input input) {
  for (Words words(input); words.holds(10);) {
    const auto operation = static_cast<oracle::Operation>(words.byte() % 4);
    const auto round = static_cast<Round>(words.byte() % 3);
    const float a = words.number(), b = words.number();
    check_operation(operation, round, a, b);
    check_order(a, b);
  }
}

void check_boxes(Input input) {
  for (Words words(input); words.holds(1 + kRayBytes + 2 * kVectorBytes);) {
    const int resolution = cull::kMinResolution + words.byte() % (kLargestResolution - cull::kMinResolution + 1);
    const Ray ray = words.ray();
    const Vec3 lo = words.vector(), hi = words.vector();
    check_box(ray, lo, hi, resolution);
  }
}

void check_triangles(Input input) {
  for (Words words(input); words.holds(kRayBytes + 3 * kVectorBytes);) {
    const Ray ray = words.ray();
    const Vec3 v[3] = {words.vector(), words.vector(), words.vector()};
    check_triangle(ray, v);
  }
}

}  // namespace ctu::fuzz
