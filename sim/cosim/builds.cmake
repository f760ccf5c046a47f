# The builds of the RTL unit. Those marked ALL are built with everything else, and the test suite's share of the grid runs
# on them; the others by the target rtl_builds. Depths differ, so that no number is right by chance.
# Those marked COVERAGE are built by rtl_coverage_builds once more, for `./dev coverage`.
ctu_rtl_build(projection ALL SLOT_BITS 6 TREES 256 COVERAGE line)
ctu_rtl_build(none ALL DESIGN none BOX_LATENCY 5 SORT_LATENCY 1 TRIANGLE_LATENCY 20 HIT_LATENCY 1
  RAY_SETUP_LATENCY 7 NODE_PORTS 2)
ctu_rtl_build(mask-lut ALL DESIGN mask-lut UNITS 2 BANKS 2 PORTS 2 BOX_LATENCY 1 LOCATE_LATENCY 1 MASK_LATENCY 1
  SORT_LATENCY 2 TRIANGLE_LATENCY 1 HIT_LATENCY 1 RAY_SETUP_LATENCY 1)
ctu_rtl_build(bit-table ALL DESIGN bit-table ENTRIES 256 BANKS 8 UNITS 3 MASK_LATENCY 3 SORT_LATENCY 4 LEAF_PORTS 2)
ctu_rtl_build(dedup ALL DESIGN dedup BANKS 2 MASK_SECOND_LATENCY 2 BOX_LATENCY 14 TRIANGLE_LATENCY 50 HIT_LATENCY 4
  COVERAGE line toggle)
ctu_rtl_build(comparators ALL DESIGN comparators UNITS 4 LOCATE_LATENCY 12 RAY_SETUP_LATENCY 31)

# Tables behind a cache: numbered masks of reachable keys, in two rounds and the shortest lines.
ctu_rtl_build(dedup-cached ALL DESIGN dedup ROWS reachable DISTINCT 226 TABLE_CACHE 1 TABLE_PORTS 2 LINE_BYTES 32
  SLOT_BITS 3 MAX_SETS 16 MAX_WAYS 4 STACK_ENTRIES 16 MASK_LATENCY 1 LEAF_PORTS 2 TRIANGLE_LATENCY 30 COVERAGE line)
# The other kinds of rows behind a cache: three short ones for a key, and one long one.
ctu_rtl_build(projection-cached TABLE_CACHE 1 LINE_BYTES 64 SLOT_BITS 3 MAX_SETS 32 MAX_WAYS 4 MASK_LATENCY 3)
ctu_rtl_build(bit-table-cached DESIGN bit-table ENTRIES 64 TABLE_CACHE 1 TABLE_PORTS 4 SLOT_BITS 2 MAX_SETS 16 MAX_WAYS 2
  UNITS 2)

ctu_rtl_build(mask-lut-256 DESIGN mask-lut ENTRIES 256 BANKS 1)
ctu_rtl_build(projection-r6 R 6 R_RAY 6 PROJECTION_TABLES 1 BANKS 8)
ctu_rtl_build(projection-r-ray-8 R_RAY 8 UNITS 4 PORTS 4)
ctu_rtl_build(boxes-8 BOX_BITS 8 SLOT_BITS 6 COVERAGE line)
ctu_rtl_build(boxes-16 BOX_BITS 16 DECODE_LATENCY 1 DESIGN comparators ENTRIES 64 UNITS 2 LOCATE_LATENCY 8 BOX_LATENCY 4
  NODE_PORTS 2)
# What leaves may hold: a box beside every primitive, spheres, both.
ctu_rtl_build(ray-boxes ALL DESIGN none PRIMITIVE_BOXES 1 MAX_LEAF_BYTES 512 CULL_LATENCY 4 TRIANGLE_LATENCY 13)
ctu_rtl_build(ray-boxes-spheres ALL PRIMITIVE_BOXES 1 SPHERES 1 CULL_UNITS 2 MAX_LEAF_BYTES 256 SLOT_BITS 4)
ctu_rtl_build(spheres DESIGN comparators SPHERES 1 SPHERE_LATENCY 20 SLOT_BITS 3 LEAF_PORTS 2)
# Rays in packets: the default unit with them; and with ray boxes in the leaves and boxes of reduced precision as well.
ctu_rtl_build(packets ALL PACKETS 8 SLOT_BITS 6 TREES 256)
ctu_rtl_build(packets-ray-boxes DESIGN mask-lut PRIMITIVE_BOXES 1 BOX_BITS 8 DECODE_LATENCY 2 PACKETS 3 PACKET_ENTRIES 5
  MIN_PACKET_INTERVAL 1 PACKET_LATENCY 3 MAX_SETS 128 MAX_WAYS 4 MAX_LEAF_BYTES 256 BOX_LATENCY 4 CULL_LATENCY 4
  TRIANGLE_LATENCY 13)

ctu_rtl_build(comparators-r6 DESIGN comparators R 6 R_RAY 6 ENTRIES 64 LOCATE_LATENCY 3)
