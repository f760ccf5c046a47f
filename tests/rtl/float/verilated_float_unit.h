// A Verilated tests/rtl/float/float_bench.sv as a FloatUnit.
#pragma once

#include <verilated.h>

#include <algorithm>

#include "tests/rtl/float/float_operations.h"

namespace ctu::rtl {

template <class Model>
class VerilatedFloatUnit final : public FloatUnit {
 public:
  void answer(const Operation& operation, Round round, const std::vector<Pair>& pairs,
              std::vector<std::uint32_t>& results) override {
    results.resize(pairs.size());
    model_.select_i = operation.select;
    model_.round_i = static_cast<std::uint8_t>(round);
    constexpr std::size_t kLanes = sizeof model_.a_i / sizeof(std::uint32_t);
    for (std::size_t first = 0; first < pairs.size(); first += kLanes) {
      const std::size_t lanes = std::min(kLanes, pairs.size() - first);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        model_.a_i[lane] = numeric::bits(pairs[first + lane].first);
        model_.b_i[lane] = numeric::bits(pairs[first + lane].second);
      }
      model_.eval();
      for (std::size_t lane = 0; lane < lanes; ++lane) results[first + lane] = model_.result_o[lane];
    }
  }

 private:
  VerilatedContext context_;
  Model model_{&context_};
};

}  // namespace ctu::rtl
