// The tokens on the links (model/pipeline/tokens.h) as flat vectors, highest bits first:
//
//   slot      {slot}                                                       SLOT_BITS
//   ref       {slot, reference[31:0]}                                      also of leaves; where rays travel in packets
//                                                                          above it to node_fetch: it is a packet's
//   node      {slot, hits[3:0], survivors[3:0], order[7:0], asked[3:0]}    order: lane of place p at [2p+1:2p]
//   culled    {slot, met[15:0], reference[31:0]}                           of leaves from primitive_cull
//   tested    {slot, index[3:0], last, hit, t, u, v, primitive}            t, u, v are 0 where hit is 0
//   leaf done {slot, finished}
//   join      {slot, joins, closes}                                        rays on their way to a packet
//   start     {slot, packet, last}                                         rays that begin with their packet's entries
//   packet    {packet}
//   request   {address, id[7:0], write, data}                              data: a line, of writes; else left out
//                                                                          (what counts of it: the batch at address)
//   response  {id[7:0], data}                                              data: the line; id of the request
//
// SLOT_BITS, ADDRESS_BITS and the bits of a packet's number are parameters of the modules. Lanes and axes lie with the first one in the lowest bits.
`ifndef CTU_TOKENS_SVH
`define CTU_TOKENS_SVH

`define CTU_NODE_FIELDS 20    // hits, survivors, order, asked
`define CTU_TESTED_FIELDS 134 // index, last, hit, t, u, v, primitive
`define CTU_ID_BITS 8

// Activities as in enum Activity (model/pipeline/accounting.h).
`define CTU_BUSY 4'd0
`define CTU_IDLE 4'd1
`define CTU_OUTPUT_FULL 4'd2
`define CTU_NO_CONTEXT 4'd3
`define CTU_BANK_CONFLICT 4'd4
`define CTU_MSHRS_FULL 4'd5
`define CTU_MEMORY_PORT_FULL 4'd6
`define CTU_FILL_PORT 4'd7
`define CTU_MEMORY 4'd8
`define CTU_SPILL 4'd9
`define CTU_INTERVAL 4'd10
`define CTU_NO_PACKET 4'd11

`endif
