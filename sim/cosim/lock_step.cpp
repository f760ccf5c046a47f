#include "sim/cosim/lock_step.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "model/pipeline/engine.h"
#include "model/pipeline/tapped_unit.h"
#include "sim/cosim/rtl_run.h"
#include "sim/cosim/side_waves.h"

namespace ctu::cosim {
namespace {

using pipeline::Cycle;

template <std::size_t kCount>
int place_of(const std::array<std::string_view, kCount>& names, std::string_view name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// One link of the model, as the twin's probe of the same name sees it.
struct LinkTap {
  int link = 0;  ///< place in kLinkNames
  int model_number = 0;
  std::function<LinkState()> state;
  std::function<pipeline::Slot()> slot;  ///< of the token at hand
};

template <class Token>
pipeline::Slot slot_of(const Token& token) {
  if constexpr (requires { token.slot; })
    return token.slot;
  else if constexpr (requires { token.id; })
    return token.id;
  else
    return token.packet;
}

template <class Out, class In>
LinkTap tap(std::string_view name, int number, const Out& out, const In& in, const TokenWidths& widths) {
  return {place_of(kLinkNames, name), number,
          [&out, &in, widths] {
            return LinkState{in.valid, out.ready, in.popped, out.pushed,
                             out.pushed ? bits_of(out.token, widths) : TokenBits{}};
          },
          [&out, &in] { return slot_of(out.pushed ? out.token : in.token); }};
}

std::string hex(const TokenBits& bits) {
  return fmt::format("{:08x}_{:08x}_{:08x}_{:08x}_{:08x}", bits[4], bits[3], bits[2], bits[1], bits[0]);
}

class LockStep {
 public:
  LockStep(RtlUnit& unit, const pipeline::UnitConfig& config, const pipeline::Work& model_work,
           const pipeline::Work& rtl_work, const LockStepOptions& options)
      : options_(options),
        widths_{unit.parameters().slot_bits, 40},
        watchdog_(static_cast<Cycle>(config.watchdog.cycles)),
        model_(config, model_work, {.seed = options.stall_seed}),
        taps_(make_taps()),
        rtl_(unit, config, rtl_work, model_.backpressure(), stall_numbers()) {
    if (options.waves_prefix.empty()) return;
    std::vector<std::string> links, stages;
    for (const LinkTap& link : taps_) links.emplace_back(kLinkNames[static_cast<std::size_t>(link.link)]);
    pipeline::for_each_stage(model_.stages(), [&](auto& stage) { stages.emplace_back(stage.account.stage()); });
    for (const char* side : {"model", "rtl"})
      waves_.push_back(std::make_unique<SideWaves>(options.waves_prefix + "." + side + ".vcd", links, stages,
                                                   options.waves_first, options.waves_last));
  }

  LockStepResult run() {
    LockStepResult result;
    while (!model_.done() && !result.difference) {
      cycle(&result);
      watch_progress(result.handshakes);
    }
    // The waveform goes on for its window, so that what follows from a difference can be seen.
    while (!waves_.empty() && result.difference && model_.cycles() <= options_.waves_last && !model_.done())
      cycle(nullptr);
    for (auto& side : waves_) side->close();
    result.cycles = rtl_.cycles();
    result.rtl_wrong_hits = rtl_.wrong_hits();
    result.model = model_.result();
    if (!result.difference && !rtl_.done())
      result.difference = Difference{rtl_.cycles(), "unit", "done", "every ray returned", "rays under way", {}, 0};
    return result;
  }

 private:
  std::vector<LinkTap> make_taps() {
    std::vector<LinkTap> taps;
    pipeline::for_each_link(model_.stages(), model_.state().has_spills, [&](const char* name, auto& out, auto& in) {
      taps.push_back(tap(name, static_cast<int>(taps.size()), out, in, widths_));
    });
    return taps;
  }
  std::array<int, kLinks> stall_numbers() const {
    std::array<int, kLinks> numbers;
    numbers.fill(-1);
    for (const LinkTap& t : taps_) numbers[static_cast<std::size_t>(t.link)] = t.model_number;
    return numbers;
  }

  /// One cycle of both, compared where there is a result to note a difference in.
  void cycle(LockStepResult* result) {
    const Cycle now = model_.cycles();
    model_.step();
    rtl_.begin();
    if (result != nullptr) compare(now, *result);
    if (!waves_.empty()) draw(now);
    rtl_.end();
  }

  void compare(Cycle now, LockStepResult& result) {
    for (const LinkTap& link : taps_)
      if (!result.difference) compare_link(now, link, result);
    pipeline::for_each_stage(model_.stages(), [&](auto& stage) {
      if (!result.difference) compare_stage(now, stage.account, result);
    });
  }

  void draw(Cycle now) {
    SideWaves &model = *waves_[0], &rtl = *waves_[1];
    for (std::size_t i = 0; i < taps_.size(); ++i) {
      model.set_link(i, taps_[i].state());
      rtl.set_link(i, rtl_.unit().link(taps_[i].link));
    }
    std::size_t place = 0;
    pipeline::for_each_stage(model_.stages(), [&](auto& stage) {
      model.set_stage(place, static_cast<int>(stage.account.current()));
      rtl.set_stage(place++, rtl_.unit().activity(place_of(kStageNames, stage.account.stage())));
    });
    model.end_cycle(now);
    rtl.end_cycle(now);
  }

  void watch_progress(std::uint64_t handshakes) {
    if (handshakes != handshakes_) last_moved_ = model_.cycles();
    handshakes_ = handshakes;
    const std::uint64_t rays = model_.stages().result_queue.rays();
    if (rays != rays_ && options_.progress && rays % 64 == 0) options_.progress(rays);
    rays_ = rays;
    if (model_.cycles() - last_moved_ > watchdog_)
      throw pipeline::DeadlockFound("no link has moved for watchdog.cycles");
  }

  void compare_link(Cycle now, const LinkTap& link, LockStepResult& result) {
    const LinkState model = link.state(), rtl = rtl_.unit().link(link.link);
    result.compared += 4;
    result.handshakes += model.pushed;
    const auto differs = [&](const char* port, std::string model_value, std::string rtl_value) {
      result.difference = Difference{now,
                                     std::string(kLinkNames[static_cast<std::size_t>(link.link)]),
                                     port,
                                     std::move(model_value),
                                     std::move(rtl_value),
                                     {},
                                     0};
      name_ray(link.slot(), *result.difference);
    };
    const auto same = [&](const char* port, bool a, bool b) {
      if (a != b && !result.difference) differs(port, a ? "1" : "0", b ? "1" : "0");
    };
    same("valid", model.valid, rtl.valid);
    same("ready", model.ready, rtl.ready);
    same("pop", model.popped, rtl.popped);
    same("push", model.pushed, rtl.pushed);
    if (result.difference || !model.pushed) return;
    ++result.compared;
    if (model.token != rtl.token) differs("data", hex(model.token), hex(rtl.token));
  }

  void compare_stage(Cycle now, const pipeline::Account& account, LockStepResult& result) {
    const int rtl = rtl_.unit().activity(place_of(kStageNames, account.stage()));
    ++result.compared;
    if (rtl == static_cast<int>(account.current())) return;
    const auto name = [](int activity) {
      return activity < pipeline::kActivities ? std::string(name_of(static_cast<pipeline::Activity>(activity)))
                                              : fmt::format("{}", activity);
    };
    result.difference = Difference{
        now, std::string(account.stage()), "activity", name(static_cast<int>(account.current())), name(rtl), {}, 0};
  }

  void name_ray(pipeline::Slot slot, Difference& difference) {
    pipeline::Contexts& contexts = model_.state().contexts;
    if (slot >= contexts.count() || !contexts[slot].in_flight) return;
    difference.ray = contexts[slot].ray;
    difference.step = contexts[slot].visits;
  }

  LockStepOptions options_;
  TokenWidths widths_;
  Cycle watchdog_;
  pipeline::TappedUnit model_;
  std::vector<LinkTap> taps_;
  RtlRun rtl_;
  std::vector<std::unique_ptr<SideWaves>> waves_;  // model, rtl; or none
  std::uint64_t rays_ = 0, handshakes_ = 0;
  Cycle last_moved_ = 0;
};

}  // namespace

std::string to_string(const Difference& d) {
  std::string text = fmt::format("cycle {}: {}.{}: model {}, rtl {}", d.cycle, d.module, d.port, d.model, d.rtl);
  if (d.ray) text += fmt::format("; ray {}, step {}", *d.ray, d.step);
  return text;
}

LockStepResult run_lock_step(RtlUnit& unit, const pipeline::UnitConfig& config, const pipeline::Work& model_work,
                             const pipeline::Work& rtl_work, const LockStepOptions& options) {
  return LockStep(unit, config, model_work, rtl_work, options).run();
}

}  // namespace ctu::cosim
