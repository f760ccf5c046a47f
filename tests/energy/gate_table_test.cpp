// The committed table of gates says what yosys finds now: two stages of the default unit, synthesised.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sim/energy/gate_area.h"
#include "tests/sim/program.h"

namespace {

TEST(GateTable, has_what_synthesis_finds_for_modules_of_the_default_unit) {
  const ctu::test::ScratchFolder folder;
  const auto outcome = ctu::test::run_program(
      folder.path(),
      std::string("area --stages child_sort,hit_update --json --cache cache --yosys ") + CTU_YOSYS_PROGRAM);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json report = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(report["stages"].size(), 2u);
  for (const auto& stage : report["stages"]) {
    bool known = true;
    const double tabled = ctu::energy::GateTable::standard().stage(stage["stage"].get<std::string>(), "", known);
    EXPECT_TRUE(known);
    EXPECT_NEAR(tabled, stage["gate_equivalents"].get<double>(), 1e-5 * tabled)
        << stage["stage"] << ": make the table anew: tools/gate_area.py";
  }
}

}  // namespace
