// What a unit keeps of the rays of a packet (ctu::cull::packet::PacketSlabs, model/cull/packet/packet_slabs.h) as one
// flat vector: three axes, x lowest, then the first begin and the last end of any ray, the last begin and the first end.
//
// An axis, lowest bits first: least and greatest origin, least and greatest bound of the reciprocals of the rays that
// move, whether some ray moves up, moves down, stands.
`ifndef CTU_PACKET_BOUNDS_SVH
`define CTU_PACKET_BOUNDS_SVH

`define CTU_PACKET_AXIS 131
`define CTU_PACKET_ORIGIN_LO 0
`define CTU_PACKET_ORIGIN_HI 32
`define CTU_PACKET_RCP_LO 64
`define CTU_PACKET_RCP_HI 96
`define CTU_PACKET_UP 128
`define CTU_PACKET_DOWN 129
`define CTU_PACKET_STILL 130
`define CTU_PACKET_BEGINS 393
`define CTU_PACKET_ENDS 425
`define CTU_PACKET_ALL_BEGUN 457
`define CTU_PACKET_FIRST_END 489
`define CTU_PACKET_BITS 521

`endif
