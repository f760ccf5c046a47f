// Ports and links of pins mode: what a stage knows as In and Out are here SystemC ports of ready/valid signals, and a
// link is a module of its own with two registers.
//
// Two phases of the clock: at the rising edge links take over what was handed to them in the cycle before; at the
// falling edge stages read their ports and drive them. So valid and ready of a link are registered, and a stage sees
// the state at the start of the cycle, as with plain links.
#pragma once

#include <exception>
#include <ostream>
#include <type_traits>
#include <utility>
#include <vector>

#include <systemc>

#include "model/pipeline/backpressure.h"
#include "model/pipeline/cycle.h"
#include "model/pipeline/tokens.h"

namespace ctu::pipeline {

// sc_signal wants to print what it carries.
inline std::ostream& operator<<(std::ostream& out, const SlotToken& t) { return out << "slot " << t.slot; }
inline std::ostream& operator<<(std::ostream& out, const RefToken& t) {
  return out << "slot " << t.slot << " ref " << t.ref << (t.of_packet ? " of packet" : "");
}
inline std::ostream& operator<<(std::ostream& out, const JoinToken& t) {
  return out << "slot " << t.slot << (t.joins ? " joins" : "") << (t.closes ? " closes" : "");
}
inline std::ostream& operator<<(std::ostream& out, const StartToken& t) {
  return out << "slot " << t.slot << " packet " << int{t.packet} << (t.last ? " last" : "");
}
inline std::ostream& operator<<(std::ostream& out, const PacketToken& t) { return out << "packet " << int{t.packet}; }
inline std::ostream& operator<<(std::ostream& out, const LeafToken& t) {
  return out << "slot " << t.slot << " ref " << t.ref << " met " << t.met;
}
inline std::ostream& operator<<(std::ostream& out, const NodeToken& t) {
  return out << "slot " << t.slot << " hits " << int{t.hits} << " survivors " << int{t.survivors} << " order "
             << int{t.order} << " asked " << int{t.asked};
}
inline std::ostream& operator<<(std::ostream& out, const RecordedTest& t) {
  return out << "slot " << t.slot << " index " << int{t.index} << (t.last ? " last" : "");
}
inline std::ostream& operator<<(std::ostream& out, const ComputedTest& t) {
  return out << "slot " << t.slot << " index " << int{t.index} << (t.last ? " last" : "") << " hit " << t.hit << " t "
             << t.candidate.t;
}
inline std::ostream& operator<<(std::ostream& out, const LeafDone& t) {
  return out << "slot " << t.slot << (t.finished ? " finished" : "");
}
inline std::ostream& operator<<(std::ostream& out, const MemoryRequest& t) {
  return out << (t.write ? "write " : "read ") << t.address << " id " << t.id;
}
inline std::ostream& operator<<(std::ostream& out, const MemoryResponse& t) { return out << "id " << t.id; }

}  // namespace ctu::pipeline

namespace ctu::unit {

using pipeline::Cycle;

/// What all modules of a pins simulation share.
struct PinShared {
  explicit PinShared(const sc_core::sc_clock& clock_) : clock(clock_) {}
  const sc_core::sc_clock& clock;
  Cycle now = 0;
  bool moved = false;          ///< something moved in this cycle
  std::exception_ptr failure;  ///< of a stage; the kernel must not see exceptions
  pipeline::Backpressure backpressure;
};

/// A port that drives its handshake signal once a cycle.
class PinPort {
 public:
  virtual ~PinPort() = default;
  virtual void begin_cycle() = 0;
  virtual void end_cycle() = 0;
};

/// The module under construction: its ports put themselves into `ports`. Construction is single-threaded, as
/// elaboration is.
struct PinConstruction {
  PinShared* shared = nullptr;
  std::vector<PinPort*> ports;
  static PinConstruction& current() {
    static PinConstruction construction;
    return construction;
  }
};

// Ports of a part that is left out stay unbound.
template <class T>
using OptionalIn = sc_core::sc_port<sc_core::sc_signal_in_if<T>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;
template <class T>
using OptionalOut = sc_core::sc_port<sc_core::sc_signal_inout_if<T>, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;

/// A stage with its ports, as a module.
template <class Stage>
class StageModule : public sc_core::sc_module {
  struct Named {};  // tells the constructors apart

 public:
  template <class First, class... Args>
  requires(!std::is_same_v<First, Named>) explicit StageModule(First&& first, Args&&... args)
      : StageModule(Named{}, sc_core::sc_module_name(Stage::kName), std::forward<First>(first),
                    std::forward<Args>(args)...) {}

