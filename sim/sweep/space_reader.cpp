// read_space: the file's tables into a Space.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "model/base/error.h"
#include "model/base/nearest.h"
#include "model/base/read_file.h"
#include "sim/config_file.h"
#include "sim/scene_list.h"
#include "sim/sweep/space.h"
#include "sim/sweep/toml_reader.h"

namespace ctu::sweep {
namespace {

class SpaceReader {
 public:
  explicit SpaceReader(const std::string& path) : reader_(path), folder_(std::filesystem::path(path).parent_path()) {
    constexpr std::uint64_t kMostBytes = 1u << 20;
    space_.path = path;
    space_.text = read_file(path, kMostBytes, "docs/sweeps.md shows a complete example of a space");
  }

  Space read() {
    const toml::table root = parse_toml(space_.text, space_.path);
    reader_.expect_keys(
        root, {"engine", "first", "rays", "traces", "record", "config", "set", "axes", "zip", "exclude", "search"});
    space_.engine = reader_.text(root, "engine", space_.engine);
    space_.first_ray = reader_.number(root, "first", 0);
    space_.rays = reader_.number(root, "rays", 0);
    read_traces(root);
    read_base(root);
    read_axes(root);
    read_exclusions(root);
    if (const toml::table* search = table_of(root, "search")) read_search(*search);
    return std::move(space_);
  }

 private:
  const toml::table* table_of(const toml::table& root, const char* key) const {
    const toml::node* node = root.get(key);
    if (node == nullptr) return nullptr;
    if (node->as_table() == nullptr)
      reader_.refuse(*node, fmt::format("{} is no table", key), fmt::format("write [{}]", key));
    return node->as_table();
  }
  std::vector<const toml::table*> tables_of(const toml::table& root, const char* key) const {
    std::vector<const toml::table*> tables;
    const toml::node* node = root.get(key);
    if (node == nullptr) return tables;
    const toml::array* list = node->as_array();
    if (list == nullptr)
      reader_.refuse(*node, fmt::format("{} is no list of tables", key), fmt::format("write [[{}]]", key));
    for (const toml::node& element : *list) {
      if (element.as_table() == nullptr)
        reader_.refuse(element, fmt::format("{} is no list of tables", key), fmt::format("write [[{}]]", key));
      tables.push_back(element.as_table());
    }
    return tables;
  }
  /// A path of the file is relative to the file.
  std::string beside(const std::string& path) const {
    return std::filesystem::path(path).is_absolute() ? path : (folder_ / path).string();
  }

  void read_traces(const toml::table& root);
  void read_recordings(const toml::table& table);
  void read_base(const toml::table& root);
  void read_axes(const toml::table& root);
  void read_exclusions(const toml::table& root);
  void read_search(const toml::table& table);
  void add_axis(Axis axis, const toml::node& at);
  void check_key(const std::string& key, const toml::node& at) const;
  void check_value(const std::string& key, const std::string& value, const toml::node& at) const;
  void add_trace(TraceSource trace, const Settings& settings, const toml::node& at);

  TomlReader reader_;
  std::filesystem::path folder_;
  Space space_;
};

void SpaceReader::add_trace(TraceSource trace, const Settings& settings, const toml::node& at) {
  for (const TraceSource& other : space_.traces)
    if (other.name == trace.name)
      reader_.refuse(at, fmt::format("two traces are called {}", trace.name),
                     "leave one out, or give the [[record]] table a name = \"...\" that tells them apart");
  auto group = std::find_if(space_.groups.begin(), space_.groups.end(),
                            [&](const TraceGroup& g) { return g.settings == settings; });
  if (group == space_.groups.end()) group = space_.groups.insert(group, {settings, {}});
  group->traces.push_back(space_.traces.size());
  space_.traces.push_back(std::move(trace));
}

void SpaceReader::read_traces(const toml::table& root) {
  if (const toml::node* node = root.get("traces"))
    for (const std::string& file : reader_.values(*node))
      add_trace({.name = file, .file = beside(file), .scene = {}, .record_words = {}}, {}, *node);
  for (const toml::table* table : tables_of(root, "record")) read_recordings(*table);
  if (space_.traces.empty())
    throw Error(space_.path, "names no trace", "write traces = [\"FILE.ctut\"], or [[record]] with a scene");
}

/// What a trace's file is called after: letters, digits and a few signs of the name.
std::string file_name_of(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-';
    name += plain ? c : '_';
  }
  return name;
}

struct RecordOption {
  std::string key;
  std::vector<std::string> values;
};

/// Options of `ctusim record` for one choice of every list; `false` leaves an option out, `true` is a flag.
std::vector<std::string> record_words(const std::vector<RecordOption>& options,
                                      const std::vector<std::size_t>& choice) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < options.size(); ++i) {
    const std::string& value = options[i].values[choice[i]];
    if (value == "false") continue;
    words.push_back("--" + options[i].key);
    if (value != "true") words.push_back(value);
  }
  return words;
}

