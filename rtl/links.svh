// Numbers of the unit's links and stages: places in the vectors of ctu_unit.sv. What a unit leaves out keeps its number.
`ifndef CTU_LINKS_SVH
`define CTU_LINKS_SVH

`define CTU_RAY_TO_SCHEDULER 0
`define CTU_RAY_TO_RESULT 1
`define CTU_RESULT_TO_RAY 2
`define CTU_SCHEDULER_TO_NODE 3
`define CTU_SCHEDULER_TO_LEAF 4
`define CTU_NODE_TO_BOX 5
`define CTU_BOX_TO_LOCATE 6
`define CTU_LOCATE_TO_TABLE 7
`define CTU_TABLE_TO_MASK 8
`define CTU_LOCATE_TO_MASK 9
`define CTU_MASK_TO_SORT 10
`define CTU_BOX_TO_SORT 11
`define CTU_SORT_TO_STACK 12
`define CTU_LEAF_TO_TRIANGLE 13
`define CTU_TRIANGLE_TO_HIT 14
`define CTU_HIT_TO_STACK 15
`define CTU_STACK_TO_SCHEDULER 16
`define CTU_STACK_TO_RESULT 17
`define CTU_NODE_TO_MEMORY 18
`define CTU_MEMORY_TO_NODE 19
`define CTU_LEAF_TO_MEMORY 20
`define CTU_MEMORY_TO_LEAF 21
`define CTU_STACK_TO_MEMORY 22
`define CTU_MEMORY_TO_STACK 23
`define CTU_TABLE_TO_MEMORY 24
`define CTU_MEMORY_TO_TABLE 25
`define CTU_LINKS 26

`define CTU_RAY_QUEUE 0
`define CTU_SCHEDULER 1
`define CTU_NODE_FETCH 2
`define CTU_BOX_TEST 3
`define CTU_CELL_LOCATE 4
`define CTU_TABLE_FETCH 5
`define CTU_MASK_TEST 6
`define CTU_CHILD_SORT 7
`define CTU_TRAVERSAL_STACK 8
`define CTU_LEAF_FETCH 9
`define CTU_TRIANGLE_TEST 10
`define CTU_HIT_UPDATE 11
`define CTU_RESULT_QUEUE 12
`define CTU_MEMORY_PORT 13
`define CTU_STAGES 14

`endif
