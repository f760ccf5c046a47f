#include "model/accel/split.h"

namespace ctu::accel {
namespace {

int widest_axis(const Box3& box) { return longest_first(box).axis[0]; }

}  // namespace

AxisOrder longest_first(const Box3& box) {
  alignas(16) float extent[4];
  _mm_store_ps(extent, _mm_sub_ps(box.upper, box.lower));
  AxisOrder order;
  std::stable_sort(order.axis, order.axis + 3, [&](int a, int b) { return extent[a] > extent[b]; });
  return order;
}

namespace detail {

Box3 centre_bounds(std::span<const TriangleRef> refs) {
  Box3 bounds = Box3::empty();
  for (const TriangleRef& ref : refs) bounds.grow(ref.centre2());
  return bounds;
}

Order sorted(std::span<const TriangleRef> refs, int axis) {
  std::array<float, kSweepTriangles> key;
  Order order{};
  for (std::size_t i = 0; i < refs.size(); ++i) {
    const float k = refs[i].centre2(axis);
    std::size_t at = i;
    for (; at > 0 && key[at - 1] > k; --at) {
      key[at] = key[at - 1];
      order[at] = order[at - 1];
    }
    key[at] = k;
    order[at] = static_cast<std::uint8_t>(i);
  }
  return order;
}

}  // namespace detail

std::size_t split_median(std::span<TriangleRef> refs) {
  const int axis = widest_axis(detail::centre_bounds(refs));
  const std::size_t half = refs.size() / 2;
  std::nth_element(refs.begin(), refs.begin() + static_cast<std::ptrdiff_t>(half), refs.end(),
                   [axis](const TriangleRef& a, const TriangleRef& b) {
                     const float ka = a.centre2(axis), kb = b.centre2(axis);
                     return ka != kb ? ka < kb : a.id() < b.id();
                   });
  return half;
}

}  // namespace ctu::accel
