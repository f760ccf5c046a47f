// A Verilated tests/rtl/float/wide_bench.sv without registers: all wide units at once.
#pragma once

#include <verilated.h>

#include "tests/rtl/float/wide_vectors.h"

namespace ctu::rtl {

template <class Model>
void set_operands(Model& model, const WideOperands& operands) {
  model.a_i = operands.a;
  model.b_i = operands.b;
  model.c_i = operands.c;
  model.d_i = operands.d;
  model.float_a_i = numeric::bits(operands.float_a);
  model.float_b_i = numeric::bits(operands.float_b);
  model.subtract_i = operands.subtract;
}

template <class Model>
class VerilatedWideUnits {
 public:
  WideResults answer(const WideOperands& operands) {
    set_operands(model_, operands);
    model_.eval();
    return {.converted = model_.converted_o,
            .float_difference = model_.float_difference_o,
            .sum = model_.sum_o[0],
            .product = model_.product_o[0],
            .difference = model_.difference_o[0],
            .quotient = model_.quotient_o[0],
            .ratio = model_.ratio_o[0],
            .root = model_.root_o[0],
            .narrowed = model_.narrowed_o};
  }

 private:
  VerilatedContext context_;
  Model model_{&context_};
};

/// The first difference that `cases` of `operands` find, or nothing.
template <class Model>
std::string wide_difference(VerilatedWideUnits<Model>& units, HardWideOperands& operands, int cases) {
  std::string difference;
  for (int i = 0; i < cases && difference.empty(); ++i) {
    const WideOperands o = operands.next();
    difference = first_difference(o, units.answer(o), exact_results(o));
  }
  return difference;
}

}  // namespace ctu::rtl
