#include "tests/numeric/flag_kernel.h"

#include "model/numeric/lanes.h"
#include "model/numeric/round.h"

namespace {

using ctu::numeric::Float4;
using ctu::numeric::Round;

/// Plain loops over arrays, as a vectorizer likes them.
template <class F>
std::uint32_t* each(F f, const float* a, const float* b, std::size_t count, std::uint32_t* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = ctu::numeric::bits(f(a[i], b[i]));
  return out + count;
}

template <class F>
std::uint32_t* four(F f, const float* a, const float* b, std::size_t count, std::uint32_t* out) {
  for (std::size_t i = 0; i < count; i += 4) {
    const Float4 result = f(ctu::numeric::load4(a + i), ctu::numeric::load4(b + i));
    for (std::size_t lane = 0; lane < 4; ++lane) out[i + lane] = ctu::numeric::bits(result[lane]);
  }
  return out + count;
}

template <Round M>
std::uint32_t* operations(const float* a, const float* b, std::size_t count, std::uint32_t* out) {
  using namespace ctu::numeric;
  out = each([](float x, float y) { return add<M>(x, y); }, a, b, count, out);
  out = each([](float x, float y) { return sub<M>(x, y); }, a, b, count, out);
  out = each([](float x, float y) { return mul<M>(x, y); }, a, b, count, out);
  out = each([](float x, float y) { return div<M>(x, y); }, a, b, count, out);
  out = four([](Float4 x, Float4 y) { return add<M>(x, y); }, a, b, count, out);
  out = four([](Float4 x, Float4 y) { return sub<M>(x, y); }, a, b, count, out);
  out = four([](Float4 x, Float4 y) { return mul<M>(x, y); }, a, b, count, out);
  return four([](Float4 x, Float4 y) { return div<M>(x, y); }, a, b, count, out);
}

}  // namespace

void CTU_KERNEL(const float* a, const float* b, std::size_t count, std::uint32_t* out) {
  out = operations<Round::Nearest>(a, b, count, out);
  out = operations<Round::Down>(a, b, count, out);
  out = operations<Round::Up>(a, b, count, out);
  out = each([](float x, float y) { return ctu::numeric::min(x, y); }, a, b, count, out);
  each([](float x, float y) { return ctu::numeric::max(x, y); }, a, b, count, out);
}