bool next_choice(const std::vector<RecordOption>& options, std::vector<std::size_t>& choice) {
  for (std::size_t i = options.size(); i-- > 0;) {
    if (++choice[i] < options[i].values.size()) return true;
    choice[i] = 0;
  }
  return false;
}

void SpaceReader::read_recordings(const toml::table& table) {
  sim::SceneArgs scenes;
  const toml::node* scene = table.get("scene");
  if (scene == nullptr) reader_.refuse(table, "names no scene", "write scene = \"FILE\" or a list of them");
  scenes.scenes = reader_.values(*scene);
  for (std::string& file : scenes.scenes)  // names of the index and generated scenes are no files
    if (const std::string here = beside(file); std::filesystem::exists(here)) file = here;
  if (table.contains("index"))
    scenes.index = beside(reader_.text(table, "index", ""));
  else
    scenes = sim::with_default_index(scenes);
  const std::string name = reader_.text(table, "name", "");
  std::vector<RecordOption> options;
  reader_.flatten(table, {}, [&](const std::string& key, const toml::node& node) {
    if (key == "scene" || key == "index" || key == "name") return;
    if (key == "output") reader_.refuse(node, "the sweep says where traces lie", "leave it out");
    options.push_back({key, reader_.values(node)});
  });
  std::string rays = "diffuse";
  for (const sim::ListedScene& listed : sim::listed_scenes(scenes)) {
    const sim::SceneArgs viewed = sim::with_view(scenes, listed);
    std::vector<std::size_t> choice(options.size(), 0);
    do {
      TraceSource trace;
      trace.scene = listed.name;
      trace.record_words = {"record", listed.path};
      Settings settings;
      std::string varied = name.empty() ? "" : "-" + name;
      for (std::size_t i = 0; i < options.size(); ++i) {
        if (options[i].key == "rays") rays = options[i].values[choice[i]];
        if (options[i].values.size() == 1) continue;
        settings.push_back({"record." + options[i].key, options[i].values[choice[i]]});
        varied += fmt::format("-{}{}", options[i].key, options[i].values[choice[i]]);
      }
      const auto words = record_words(options, choice);
      trace.record_words.insert(trace.record_words.end(), words.begin(), words.end());
      const auto gives = [&](const char* key) {
        return std::any_of(options.begin(), options.end(), [&](const RecordOption& o) { return o.key == key; });
      };
      if (!viewed.eye.empty() && !gives("eye") && !gives("target"))
        for (const std::string& word : {std::string("--eye"), viewed.eye, std::string("--target"), viewed.target,
                                        std::string("--fov"), fmt::format("{}", viewed.vertical_fov)})
          trace.record_words.push_back(word);
      trace.name = fmt::format("traces/{}-{}{}.ctut", file_name_of(listed.name), rays, file_name_of(varied));
      add_trace(std::move(trace), settings, table);
    } while (next_choice(options, choice));
  }
}

void SpaceReader::read_base(const toml::table& root) {
  space_.config_path = reader_.text(root, "config", "");
  if (!space_.config_path.empty()) space_.config_path = beside(space_.config_path);
  if (const toml::table* set = table_of(root, "set"))
    reader_.flatten(*set, {}, [&](const std::string& key, const toml::node& node) {
      const std::string value = reader_.scalar(node);
      check_value(key, value, node);
      space_.sets.push_back(key + "=" + value);
    });
  if (!space_.config_path.empty()) sim::load_config(space_.config_path, {});  // its mistakes before any others
}

/// A value by itself: rules between parameters are for the points.
void SpaceReader::check_value(const std::string& key, const std::string& value, const toml::node& at) const {
  try {
    sim::load_config("", {key + "=" + value});
  } catch (const Error& error) {
    if (error.where().rfind("--set", 0) == 0) reader_.refuse(at, error.problem(), error.remedy());
  }
}

void SpaceReader::add_axis(Axis axis, const toml::node& at) {
  const auto known = space_.swept_keys();
  for (std::size_t k = 0; k < axis.keys.size(); ++k) {
    if (std::find(known.begin(), known.end(), axis.keys[k]) != known.end())
      reader_.refuse(at, fmt::format("{} is on two axes", axis.keys[k]), "leave one of them out");
    for (const auto& choice : axis.choices) check_value(axis.keys[k], choice[k], at);
  }
  space_.axes.push_back(std::move(axis));
}