  Stage& stage() { return stage_; }

 private:
  SC_HAS_PROCESS(StageModule);
  template <class... Args>
  StageModule(Named, sc_core::sc_module_name&& name, Args&&... args)
      : sc_core::sc_module(name), shared_(*start_construction()), stage_(std::forward<Args>(args)...) {
    ports_ = std::move(PinConstruction::current().ports);
    SC_METHOD(cycle);
    dont_initialize();
    sensitive << shared_.clock.negedge_event();
  }
  static PinShared* start_construction() {
    PinConstruction::current().ports.clear();
    return PinConstruction::current().shared;
  }

  void cycle() {
    if (shared_.failure) return;
    try {
      for (PinPort* port : ports_) port->begin_cycle();
      if (stage_.step(shared_.now)) shared_.moved = true;
      for (PinPort* port : ports_) port->end_cycle();
    } catch (...) {
      shared_.failure = std::current_exception();
    }
  }

  PinShared& shared_;
  Stage stage_;
  std::vector<PinPort*> ports_;
};

struct PinWiring {
  template <class T>
  class In : public PinPort {
   public:
    OptionalIn<bool> valid;
    OptionalIn<T> data;
    OptionalOut<bool> ready;  ///< the stage takes the data in this cycle
    int number = 0;           ///< of the link

    In() : shared_(*PinConstruction::current().shared) { PinConstruction::current().ports.push_back(this); }
    bool can_pop(Cycle now) const {
      return valid.size() > 0 && valid->read() && !shared_.backpressure.refuses(number, pipeline::Side::Pop, now);
    }
    const T& front() const { return data->read(); }
    void pop(Cycle) { popped_ = true; }

    void begin_cycle() override { popped_ = false; }
    void end_cycle() override {
      if (ready.size() > 0) ready->write(popped_);
    }

   private:
    PinShared& shared_;
    bool popped_ = false;
  };

  template <class T>
  class Out : public PinPort {
   public:
    OptionalOut<bool> valid;  ///< the stage gives data in this cycle; only when ready
    OptionalOut<T> data;
    OptionalIn<bool> ready;
    int number = 0;

    Out() : shared_(*PinConstruction::current().shared) { PinConstruction::current().ports.push_back(this); }
    bool can_push(Cycle now) const {
      return ready.size() > 0 && ready->read() && !shared_.backpressure.refuses(number, pipeline::Side::Push, now);
    }
    void push(Cycle, const T& value) {
      data->write(value);
      pushed_ = true;
    }

    void begin_cycle() override { pushed_ = false; }
    void end_cycle() override {
      if (valid.size() > 0) valid->write(pushed_);
    }

   private:
    PinShared& shared_;
    bool pushed_ = false;
  };

  template <class Stage>
  using Holder = StageModule<Stage>;
  template <class Stage>
  static Stage& stage(StageModule<Stage>& holder) {
    return holder.stage();
  }
};

/// The link as a module: a FIFO of two entries with registered valid and ready.
template <class T>
class LinkModule : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(LinkModule);
  LinkModule(const sc_core::sc_module_name& name, const PinShared& shared) : sc_core::sc_module(name) {
    SC_METHOD(edge);
    dont_initialize();
    sensitive << shared.clock.posedge_event();
  }

  void bind(PinWiring::Out<T>& out, PinWiring::In<T>& in) {
    out.valid(in_valid_);
    out.data(in_data_);
    out.ready(in_ready_);
    in.valid(out_valid_);
    in.data(out_data_);
    in.ready(out_ready_);
  }
  int occupancy() const { return occupancy_.read(); }

 private:
  void edge() {
    if (out_ready_.read()) {
      entry_[0] = entry_[1];
      --entries_;
    }
    if (in_valid_.read()) entry_[entries_++] = in_data_.read();
    out_valid_.write(entries_ > 0);
    out_data_.write(entry_[0]);
    in_ready_.write(entries_ < 2);
    occupancy_.write(entries_);
  }

  sc_core::sc_signal<bool> in_valid_{"in_valid"}, in_ready_{"in_ready"}, out_valid_{"out_valid"},
      out_ready_{"out_ready"};
  sc_core::sc_signal<T> in_data_{"in_data"}, out_data_{"out_data"};
  sc_core::sc_signal<int> occupancy_{"occupancy"};
  T entry_[2] = {};
  int entries_ = 0;
};

}  // namespace ctu::unit
