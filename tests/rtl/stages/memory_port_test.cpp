// rtl/memory_port.sv, with the model's memory behind it, against the model's port within a unit at work.
#include "VMemoryPort2.h"
#include "VMemoryPort4.h"
#include "VMutantPortPushesUnasked.h"
#include "VMutantPortTurnStays.h"
#include "VMutantPortWaitsForAll.h"
#include "tests/oracle/seed.h"
#include "tests/rtl/stages/stage_run.h"

namespace ctu::rtl {
namespace {

using pipeline::Activity;
using pipeline::BankedMemory;
using pipeline::Client;
using pipeline::ClientAnswer;
using pipeline::IdealMemory;
using pipeline::MemoryModel;
using pipeline::MemoryRequest;
using pipeline::UnitConfig;

constexpr int kAddressBits = 40;
constexpr int kLineWords = 8;

bool takes(const IdealMemory& memory, Cycle now, std::uint64_t) { return memory.can_accept(now); }
bool takes(const BankedMemory& memory, Cycle, std::uint64_t address) { return memory.can_accept(address); }

struct Compared {
  std::string difference;
  std::uint64_t cycles_of[pipeline::kActivities] = {};
  std::uint64_t requests_of[pipeline::kClients] = {};
};

/// The twin with a memory of its own, beside the model's port.
template <class Model, class Memory>
class Twin {
 public:
  Twin(const UnitConfig& config, int clients) : clients_(clients), memory_(config.memory) { reset(twin_); }

  template <class Stage>
  std::string cycle(Cycle now, const Stage& model, Compared& compared) {
    drive(now, model);
    compare(model, compared);
    step_memory(now);
    clock(twin_);
    return difference_.take();
  }

 private:
  template <class Stage>
  void drive(Cycle now, const Stage& model) {
    BitWriter requests(&twin_.requests_data_i[0]);
    unsigned valid = 0, ready = 0;
    for (int c = 0; c < clients_; ++c) {
      const auto& in = model.requests[c];
      valid |= static_cast<unsigned>(in.valid) << c;
      ready |= static_cast<unsigned>(model.answers[c].ready) << c;
      requests.put(in.token.write, 1).put(in.token.id, 8).put(in.token.address, kAddressBits);
    }
    twin_.requests_valid_i = static_cast<std::uint8_t>(valid);
    twin_.answers_ready_i = static_cast<std::uint8_t>(ready);
    for (int w = 0; w < kLineWords; ++w) twin_.write_data_i[w] = word(now, w);
    twin_.eval();

    BitReader addresses(&twin_.mem_address_o[0]);
    unsigned accepts = 0;
    for (int c = 0; c < clients_; ++c)
      accepts |= static_cast<unsigned>(takes(memory_, now, addresses.take(kAddressBits))) << c;
    twin_.mem_accepts_i = static_cast<std::uint8_t>(accepts);
    twin_.mem_answer_valid_i = memory_.answer_ready(now);
    const ClientAnswer answer = memory_.answer_ready(now) ? memory_.answer() : ClientAnswer{};
    twin_.mem_answer_client_i = static_cast<std::uint8_t>(answer.client);
    BitWriter data(&twin_.mem_answer_data_i[0]);
    for (int w = 0; w < kLineWords; ++w) data.put(word(now + 1, w), 32);
    data.put(answer.id, 8);
    twin_.mem_busy_i = !memory_.empty();
    twin_.eval();
    for (int w = 0; w < kLineWords; ++w) {
      difference_.same("written line", twin_.mem_write_data_o[w], word(now, w));
      difference_.same("line", twin_.answers_data_o[w], word(now + 1, w));
    }
  }

  /// What a line holds in word `w`: nothing twice in a row.
  static std::uint32_t word(Cycle now, int w) {
    return static_cast<std::uint32_t>(pipeline::mix64(now * 64 + static_cast<unsigned>(w)));
  }

  template <class Stage>
  void compare(const Stage& model, Compared& compared) {
    for (int c = 0; c < pipeline::kClients; ++c) {
      const unsigned popped = twin_.requests_pop_o >> c & 1u, pushed = twin_.answers_push_o >> c & 1u;
      difference_.same("requests pop", popped, model.requests[c].popped)
          .same("answers push", pushed, model.answers[c].pushed);
      if (model.answers[c].pushed)
        difference_.same("answer", twin_.answers_data_o[kLineWords], model.answers[c].token.id);
      if (!model.requests[c].popped) continue;
      const MemoryRequest& request = model.requests[c].token;
      difference_.same("client", twin_.mem_request_client_o, static_cast<unsigned>(c))
          .same("request", twin_.mem_request_data_o, request.address << 9 | request.id << 1 | request.write);
      ++compared.requests_of[c];
    }
    difference_.same("activity", twin_.activity_o, static_cast<unsigned>(model.account.current()));
    ++compared.cycles_of[static_cast<int>(model.account.current())];
  }

