// The table of energies: the committed one, the law of memories, and what a user's file must have.
#include "sim/energy/energy_table.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "model/base/error.h"

namespace {

using ctu::Error;
using ctu::energy::default_table_text;
using ctu::energy::EnergyTable;

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto place = text.find(what);
  EXPECT_NE(place, std::string::npos) << what;
  return text.replace(place, what.size(), with);
}

/// The problem that reading such a file is refused with.
std::string problem_of(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / "ctusim-energy-table-test.toml";
  std::ofstream(path) << text;
  try {
    EnergyTable::read(path.string());
  } catch (const Error& error) {
    return error.where() + ": " + error.problem();
  }
  return "";
}

TEST(EnergyTable, every_entry_of_ours_says_where_its_number_is_from) {
  const auto& entries = EnergyTable::standard().entries();
  EXPECT_EQ(entries.size(), 19u);
  for (const auto& [key, entry] : entries) {
    EXPECT_GT(entry.value, 0) << key;
    EXPECT_GT(entry.source.size(), 20u) << key;
  }
}

TEST(EnergyTable, memories_cost_what_was_published_at_8_32_and_1024_kib) {
  const EnergyTable& table = EnergyTable::standard();
  const auto word = [&](double bytes) { return 64 * table.access_pj(8 * bytes); };
  EXPECT_DOUBLE_EQ(word(8192), 10);
  EXPECT_DOUBLE_EQ(word(32768), 20);
  EXPECT_NEAR(word(1 << 20), 100, 14);
  EXPECT_DOUBLE_EQ(word(1), word(128)) << "registers cost what the least memory does";
  EXPECT_GT(word(129), word(128));
}

TEST(EnergyTable, leakage_is_power_times_cycles_of_the_clock) {
  // 1000 cycles of 2 ns: 2 us of 25 nW are 50 fJ.
  EXPECT_DOUBLE_EQ(EnergyTable::standard().leakage_pj(25, 1000), 0.05);
}

TEST(EnergyTable, a_users_file_replaces_numbers_and_has_a_hash_of_its_own) {
  const EnergyTable theirs = EnergyTable::parse(replaced(default_table_text(), "value = 3.92", "value = 14"), "theirs");
  EXPECT_DOUBLE_EQ(theirs.at("dram.bit"), 14);
  EXPECT_NE(theirs.hash(), EnergyTable::standard().hash());
}

TEST(EnergyTable, a_file_that_is_no_whole_table_is_refused_by_place) {
  const std::string ours = default_table_text();
  EXPECT_EQ(problem_of(ours), "");
  EXPECT_NE(problem_of(replaced(ours, "[dram.bit]", "[dram.bits]")).find("did you mean dram.bit?"), std::string::npos);
  EXPECT_NE(problem_of(ours.substr(0, ours.find("[clock.frequency]"))).find("clock.frequency is missing"),
            std::string::npos);
  EXPECT_NE(problem_of(replaced(ours, "value = 3.92", "value = -1")).find("dram.bit"), std::string::npos);
  EXPECT_NE(problem_of(replaced(ours, "value = 3.92\nunit = \"pJ\"", "value = 3.92\nunit = \"nJ\"")).find("in nJ"),
            std::string::npos);
  EXPECT_NE(problem_of(replaced(ours, "value = 3.92", "value = ")).find(".toml:"), std::string::npos);
  EXPECT_NE(problem_of("name = \"mine\"\ntechnology = \"none\"\n").find("missing"), std::string::npos);
}

}  // namespace
