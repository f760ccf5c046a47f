// cache_tags: the tags of a set-associative cache with least-recently-used replacement, looked up combinationally.
//
//   twin    CacheTags (model/pipeline/cache.h)
//
// In a cycle either up to PORTS lines are looked up, the lowest port first, or one line is installed. A way has a rank
// in its set, 0 the last used one; a hit or an install makes its way rank 0 and moves those before it back by one. A
// set that nothing was installed in since the reset counts as new whatever its memory holds, so only `used_q` is reset.
module cache_tags #(
    parameter int LINE_NUMBER_BITS = 27,
    parameter int PORTS = 1,
    parameter int MAX_SETS = 2,  // a power of two
    parameter int MAX_WAYS = 2,
    localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS),
    localparam int WAY_BITS = MAX_WAYS == 1 ? 1 : $clog2(MAX_WAYS)
) (
    input logic clk_i,
    input logic rst_i,

    // Straps.
    input logic [        SET_BITS-1:0] set_mask_i,  // sets in use - 1
    input logic [$clog2(MAX_WAYS+1)-1:0] ways_i,    // in use; 0: no cache, everything misses

    input  logic [PORTS*LINE_NUMBER_BITS-1:0] lines_i,
    output logic [                 PORTS-1:0] hit_o,
    output logic [        PORTS*SET_BITS-1:0] set_o,
    output logic [        PORTS*WAY_BITS-1:0] way_o,
    input  logic [                 PORTS-1:0] touch_i,  // these lookups take place: hits are used now

    // A line that was not there takes the place of the least recently used one. No lookups in this cycle.
    input  logic                        install_i,
    input  logic [LINE_NUMBER_BITS-1:0] install_line_i,
    output logic [        SET_BITS-1:0] install_set_o,
    output logic [        WAY_BITS-1:0] install_way_o
);
  localparam int RANKS_BITS = MAX_WAYS * WAY_BITS;

  // The ranks of a set after a use of `way`.
  function automatic logic [RANKS_BITS-1:0] used(input logic [RANKS_BITS-1:0] ranks, input logic [WAY_BITS-1:0] way);
    logic [WAY_BITS-1:0] rank;
    rank = ranks[WAY_BITS*32'(way)+:WAY_BITS];
    used = ranks;
    for (int w = 0; w < MAX_WAYS; w++) begin
      if (32'(way) == w) used[WAY_BITS*w+:WAY_BITS] = '0;
      else if (ranks[WAY_BITS*w+:WAY_BITS] < rank) used[WAY_BITS*w+:WAY_BITS] = ranks[WAY_BITS*w+:WAY_BITS] + 1'b1;
    end
  endfunction

  logic [MAX_SETS-1:0] used_q;  // something was installed there
  logic [MAX_WAYS+RANKS_BITS-1:0] state_q[MAX_SETS];  // valid ways, ranks

  // The sets that are read: those of the lookups, or port 0's is that of the line to install.
  logic [MAX_WAYS+RANKS_BITS-1:0] fresh;
  logic [PORTS*SET_BITS-1:0] sets;
  logic [PORTS*MAX_WAYS-1:0] valid, match;
  logic [PORTS*RANKS_BITS-1:0] ranks;
  always_comb begin
    fresh = '0;
    for (int w = 0; w < MAX_WAYS; w++) fresh[WAY_BITS*w+:WAY_BITS] = WAY_BITS'(w);
    for (int p = 0; p < PORTS; p++) begin
      sets[SET_BITS*p+:SET_BITS] = SET_BITS'(lines_i[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS]) & set_mask_i;
      if (p == 0 && install_i) sets[SET_BITS*p+:SET_BITS] = SET_BITS'(install_line_i) & set_mask_i;
      {valid[MAX_WAYS*p+:MAX_WAYS], ranks[RANKS_BITS*p+:RANKS_BITS]} = used_q[sets[SET_BITS*p+:SET_BITS]] ?
          state_q[sets[SET_BITS*p+:SET_BITS]] : fresh;
    end
  end
  assign set_o = sets;
  assign install_set_o = sets[SET_BITS-1:0];

  generate
    for (genvar w = 0; w < MAX_WAYS; w++) begin : g_way
      logic [LINE_NUMBER_BITS-1:0] tags_q[MAX_SETS];
      always_ff @(posedge clk_i)
        if (install_i && 32'(install_way_o) == w) tags_q[install_set_o] <= install_line_i;
      for (genvar p = 0; p < PORTS; p++) begin : g_port
        assign match[MAX_WAYS*p+w] = valid[MAX_WAYS*p+w] &&
            tags_q[sets[SET_BITS*p+:SET_BITS]] == lines_i[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS];
      end
    end
  endgenerate

  always_comb begin
    install_way_o = '0;
    for (int w = 0; w < MAX_WAYS; w++)
      if (32'(ranks[WAY_BITS*w+:WAY_BITS]) + 32'd1 == 32'(ways_i)) install_way_o = WAY_BITS'(w);
    way_o = '0;
    for (int p = 0; p < PORTS; p++) begin
      hit_o[p] = match[MAX_WAYS*p+:MAX_WAYS] != '0;
      for (int w = 0; w < MAX_WAYS; w++) if (match[MAX_WAYS*p+w]) way_o[WAY_BITS*p+:WAY_BITS] = WAY_BITS'(w);
    end
  end

  // A port sees the uses by those before it in the same set; the last one of a set writes it.
  logic [PORTS*RANKS_BITS-1:0] ranks_after;
  always_comb begin
    for (int p = 0; p < PORTS; p++) begin
      ranks_after[RANKS_BITS*p+:RANKS_BITS] = ranks[RANKS_BITS*p+:RANKS_BITS];
      for (int earlier = 0; earlier < p; earlier++)
        if (touch_i[earlier] && hit_o[earlier] && sets[SET_BITS*earlier+:SET_BITS] == sets[SET_BITS*p+:SET_BITS])
          ranks_after[RANKS_BITS*p+:RANKS_BITS] = ranks_after[RANKS_BITS*earlier+:RANKS_BITS];
      ranks_after[RANKS_BITS*p+:RANKS_BITS] = used(
          ranks_after[RANKS_BITS*p+:RANKS_BITS],
          p == 0 && install_i ? install_way_o : way_o[WAY_BITS*p+:WAY_BITS]
      );
    end
  end

  wire installs = install_i && ways_i != '0;
  always_ff @(posedge clk_i) begin
`ifndef CTU_MUTATE_FETCH_FIRST_IN_FIRST_OUT
    for (int p = 0; p < PORTS; p++)
      if (touch_i[p] && hit_o[p])
        state_q[sets[SET_BITS*p+:SET_BITS]] <= {valid[MAX_WAYS*p+:MAX_WAYS], ranks_after[RANKS_BITS*p+:RANKS_BITS]};
`endif
    if (installs)
      state_q[install_set_o] <= {valid[MAX_WAYS-1:0] | (MAX_WAYS'(1) << install_way_o), ranks_after[RANKS_BITS-1:0]};
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) used_q <= '0;
    else if (installs) used_q[install_set_o] <= 1'b1;
  end
endmodule
