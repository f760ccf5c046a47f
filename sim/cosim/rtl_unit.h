// One Verilated build of the unit, whatever its parameters are.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/cull/options.h"
#include "model/intersect/ray.h"
#include "model/pipeline/memory_client.h"
#include "model/pipeline/unit_config.h"
#include "sim/cosim/link_names.h"
#include "sim/cosim/token_bits.h"

namespace ctu::cosim {

/// What a build fixes: its structure and the depth of its arithmetic. Everything else is a strap.
struct RtlParameters {
  std::string name;
  cull::Design design = cull::Design::None;
  int resolution = 4, ray_resolution = 4;
  int entries = 0;  ///< of the compression LUT; 0: masks are not compressed
  cull::TableRows rows = cull::TableRows::All;
  int banks = 4, ports = 1, projection_tables = 3;
  int locate_units = 1;
  bool table_cache = false;
  int node_ports = 1, leaf_ports = 1, table_ports = 1;
  int line_bytes = 128;
  std::uint32_t box_bits = 32;                    ///< of a coordinate of the image's boxes
  bool primitive_boxes = false, spheres = false;  ///< the image has them
  int cull_units = 1;
  int packets = 0;          ///< of rays, under way at once, at most; 0: rays travel alone
  int packet_entries = 16;  ///< of a packet, at most
  int packet_interval = 4;  ///< at least
  int trees = 1;            ///< of the image, at most; 1: no table of roots
  int max_leaf_bytes = 160;
  int slot_bits = 6;
  int stack_entries = 16;  ///< on chip, at most
  bool has_spills = true;
  int distinct = 0;    ///< rows of dedup's second memory
  int max_sets = 256;  ///< of each cache
  int max_ways = 8;
  int max_mshrs = 64;
  int ray_interval = 3;  ///< at least
  int ray_setup_latency = 20, decode_latency = 5, box_latency = 11, locate_latency = 10, mask_latency = 2,
      mask_second_latency = 1, sort_latency = 3, cull_latency = 10, packet_latency = 12, triangle_latency = 45,
      sphere_latency = 89, hit_latency = 2;
};

/// Where image, spilled entries and tables lie: what the unit is told before a run.
struct ImageStraps {
  std::uint64_t node_base = 0, node_stride = 0, masked_nodes = 0, bare_base = 0, bare_stride = 0;
  std::uint64_t triangle_base = 0, triangle_stride = 0;
  std::uint64_t spill_base = 0, spill_region = 0;
  std::uint64_t full_index = 0;  ///< of compressed masks, the last entry's
  int packet_entries = 1;        ///< of a packet at most, where rays travel in packets
  std::array<std::uint64_t, 4> table_base{};
  int bit_row_shift = 0;  ///< log2 of a bit row's bytes
};

/// Both sides of a link in one cycle.
struct LinkState {
  bool valid = false, ready = false, popped = false, pushed = false;
  TokenBits token{};  ///< what is pushed
};

/// What the unit is given in a cycle.
struct UnitInputs {
  const intersect::Ray* ray = nullptr;             ///< the next one, if there is one
  bool ray_closes = false;                         ///< it is the last one of its packet
  std::uint32_t ray_tree = 0;                      ///< number of the tree that it walks
  std::uint64_t stall_push = 0, stall_pop = 0;     ///< bit link: refuses
  const pipeline::ClientAnswer* answer = nullptr;  ///< of memory, if one is ready
  std::span<const std::uint8_t> answer_line;
  bool memory_busy = false;  ///< something is under way in it at the start of the cycle
};

/// What memory is asked for.
struct RtlRequest {
  bool valid = false;
  pipeline::ClientRequest request;
  std::vector<std::uint32_t> line;
};

struct ReturnedRay {
  bool valid = false;
  pipeline::Slot slot = 0;
  intersect::Hit hit;
};

class RtlUnit {
 public:
  virtual ~RtlUnit() = default;
  virtual const RtlParameters& parameters() const = 0;

  /// Sets the straps, and resets.
  virtual void configure(const pipeline::UnitConfig& config, const ImageStraps& straps) = 0;
  /// Writes one row of one of the design's tables; before the run.
  virtual void load_row(int table, std::uint32_t row, std::span<const std::uint64_t> words) = 0;

  /// Where a tree begins, in a build that has several; before the run.
  virtual void load_root(std::uint32_t tree, std::uint32_t root) = 0;

  // A cycle, in this order: begin_cycle, asked, settle; then what it does is known, until end_cycle.
  virtual void begin_cycle(const UnitInputs& inputs) = 0;
  /// Whether the client has a request in this cycle, and for which address.
  virtual bool asked(pipeline::Client client, std::uint64_t& address) const = 0;
  /// Bit c of `can_accept`: memory can take client c's request.
  virtual void settle(unsigned can_accept) = 0;
  virtual void end_cycle() = 0;

  virtual RtlRequest request() const = 0;
  virtual bool answer_taken() const = 0;
  virtual bool ray_taken(pipeline::Slot& slot) const = 0;
  virtual ReturnedRay returned() const = 0;
  /// Whether the ray in `slot` needs a row that mask_test.rows leaves out.
  virtual bool row_left_out(pipeline::Slot& slot) const = 0;
  virtual LinkState link(int number) const = 0;
  virtual int activity(int stage) const = 0;
};

}  // namespace ctu::cosim