void SpaceReader::read_axes(const toml::table& root) {
  if (const toml::table* axes = table_of(root, "axes"))
    reader_.flatten(*axes, {"range", "log2"}, [&](const std::string& key, const toml::node& node) {
      Axis axis{{key}, {}};
      for (const std::string& value : reader_.values(node)) axis.choices.push_back({value});
      add_axis(std::move(axis), node);
    });
  for (const toml::table* zip : tables_of(root, "zip")) {
    Axis axis;
    reader_.flatten(*zip, {"range", "log2"}, [&](const std::string& key, const toml::node& node) {
      const auto values = reader_.values(node);
      if (axis.keys.empty()) axis.choices.resize(values.size());
      if (values.size() != axis.choices.size())
        reader_.refuse(
            node,
            fmt::format("{} has {} values, {} has {}", key, values.size(), axis.keys.front(), axis.choices.size()),
            "keys of a [[zip]] need equally many");
      axis.keys.push_back(key);
      for (std::size_t i = 0; i < values.size(); ++i) axis.choices[i].push_back(values[i]);
    });
    if (!axis.keys.empty()) add_axis(std::move(axis), *zip);
  }
}

void SpaceReader::check_key(const std::string& key, const toml::node& at) const {
  if (key == "scene" || key.rfind("record.", 0) == 0) return;
  std::vector<std::string> known = {"scene"};
  for (const auto& parameter : pipeline::parameters()) known.push_back(parameter.key);
  if (std::find(known.begin(), known.end(), key) == known.end())
    reader_.refuse(at, fmt::format("unknown key \"{}\"", key),
                   fmt::format("did you mean \"{}\"? Others are record.OPTION and scene", nearest_name(key, known)));
}

void SpaceReader::read_exclusions(const toml::table& root) {
  for (const toml::table* table : tables_of(root, "exclude")) {
    Exclusion exclusion;
    reader_.flatten(*table, {"below", "above"}, [&](const std::string& key, const toml::node& node) {
      Condition condition{key, {}, {}, {}};
      check_key(key, node);
      if (const toml::table* bounds = node.as_table()) {
        reader_.expect_keys(*bounds, {"below", "above"});
        if (const toml::node* below = bounds->get("below")) condition.below = reader_.integer(*below);
        if (const toml::node* above = bounds->get("above")) condition.above = reader_.integer(*above);
      } else {
        condition.values = reader_.values(node);
      }
      exclusion.push_back(std::move(condition));
    });
    if (exclusion.empty()) reader_.refuse(*table, "an empty [[exclude]] leaves no point", "write what to leave out");
    space_.exclusions.push_back(std::move(exclusion));
  }
}

void SpaceReader::read_search(const toml::table& table) {
  reader_.expect_keys(table, {"mode", "seed", "points", "objectives", "population", "generations"});
  SearchPlan& search = space_.search;
  const std::string mode = reader_.text(table, "mode", "grid");
  if (mode != "grid" && mode != "random" && mode != "pareto")
    reader_.refuse(*table.get("mode"), fmt::format("there is no mode \"{}\"", mode), "give grid, random or pareto");
  search.mode = mode == "grid" ? SearchMode::Grid : mode == "random" ? SearchMode::Random : SearchMode::Pareto;
  search.seed = reader_.number(table, "seed", search.seed);
  search.points = reader_.number(table, "points", 0);
  if (search.mode == SearchMode::Random && search.points == 0)
    reader_.refuse(table, "random without a number of points", "write points = 100");
  if (const toml::node* objectives = table.get("objectives")) search.objectives = reader_.values(*objectives);
  if (search.mode == SearchMode::Pareto && search.objectives.size() < 2)
    reader_.refuse(table, "a Pareto search needs two objectives at least",
                   "write objectives = [\"cycles_per_ray\", \"on_chip_bits\"]");
  const auto bounded = [&](const char* key, std::uint32_t otherwise) {
    const std::uint64_t value = reader_.number(table, key, otherwise);
    if (value < 1 || value > 100000)
      reader_.refuse(*table.get(key), fmt::format("{} is not from 1 to 100000", key), "give a number between");
    return static_cast<std::uint32_t>(value);
  };
  search.population = bounded("population", search.population);
  search.generations = bounded("generations", search.generations);
}

}  // namespace

Space read_space(const std::string& path) { return SpaceReader(path).read(); }

}  // namespace ctu::sweep
