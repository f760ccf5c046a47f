# The ray queue with five dividers to one, a register in all to more than the divider has steps; and broken ones.
set(ray_queue_sources ${rtl}/tokens.svh ${rtl_float_sources} ${rtl}/pipe_control.sv ${rtl}/ray_queue.sv)
# ray_queue_model(name arguments of the module, -D of mutations ...)
function(ray_queue_model name)
  ctu_verilate(rtl_${name} PREFIX V${name} TOP ray_queue SOURCES ${ray_queue_sources} ARGS
    --x-initial unique ${ARGN})
  list(APPEND ray_queue_models rtl_${name})
  set(ray_queue_models ${ray_queue_models} PARENT_SCOPE)
endfunction()
ray_queue_model(RayQueue)
ray_queue_model(RayQueueParallel -GMIN_INTERVAL=1 -GLATENCY=1 -GSLOT_BITS=8 -GTREES=3)
ray_queue_model(RayQueueShort -GMIN_INTERVAL=2 -GLATENCY=6 -GSLOT_BITS=2)
ray_queue_model(RayQueueSerial -GMIN_INTERVAL=7 -GLATENCY=41 -GSLOT_BITS=3)
foreach(name IN ITEMS RayFreedFirst RayEmptyRange RayTiedAxes RayUnswappedAxes RayFirstTree)
  rtl_mutation_define(define ${name})
  ray_queue_model(Mutant${name} -GMIN_INTERVAL=5 -GLATENCY=2 -GSLOT_BITS=3 -GTREES=3 ${define})
endforeach()
ctu_test(test_rtl_ray_queue
  SOURCES ray_queue_test.cpp ../../intersect/hostile_boxes.cpp
  DEPENDS ctu_pipeline_test_support ${ray_queue_models}
  LABEL property)

rtl_check(ray_queue SOURCES ${ray_queue_sources} WORD_LEVEL)
rtl_check(ray_queue SOURCES ${ray_queue_sources} VARIANT trees PARAMETERS TREES=5)
