// What miss_registers promises (rtl/miss_registers.sv) to a fetch that keeps its rules, as line_fetch does.
//
// For any line and any context, named by line_i and slot_i: registers are taken and given back one by one, a line has
// one at most, and the context is among the waiters of the one release of its line when it has waited for it, and in
// no other.
module miss_registers_properties #(
    parameter int SLOT_BITS = 1,
    parameter int LINE_NUMBER_BITS = 3,
    parameter int MAX_MSHRS = 4,
    localparam int PORTS = 2,
    localparam int NUMBER_BITS = $clog2(MAX_MSHRS),
    localparam int COUNT_BITS = $clog2(MAX_MSHRS + 1)
) (
    input logic                              clk_i,
    input logic                              rst_i,
    input logic [            COUNT_BITS-1:0] mshrs_i,
    input logic [PORTS*LINE_NUMBER_BITS-1:0] lines_i,
    input logic [                 PORTS-1:0] wait_i,
    input logic [             SLOT_BITS-1:0] wait_slot_i,
    input logic                              allocate_i,
    input logic                              release_i,
    input logic [           NUMBER_BITS-1:0] release_number_i,
    input logic [      LINE_NUMBER_BITS-1:0] line_i,
    input logic [             SLOT_BITS-1:0] slot_i
);
  logic [PORTS-1:0] found;
  logic full, last, none_in_use;
  logic [NUMBER_BITS-1:0] free;
  logic [LINE_NUMBER_BITS-1:0] allocated, release_line;
  logic [(1<<SLOT_BITS)-1:0] waiters;
  miss_registers #(
      .SLOT_BITS(SLOT_BITS),
      .LINE_NUMBER_BITS(LINE_NUMBER_BITS),
      .PORTS(PORTS),
      .MAX_MSHRS(MAX_MSHRS)
  ) dut (
      .clk_i,
      .rst_i,
      .mshrs_i,
      .lines_i,
      .found_o(found),
      .full_o(full),
      .last_o(last),
      .none_in_use_o(none_in_use),
      .free_o(free),
      .wait_i,
      .wait_slot_i,
      .allocate_i,
      .allocate_line_i(allocated),
      .release_i,
      .release_number_i,
      .release_line_o(release_line),
      .release_waiters_o(waiters)
  );
  wire [LINE_NUMBER_BITS-1:0] first = lines_i[0+:LINE_NUMBER_BITS];
  wire [LINE_NUMBER_BITS-1:0] second = lines_i[LINE_NUMBER_BITS+:LINE_NUMBER_BITS];
  assign allocated = wait_i[0] && !found[0] ? first : second;

  // Which registers are in use; whether one has the line, which, and whether the context waits for it.
  logic [MAX_MSHRS-1:0] in_use_q;
  logic asked_q, waits_q;
  logic [NUMBER_BITS-1:0] number_q;
  wire asks = allocate_i && allocated == line_i;
  wire waits = wait_slot_i == slot_i && ((wait_i[0] && first == line_i) || (wait_i[1] && second == line_i));
  wire returns = release_i && asked_q && release_number_i == number_q;
  logic started_q = 1'b0;
  logic [COUNT_BITS-1:0] mshrs_q;
  always_ff @(posedge clk_i) begin
    started_q <= 1'b1;
    mshrs_q <= mshrs_i;
    if (rst_i) in_use_q <= '0;
    else in_use_q <= (in_use_q & ~(release_i ? MAX_MSHRS'(1) << release_number_i : '0)) |
                     (allocate_i ? MAX_MSHRS'(1) << free : '0);
    asked_q <= !rst_i && (asks || (asked_q && !returns));
    waits_q <= !rst_i && (waits || (waits_q && !returns));
    if (asks) number_q <= free;
  end

  // Any line and context, the same ones all the time; the strap stays; the rules of the ports.
  logic [LINE_NUMBER_BITS-1:0] line_q;
  logic [SLOT_BITS-1:0] slot_q;
  always_ff @(posedge clk_i) begin
    line_q <= line_i;
    slot_q <= slot_i;
  end
  always_comb begin
    assume (started_q || rst_i);
    assume (!started_q || (line_i == line_q && slot_i == slot_q && mshrs_i == mshrs_q));
    assume (mshrs_i != '0 && 32'(mshrs_i) <= MAX_MSHRS);
    assume (first != second);
    assume (!release_i || (in_use_q[release_number_i] && wait_i == '0));
    assume (allocate_i == ((wait_i & ~found) != '0) && (wait_i & ~found) != '1);
    assume (!allocate_i || !full);
    assume (!waits || !waits_q);  // a context waits for a line once
  end

  logic [COUNT_BITS-1:0] free_count;
  logic [NUMBER_BITS-1:0] lowest;
  always_comb begin
    free_count = '0;
    lowest = '0;
    for (int m = MAX_MSHRS - 1; m >= 0; m--)
      if (!in_use_q[m] && m < 32'(mshrs_i)) begin
        free_count = free_count + 1'b1;
        lowest = NUMBER_BITS'(m);
      end
    if (started_q) begin
      flags : assert (full == (free_count == '0) && last == (32'(free_count) == 1) && none_in_use == (in_use_q == '0));
      lowest_free : assert (full || free == lowest);
      finds : assert ((first != line_i || found[0] == asked_q) && (second != line_i || found[1] == asked_q));
      returned : assert (!returns || (release_line == line_i && waiters[slot_i] == waits_q));
      once : assert (!release_i || returns || release_line != line_i);
      asked_for : assert (!waits_q || asked_q);
      all_taken : cover (returns && waits_q && waiters == '1 && full && 32'(mshrs_i) == MAX_MSHRS);
      without : cover (returns && !waits_q && waiters != '0);
      again : cover (asks && waits && number_q != free && none_in_use);
      joins : cover (waits && !asks && allocate_i);
    end
  end

`ifdef CTU_INVARIANTS
  // Registers inside, under the names that they have after flattening.
  (* hierconn *) wire [MAX_MSHRS-1:0] \dut.in_use_q ;
  (* hierconn *) wire [LINE_NUMBER_BITS-1:0] \dut.lines_q[0] , \dut.lines_q[1] , \dut.lines_q[2] , \dut.lines_q[3] ;
  (* hierconn *) wire [(1<<SLOT_BITS)-1:0] \dut.waiters_q[0] , \dut.waiters_q[1] ;
  (* hierconn *) wire [(1<<SLOT_BITS)-1:0] \dut.waiters_q[2] , \dut.waiters_q[3] ;
  wire [4*LINE_NUMBER_BITS-1:0] lines = {\dut.lines_q[3] , \dut.lines_q[2] , \dut.lines_q[1] , \dut.lines_q[0] };
  wire [3:0] waiting = {
    \dut.waiters_q[3] [slot_i], \dut.waiters_q[2] [slot_i], \dut.waiters_q[1] [slot_i], \dut.waiters_q[0] [slot_i]
  };
  logic [MAX_MSHRS-1:0] with_line;
  always_comb begin
    for (int m = 0; m < MAX_MSHRS; m++)
      with_line[m] = in_use_q[m] && lines[LINE_NUMBER_BITS*m+:LINE_NUMBER_BITS] == line_i;
    if (started_q) begin
      in_use : assert (\dut.in_use_q == in_use_q && in_use_q >> mshrs_i == '0);
      one_register : assert (with_line == (asked_q ? MAX_MSHRS'(1) << number_q : '0));
      context_waits : assert (!asked_q || waiting[number_q] == waits_q);
    end
  end
`endif
endmodule
