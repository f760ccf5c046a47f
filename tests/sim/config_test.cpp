#include "sim/config_file.h"

#include <gtest/gtest.h>

#include "model/base/error.h"

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

}  // namespace
