# Units broken on purpose, one way each; the co-simulation must find every one and name where (tests/cosim/mutants.cpp).
# Small and not optimised: they are built to be run for a few thousand cycles.
foreach(mutation IN ITEMS
    WIDE_TIES_AWAY UNMIRRORED_PLANES OPEN_SLAB
    PIPE_ENTERED_WHILE_FROZEN RESULT_INTERVAL_LATE FETCH_READS_UNCOUNTED FETCH_TURN_STAYS
    SCHEDULER_NODES_FIRST NO_TURNS NEAREST_FIRST PORT_TURN_STAYS HIT_LATER_WINS SORT_LANE_TIES)
  string(TOLOWER ${mutation} name)
  string(REPLACE "_" "-" name ${name})
  ctu_rtl_build(${name} MUTATION ${mutation} DESIGN none SLOT_BITS 3 MAX_SETS 16 MAX_WAYS 2 MAX_MSHRS 4
    STACK_ENTRIES 16)
endforeach()
foreach(mutation IN ITEMS PACKET_DOUBTS PACKET_ORIGINS_SWAPPED)
  string(TOLOWER ${mutation} name)
  string(REPLACE "_" "-" name ${name})
  ctu_rtl_build(${name} MUTATION ${mutation} DESIGN none SLOT_BITS 3 MAX_SETS 16 MAX_WAYS 2 MAX_MSHRS 4
    STACK_ENTRIES 16 PACKETS 2 PACKET_ENTRIES 8)
endforeach()