  void step_memory(Cycle now) {
    if (twin_.mem_answer_take_o) memory_.take_answer();
    if (twin_.mem_request_o) {
      const std::uint64_t data = twin_.mem_request_data_o;
      memory_.accept(now, {static_cast<Client>(twin_.mem_request_client_o),
                           {data >> 9, static_cast<std::uint16_t>(data >> 1 & 255), (data & 1) != 0}});
    }
    memory_.work(now);
  }

  VerilatedContext context_;
  Model twin_{from_noise(context_)};
  int clients_;
  Memory memory_;
  Difference difference_;
};

template <class Model, class Memory>
Compared compare(const test::World& world, const UnitConfig& config, int clients, std::uint64_t stall_seed) {
  Compared compared;
  Twin<Model, Memory> twin(config, clients);
  StageRun run(world, config, stall_seed);
  const auto& stage = run.unit().stages().memory_port;
  compared.difference = run.first_difference([&] { return twin.cycle(run.unit().cycles() - 1, stage, compared); });
  return compared;
}
template <class Model>
Compared compare(const test::World& world, const UnitConfig& config, int clients, std::uint64_t stall_seed) {
  return config.memory.model == MemoryModel::Ideal ? compare<Model, IdealMemory>(world, config, clients, stall_seed)
                                                   : compare<Model, BankedMemory>(world, config, clients, stall_seed);
}

/// Few lines and few stack entries, so that all clients ask a memory that is often busy.
UnitConfig config_of(const test::World& world, MemoryModel model, int interval) {
  UnitConfig config = world.config();
  config.unit.contexts = 16;
  config.memory.model = model;
  config.memory.line_bytes = 32;
  config.memory.latency = 30;
  config.memory.interval = interval;
  config.memory.channels = 2;
  config.memory.queue_depth = interval;
  config.node_cache.bytes = config.leaf_cache.bytes = 256;
  config.table_cache.bytes = world.tester().design() == cull::Design::None ? 0 : 128;
  config.stack.entries = 2;
  config.stack.spill_batch = 2;
  return config;
}

template <class Model>
void expect_twins(cull::Design design, int clients, std::initializer_list<Client> present) {
  SCOPED_TRACE(oracle::seed_note());
  const test::World world("gen:straight-hair?strands=150", design, 40);
  std::uint64_t cycles_of[pipeline::kActivities] = {};
  for (const MemoryModel model : {MemoryModel::Ideal, MemoryModel::Banked}) {
    for (const int interval : {1, 3}) {
      for (const std::uint64_t stall_seed : {std::uint64_t{0}, oracle::test_seed()}) {
        UnitConfig config = config_of(world, model, interval);
        if (clients == 2) config.stack.entries = 64;
        const Compared compared = compare<Model>(world, config, clients, stall_seed);
        ASSERT_EQ(compared.difference, "")
            << "memory " << static_cast<int>(model) << ", interval " << interval << ", stall seed " << stall_seed;
        for (const Client client : present) EXPECT_GT(compared.requests_of[static_cast<int>(client)], 20u);
        for (int i = 0; i < pipeline::kActivities; ++i) cycles_of[i] += compared.cycles_of[i];
      }
    }
  }
  for (const Activity activity : {Activity::Busy, Activity::Idle, Activity::OutputFull, Activity::Memory})
    EXPECT_GT(cycles_of[static_cast<int>(activity)], 50u) << name_of(activity);
}

TEST(MemoryPort, does_what_the_model_does_in_every_cycle_for_four_clients) {
  expect_twins<VMemoryPort4>(cull::Design::Dedup, 4,
                             {Client::NodeFetch, Client::LeafFetch, Client::Stack, Client::TableFetch});
}
TEST(MemoryPort, does_what_the_model_does_in_every_cycle_for_three_clients_with_room_for_four) {
  expect_twins<VMemoryPort4>(cull::Design::None, 4, {Client::NodeFetch, Client::LeafFetch, Client::Stack});
}
TEST(MemoryPort, does_what_the_model_does_in_every_cycle_for_two_clients) {
  expect_twins<VMemoryPort2>(cull::Design::None, 2, {Client::NodeFetch, Client::LeafFetch});
}

template <class Model>
void expect_caught() {
  const test::World world("gen:straight-hair?strands=150", cull::Design::None, 40);
  const Compared compared = compare<Model>(world, config_of(world, MemoryModel::Banked, 1), 4, oracle::test_seed());
  EXPECT_NE(compared.difference, "");
  std::cout << compared.difference << '\n';
}
TEST(MemoryPortMutants, a_request_that_waits_until_memory_can_take_all_is_caught) {
  expect_caught<VMutantPortWaitsForAll>();
}
TEST(MemoryPortMutants, a_turn_that_stays_with_the_client_just_served_is_caught) {
  expect_caught<VMutantPortTurnStays>();
}
TEST(MemoryPortMutants, an_answer_pushed_into_a_full_link_is_caught) { expect_caught<VMutantPortPushesUnasked>(); }

}  // namespace
}  // namespace ctu::rtl
