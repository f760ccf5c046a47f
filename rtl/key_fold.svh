// How many rows folded tables have (model/cull/key_fold.h).
//
// On an axis with n cells there are n * n pairs (begin, end). A pair and its mirrored form are one class; n classes are
// their own mirrored reverses.
`ifndef CTU_KEY_FOLD_SVH
`define CTU_KEY_FOLD_SVH

`define CTU_PAIR_CLASSES(n) (((n) * (n) + 1) / 2)
// Classes of keys of `axes` axes under mirroring and, where `reverses`, reversal.
`define CTU_MIRRORED_CLASSES(axes, n, reverses) \
  ((reverses) ? (`CTU_PAIR_CLASSES(n) ** (axes) + (n) ** (axes)) / 2 : `CTU_PAIR_CLASSES(n) ** (axes))
// Pairs of two cells of n^3, the same one twice included, in any order.
`define CTU_REVERSED_CLASSES(n) ((n) * (n) * (n) * ((n) * (n) * (n) + 1) / 2)

`endif
