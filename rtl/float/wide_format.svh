// Wide numbers: what the tests of primitives compute with between its binary32 inputs and its binary32 results. Binary32's
// significand, and an exponent so wide that no number the tests can meet leaves its range; so there are no subnormals,
// infinities or NaNs.
//
//   bit  35      sign
//   bits 34:24   exponent, biased by 1023 as binary64's
//   bits 23:0    significand, its highest bit written out
//   value        (-1)^sign * significand * 2^(exponent - 1023 - 23)
//
// Every unit gives normal numbers: the highest bit of the significand is set, or all 36 bits are 0, which is the only
// zero. So that bit says "not zero", and sign, exponent and the other 23 bits are the upper half of the same number in
// binary64. Operands are normal too, but for those of wide_add: binary32's subnormals and zeros may stand there with
// the exponent of the smallest normal numbers, as wide_from_float gives them without NORMALISE.
//
// Rounding is to nearest, ties to even. From differences of binary32 numbers (2^-149 .. 2^129) the triangle test
// comes to products of four factors, 2^-745 .. 2^392; the sphere test to quotients of products of two by products of two,
// 2^-610 .. 2^560.
//   twin    round24 of model/intersect/round24.h, on binary64
`ifndef CTU_WIDE_FORMAT_SVH
`define CTU_WIDE_FORMAT_SVH

`define WIDE_BITS 36
`define WIDE_SIGN 35
`define WIDE_EXPONENT 34:24
`define WIDE_SIGNIFICAND 23:0
`define WIDE_NOT_ZERO 23

`endif
