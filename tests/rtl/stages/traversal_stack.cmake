# The stack: rows of banks wider than a line, as wide, and narrower; without memory; and broken ones.
set(traversal_stack_sources ${rtl}/tokens.svh ${rtl}/float/float_compare.sv ${rtl}/traversal_stack.sv)
# traversal_stack_model(name arguments of the module, -D of mutations ...)
function(traversal_stack_model name)
  ctu_verilate(rtl_traversal_stack_models PREFIX V${name} TOP traversal_stack SOURCES ${traversal_stack_sources} ARGS
    --x-initial unique ${ARGN})
endfunction()
traversal_stack_model(TraversalStackWide -GSLOT_BITS=5 -GMAX_ENTRIES=64 -GDEPTH_BITS=9)
traversal_stack_model(TraversalStack)
traversal_stack_model(TraversalStackNarrow -GSLOT_BITS=8 -GMAX_ENTRIES=4 -GLINE_BYTES=512)
traversal_stack_model(TraversalStackNoSpills -GSLOT_BITS=3 -GMAX_ENTRIES=64 -GHAS_SPILLS=0)
foreach(name IN ITEMS KeptDepth NoTurns NearestFirst RefillOldest)
  rtl_mutation_define(define ${name})
  traversal_stack_model(StackMutant${name} ${define})
endforeach()
ctu_test(test_rtl_traversal_stack
  SOURCES traversal_stack_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_traversal_stack_models
  LABEL property)

rtl_check(traversal_stack SOURCES ${traversal_stack_sources} WORD_LEVEL)
