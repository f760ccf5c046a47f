// The unit's configuration: everything about it that changes cycles. Nothing here changes what a ray visits, except the
// choice of the mask test's design, which must be the one the tables were built for. Meaning, range and origin of every
// value: parameters() in parameter.h.
#pragma once

#include <cstdint>
#include <string>

#include "model/cull/on_chip_tables.h"
#include "model/cull/options.h"

namespace ctu::pipeline {

enum class SchedulerPolicy : std::uint8_t {
  Oldest,      ///< who waits longest
  RoundRobin,  ///< the next context by number
};
enum class MemoryModel : std::uint8_t { Ideal, Banked };

struct CacheConfig {
  int bytes = 65536;  ///< 0: no cache, every line comes from memory
  int ways = 4;
  int hit_latency = 3;
  int ports = 1;  ///< lines looked up in a cycle
  int mshrs = 16;
};

struct MemoryConfig {
  MemoryModel model = MemoryModel::Banked;
  int line_bytes = 128;
  // ideal
  int latency = 180;
  int interval = 4;
  // banked; t_* as data sheets name them, in cycles of the unit's clock
  int channels = 4;
  int banks = 16;
  int row_bytes = 2048;
  int front_latency = 100;
  int queue_depth = 16;
  int t_rcd = 18, t_rp = 18, t_cl = 18, t_ras = 42;
  int burst = 8;
  int t_rfc = 280, t_refi = 3900;
  int age_cap = 500;
};

struct UnitConfig {
  struct {
    int contexts = 32;
    int batch_cycles = 1000;
  } unit;
  struct {
    int latency = 20;
    int interval = 3;
  } ray_setup;
  struct {
    int packets = 8;
    int latency = 12;
    int interval = 4;
  } packet_cull;  ///< only where rays travel in packets
  struct {
    SchedulerPolicy policy = SchedulerPolicy::Oldest;
  } scheduler;
  CacheConfig node_cache, leaf_cache;
  MemoryConfig memory;
  struct {
    int latency = 5;
  } box_decode;  ///< only where the image's boxes are of reduced precision
  struct {
    int latency = 11;
  } box_test;
  struct {
    int units = 1;
    int latency = 10;
  } cell_locate;
  struct {
    int units = 1;
    int latency = 12;
  } comparators;
  struct {
    cull::Design design = cull::Design::Projection;
    cull::TableRows rows = cull::TableRows::All;
    int latency = 2;
    int second_latency = 1;
    int banks = 4;
    int ports = 1;
    int projection_tables = 3;
  } mask_test;
  CacheConfig table_cache{.bytes = 0};  ///< bytes 0: tables are resident
  struct {
    int latency = 3;
  } child_sort;
  struct {
    int entries = 16;
    int push_width = 2;
    int spill_batch = 8;
  } stack;
  struct {
    int units = 1;
    int latency = 10;
  } primitive_cull;  ///< only where the image has primitive boxes
  struct {
    int latency = 45;
    int interval = 1;
  } triangle_test;
  struct {
    int latency = 89;
  } sphere_test;  ///< only where the image has spheres
  struct {
    int latency = 2;
  } hit_update;
  struct {
    int interval = 1;
  } result;
  struct {
    std::int64_t cycles = 100000;
  } watchdog;
};

}  // namespace ctu::pipeline
