#!/usr/bin/env bash
# prove.sh MODE DEPTH TOP PARAMETERS FILE.smt2 OPTIONS SOURCES...: one run of yosys-smtbmc on a module
# with properties.
#
#   induction  the properties hold in the first DEPTH cycles, and DEPTH cycles in which they held are followed by one in
#              which they do: they hold always
#   bounded    they hold in the first DEPTH cycles
#   cover      every cover statement is reached within DEPTH cycles, under the assumptions
#   mutant     an assertion fails within DEPTH cycles; invariants of what is inside are left out, so ports show it
#
# PARAMETERS are those of the module, as "NAME=VALUE ..."; OPTIONS those of yosys's read_verilog. YOSYS names the
# program, if it is not `yosys`; yosys-smtbmc lies beside it.
set -euo pipefail
mode=$1 depth=$2 top=$3 parameters=$4 model=$5 options=$6
shift 6
yosys=${YOSYS:-yosys}
# Unrolled, as z3 takes long to expand nested definitions; there are no arrays, as memories are made registers.
smtbmc() { "$yosys-smtbmc" -s z3 --unroll --logic QF_BV --noprogress "$@" "$model"; }

mkdir -p "$(dirname "$model")"
case $mode in induction | bounded) options+=" -DCTU_INVARIANTS" ;; esac
settings=
for parameter in $parameters; do settings+=" -chparam ${parameter/=/ }"; done
"$yosys" -q -e '.*' \
  -p "read_verilog -sv -formal -mem2reg $options $*; \
hierarchy -top $top$settings; prep -flatten; async2sync; dffunmap; write_smt2 -wires $model"

# A proof of nothing is none.
assertions=$(grep -c '^; yosys-smt2-assert ' "$model" || true)
[ "$assertions" -gt 0 ] || { echo "$top has no assertions"; exit 1; }
echo "$top: $assertions assertions"

case $mode in
  induction)
    smtbmc -t "$depth"
    smtbmc -i -t "$depth"
    ;;
  bounded) smtbmc -t "$depth" ;;
  cover)
    grep -q '^; yosys-smt2-cover ' "$model" || { echo "$top covers nothing"; exit 1; }
    smtbmc -c -t "$depth"
    ;;
  mutant)
    if found=$(smtbmc -t "$depth"); then
      echo "$found"
      echo "no counterexample for the broken one"
      exit 1
    fi
    echo "$found"
    grep -q 'Assert failed' <<<"$found"
    ;;
  *)
    echo "no mode $mode"
    exit 2
    ;;
esac
