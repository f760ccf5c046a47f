ctu_library(ctu_fast_tracer SOURCES closest_hit.cpp node8.cpp DEPENDS ctu_accel ctu_intersect)
