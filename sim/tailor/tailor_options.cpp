// add_tailor: the options of `ctusim tailor`.
#include <CLI/CLI.hpp>

#include "sim/tailor/tailor_command.h"

namespace ctu::tailor {

void add_tailor(CLI::App& app, TailorArgs& args, int& exit_code) {
  auto* command = app.add_subcommand(
      "tailor",
      "the smallest unit for some traces: leaves out what they do not need, checked in the model and in gates");
  command->add_option("traces", args.traces, "trace files")->required();
  command->add_option("-c,--config", args.config_path, "TOML file: the unit to start from");
  command->add_option("--set", args.sets, "KEY=VALUE over it; may be repeated")->take_all();
  command->add_option("--slowdown", args.slowdown, "that each trace may have against the start, as in 1% or 0.5%")
      ->capture_default_str();
  command->add_option("-o,--output", args.output, "TOML file of the tailored unit; none: it is printed");
  command->add_option("--json", args.json_path, "write both units, every change and its reason here");
  command->add_option("--sample", args.sample, "rays of each trace that the search replays; 0: all")
      ->capture_default_str();
  command->add_option("--restarts", args.restarts, "orders in which the keys are tried with the best design")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--seed", args.seed, "of the orders behind the first two")->capture_default_str();
  command
      ->add_option(
          "--rtl-rays", args.gate_rays,
          "rays from the middle of each trace that the unit in gates runs in lock step with the model; 0: none")
      ->capture_default_str();
  command->add_flag("--build-rtl", args.build_rtl,
                    "where no build of the unit in gates fits, make one with verilator and cmake");
  command->add_flag("--area", args.area, "synthesise both units with yosys instead of reading the table of gates");
  command->add_option("--threads", args.threads, "0: one for each core")->capture_default_str();
  command->add_flag("--markdown", args.markdown, "print Markdown tables");
  command->callback([&] { exit_code = tailor_command(args); });
}

}  // namespace ctu::tailor
