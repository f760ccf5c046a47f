#include "sim/config_file.h"

#include <gtest/gtest.h>

#include "model/base/error.h"
#include "tests/sim/program.h"

namespace {

using namespace ctu;

TEST(ConfigTest, defaults_are_those_of_the_parameter_list) {
  const pipeline::UnitConfig config = sim::load_config("", {});
  for (const auto& parameter : pipeline::parameters())
    EXPECT_EQ(parameter.get(config), parameter.default_value) << parameter.key;
}

TEST(ConfigTest, every_parameter_can_be_set_to_its_own_default) {
  std::vector<std::string> sets;
  for (const auto& parameter : pipeline::parameters())
    sets.push_back(parameter.key + "=" + sim::to_text(parameter.default_value));
  EXPECT_EQ(sim::config_hash(sim::load_config("", sets)), sim::config_hash({}));
}

TEST(ConfigTest, integers_outside_their_range_are_refused_by_name) {
  for (const auto& parameter : pipeline::parameters()) {
    if (!std::holds_alternative<std::int64_t>(parameter.default_value)) continue;
    for (const std::int64_t value : {parameter.minimum - 1, parameter.maximum + 1}) {
      try {
        sim::load_config("", {parameter.key + "=" + std::to_string(value)});
        ADD_FAILURE() << parameter.key << " = " << value << " was accepted";
      } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find(parameter.key), std::string::npos);
      }
    }
  }
}

TEST(ConfigTest, the_hash_tells_configurations_apart) {
  EXPECT_NE(sim::config_hash(sim::load_config("", {"unit.contexts=8"})),
            sim::config_hash(sim::load_config("", {"unit.contexts=16"})));
}

TEST(ConfigTest, keys_of_very_many_parts_are_refused_before_the_parser_nests_them) {
  ctu::test::ScratchFolder folder;
  const auto path = folder.path() / "unit.toml";
  std::string key = "a";
  for (int i = 0; i < 200'000; ++i) key += ".a";
  for (const std::string text :
       {"[" + key + "]\n", key + " = 1\n", "\"#\"." + key + " = 1\n", "x = {" + key + " = 1}\n"}) {
    ctu::test::write_text(path, text);
    try {
      sim::load_config(path.string(), {});
      ADD_FAILURE() << "was accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.where(), path.string() + ":1");
      EXPECT_NE(e.problem().find("more than 32 dots in one line"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
