// Whatever is wrong with a file, an option or the system, the program ends with exit code 2 and a message that says
// where, what and what to do. The rows of "Refused inputs" in docs/numerics.md are these cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <sys/stat.h>

#include "tests/sim/program.h"

namespace {

using ctu::test::Outcome;
using ctu::test::read_text;
using ctu::test::run_program;
using ctu::test::ScratchFolder;
using ctu::test::write_text;

/// One thing that is refused.
struct Case {
  std::string file;         ///< written before the command runs; empty: none
  std::string content;      ///< of it
  std::string arguments;    ///< of ctusim
  std::string where;        ///< what the message names first
  std::string problem;      ///< what it says is wrong
  std::string before = {};  ///< what the shell does first; empty: nothing
};

const std::string kLittleMemory = "ulimit -v 200000";

class BrokenInput : public ::testing::Test {
 protected:
  std::string file(const std::string& name) { return (folder_.path() / name).string(); }

  /// A remedy follows each message of ours; the parser of the command line has its own form.
  void expect_refused(const Case& c, bool from_parser = false) {
    SCOPED_TRACE("ctusim " + c.arguments);
    if (!c.file.empty()) write_text(file(c.file), c.content);
    const Outcome outcome = run_program(folder_.path(), c.arguments, c.before);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(c.where), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(c.problem), std::string::npos) << outcome.err;
    if (!from_parser) {
      EXPECT_NE(outcome.err.find("remedy: "), std::string::npos) << outcome.err;
    }
  }
  void expect_refused(const std::vector<Case>& cases) {
    for (const Case& c : cases) expect_refused(c);
  }

  ScratchFolder folder_;
};

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// Binary numbers of a header.
template <class... Numbers>
std::string binary(Numbers... numbers) {
  std::string bytes;
  const auto add = [&](const auto& number) { bytes.append(reinterpret_cast<const char*>(&number), sizeof number); };
  (add(numbers), ...);
  return bytes;
}

constexpr std::uint32_t kMany = 0xFFFFFFFF;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A zstd frame of blocks that each say one byte 131072 times.
std::string bomb() {
  std::string bytes = binary(0xFD2FB528u, std::uint8_t{0x00}, std::uint8_t{0x58});
  const std::uint32_t block = 1u << 1 | 131072u << 3;  // a run, not the last
  for (int i = 0; i < 200; ++i) bytes += binary(block).substr(0, 3) + "\n";
  return bytes;
}

/// What record, heatmap and culling are given as a scene.
std::vector<Case> scene_files() {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "property list uchar int vertex_indices\nend_header\n";
  const std::string hair_rest(104, '\0');
  return {
      {"empty.obj", "", "record empty.obj -o x.ctut", "empty.obj", "holds no triangles"},
      {"nan.obj", "v 0 0 nan\n", "record nan.obj -o x.ctut", "nan.obj:1", "'nan' is not a finite binary32 number"},
      {"huge.obj", "v 0 0 1e39\n", "record huge.obj -o x.ctut", "huge.obj:1", "is not a finite binary32 number"},
      {"far.obj", "v 0 0 0\nf 1 2 3\n", "record far.obj -o x.ctut", "far.obj:2", "names vertex 3, but there are 1"},
      {"bytes.obj", "v 0 0 \xff\xfe\n", "record bytes.obj -o x.ctut", "bytes.obj:1", "is not a finite binary32"},
      {"long.obj", "v 0 0 " + std::string(3'000'000, '9') + "x\n", "record long.obj -o x.ctut", "long.obj:1",
       "is not a finite binary32 number"},
      {"round.obj", kTriangle + "f" + repeated(" 1 2 3", 400) + "\n", "record round.obj -o x.ctut", "round.obj:5",
       "a face with 1200 corners; 1024 are possible"},
      {"text.ply", "hello", "record text.ply -o x.ctut", "text.ply:1", "is no PLY file"},
      {"many.ply", ply + "element face 4000000000000\n" + face + "0 0 0\n1 0 0\n0 1 0\n", "record many.ply -o x.ctut",
       "many.ply: element face", "the header states 4000000000000 of them, but only"},
      {"nan.ply", ply + "element face 1\n" + face + "0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n", "record nan.ply -o x.ctut",
       "nan.ply:10", "'inf' is not a finite binary32 number"},
      {"deep.gltf", "{\"extras\":" + std::string(100'000, '['), "record deep.gltf -o x.ctut", "deep.gltf: byte",
       "values are nested more than 100 deep"},
      {"empty.gltf", "", "record empty.gltf -o x.ctut", "empty.gltf", "is no glTF file"},
      {"long.glb", binary('g', 'l', 'T', 'F', 2u, 36u, 4u, 0x4E4F534Au) + "{}  " + binary(8u, 0x004E4942u) + "1234",
       "record long.glb -o x.ctut", "long.glb: byte 32", "8 bytes of the binary chunk need more than the 4 bytes"},
      {"folder.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"."}]})",
       "record folder.gltf -o x.ctut", "folder.gltf", "is a folder"},
      {"circle.pbrt", "Include \"circle.pbrt\"\n", "record circle.pbrt -o x.ctut", "circle.pbrt", "includes itself"},
      {"gone.pbrt", "Include \"nowhere.pbrt\"\n", "record gone.pbrt -o x.ctut", "gone.pbrt:1",
       "names 'nowhere.pbrt', which is not in"},
      {"deep.pbrt", repeated("AttributeBegin\n", 100'001), "record deep.pbrt -o x.ctut", "deep.pbrt:100001",
       "blocks are nested too deep"},
      {"many.hair", "HAIR" + binary(kMany, kMany, 2u, 1u, 0.1f) + hair_rest, "record many.hair -o x.ctut",
       "many.hair: byte 128", "4294967295 points need more than the 0 bytes that are left"},
      {"thick.hair", "HAIR" + binary(1u, 2u, 2u, 1u, kNan) + hair_rest + std::string(24, '\0'),
       "record thick.hair -o x.ctut", "thick.hair: byte 20", "a thickness is negative or not finite"},
      {"many.tfx", binary(4.0f, kMany, 2u, 16u), "record many.tfx -o x.ctut", "many.tfx: byte 16",
       "8589934590 vertices need more than the 0 bytes that are left"},
      {"many.nff", "p 2000000000\n0 0 0\n", "record many.nff -o x.ctut", "many.nff:1",
       "a polygon with 2000000000 corners"},
      {"flat.pbrt", "WorldBegin\nScale 1 1 2\nShape \"sphere\"\n", "culling flat.pbrt", "flat.pbrt:3",
       "makes an ellipsoid of it"},
      {"fin.pbrt",
       "WorldBegin\nShape \"loopsubdiv\" \"point P\" [0 0 0 1 0 0 0 1 0 0 0 1 0 0 2] "
       "\"integer indices\" [0 1 2 0 1 3 0 1 4]\n",
       "culling fin.pbrt", "fin.pbrt:2", "more than two triangles of the control mesh share edge 0 1"},
      {"ball.nff", "s 0 0 0 1\n", "metamorph ball.nff", "ball", "which this command does not take"},
      {"other.list", "other.list\n", "record other.list -o x.ctut", "other.list", "'.list' is no scene format we know"},
      {"cut.obj.zst", binary(0xFD2FB528u), "record cut.obj.zst -o x.ctut", "cut.obj.zst: byte 4",
       "ends inside a zstd frame"},
      {"noise.obj.zst", "not packed", "record noise.obj.zst -o x.ctut", "noise.obj.zst: byte 0", "is damaged as zstd"},
      {"scene.xyz", "", "record scene.xyz -o x.ctut", "scene.xyz", "'.xyz' is no scene format we know"},
      {"", "", "record . -o x.ctut", ".", "is no scene format we know"},
      {"", "", "record " + std::string(5000, 'a') + ".obj -o x.ctut", "aaaa", "cannot be opened"},
      {"nan.obj", "v 0 0 nan\n", "heatmap nan.obj -o x.png", "nan.obj:1", "is not a finite binary32 number"},
      {"nan.obj", "v 0 0 nan\n", "culling nan.obj", "nan.obj:1", "is not a finite binary32 number"},
      {"half.txt", "bunny\n", "culling --index half.txt", "half.txt:1", "a scene without a file"},
  };
}

/// Numbers and words of the command line that no scene or machine can follow.
std::vector<Case> options() {
  const auto record = [](const std::string& option, const std::string& where, const std::string& problem) {
    return Case{"", "", "record gen:tetra?depth=1 -o x.ctut " + option, where, problem};
  };
  return {
      record("--size 0x0", "rays", "width is 0"),
      record("--size 32769x1", "rays", "width is 32769"),
      record("--size 1e9x1e9", "--size", "\"1e9\" is not a number"),
      {"", "", "paper packets gen:tetra --packet 65", "packet size", "65 rays"},
      {"", "", "paper packets gen:tetra --window 1", "packet window", "fewer than a packet's 16"},
      {"", "", "paper packets gen:tetra --forming foo", "--forming", "unknown value \"foo\""},
      {"", "", "check --packets --budget 10 --engine cycle", "--packets", "no engine"},
      record("--spp 0", "rays", "samples_per_pixel is 0"),
      record("--spp 2000000", "rays", "samples_per_pixel is 2000000"),
      record("--bounces 5000", "rays", "bounces is 5000"),
      record("--rays random --count 1000000000000000000", "rays", "count is 1000000000000000000"),
      record("--threads -5", "--threads", "-5 is below 0"),
      record("--leaf 0", "max_leaf_triangles", "0"),
      record("--triangle-cost nan", "BVH build options", "must be finite and above 0"),
      record("--triangle-cost -1", "BVH build options", "must be finite and above 0"),
      record("--fov nan", "tetra", "field of view is not between 0 and 180"),
      record("--turn inf,0,0", "--turn", "\"inf,0,0\" is not finite"),
      record("--without '*a*b*c*d'", "tetra", "has more than 3 stars"),
      {"", "", "record gen:hair-ball?strands=1e12 -o x.ctut", "gen:hair-ball", "strands=1e12 is not a whole number"},
      {"", "", "record gen:hair-ball?strands=5000000 -o x.ctut", "gen:hair-ball",
       "not a whole number from 1 to 4000000"},
      {"", "", "record 'gen:hair-ball?strands=4000000&segments=4096' -o x.ctut", "gen:hair-ball",
       "brings the scene to more than 134217727 triangles"},
      {"", "", "record gen:tetra?depth=99 -o x.ctut", "gen:tetra", "depth=99 is not a whole number from 1 to 12"},
      {"", "", "config show --set unit.contexts=99999999999999999999", "--set unit.contexts", "is not allowed"},
  };
}

/// What the parser of the command line refuses itself.
std::vector<Case> unparsed_options() {
  return {
      {"", "", "record gen:tetra -o x.ctut --spp -1", "--spp", "-1"},
      {"", "", "record gen:tetra -o x.ctut --rays random --count 1e18", "--count", "1e18"},
      {"", "", "record gen:tetra -o x.ctut --r 99999999999999999999", "--r", "99999999999999999999"},
      {"", "", "record gen:tetra gen:tetra -o x.ctut", "scene", "At Most 1"},
      {"", "", "paper packets gen:tetra --sample -1", "--sample", "give a number from 0 on"},
      {"", "", "paper packets gen:tetra --least 0", "--least", "give a number from 1 on"},
      {"", "", "precision gen:tetra --sample -1", "--sample", "give a number from 0 on"},
      {"", "", "check --scene -1 --budget 10", "--scene", "give a number from 0 on"},
      {"", "", "record gen:tetra -o x.ctut --no-such-option", "--no-such-option", "not expected"},
  };
}

/// What is no file, and where nothing can be written.
std::vector<Case> files_and_outputs() {
  return {
      {"", "", "record pipe.obj -o x.ctut", "pipe.obj", "is a pipe or a device"},
      {"", "", "config show -c pipe.toml", "pipe.toml", "is a pipe or a device"},
      {"", "", "run pipe.ctut", "pipe.ctut", "is not a regular file"},
      {"", "", "culling --index pipe.txt", "pipe.txt", "is a pipe or a device"},
      {"", "", "record gen:tetra?depth=1 -o pipe", "pipe", "is a folder, a pipe or a device"},
      {"", "", "record gen:tetra?depth=1 -o .", ".", "is a folder, a pipe or a device"},
      {"", "", "record gen:tetra?depth=1 -o no/folder/x.ctut", "no/folder/x.ctut", "cannot be written"},
      {"", "", "heatmap gen:tetra?depth=1 --size 8x8 -o no/folder/x.png", "no/folder/x.png",
       "the picture could not be written"},
      {"", "", "heatmap gen:tetra?depth=1 --size 32768x32768 -o x.png", "", "out of memory", kLittleMemory},
      {"bomb.obj.zst", bomb(), "record bomb.obj.zst -o x.ctut", "bomb.obj.zst", "expand to more than 16777216 bytes"},
  };
}

/// Configurations and traces.
std::vector<Case> configurations_and_traces() {
  return {
      {"dots.toml", "[" + repeated("a.", 50'000) + "a]\n", "config show -c dots.toml", "dots.toml:1",
       "more than 32 dots in one line"},
      {"deep.toml", "a = " + std::string(5000, '['), "config show -c deep.toml", "deep.toml:1", "max"},
      {"large.toml", std::string(2 << 20, '#'), "config show -c large.toml", "large.toml", "is larger than 1 MiB"},
      {"latin.toml", "# caf\xe9\n", "config show -c latin.toml", "latin.toml:1", "invalid utf-8"},
      {"key.toml", std::string(200'000, 'k') + " = 1\n", "config show -c key.toml", "key.toml:1", "unknown key"},
      {"twice.toml", "[unit]\ncontexts = 8\ncontexts = 9\n", "config show -c twice.toml", "twice.toml:3", "contexts"},
      {"", "", "config show -c .", ".", "is a folder"},
      {"", "", "config show -c nowhere.toml", "nowhere.toml", "cannot be opened"},
      {"", "", "run .", ".", "is not a regular file"},
      {"empty.ctut", "", "run empty.ctut", "empty.ctut", "this is not a trace file"},
      {"empty.ctut", "", "trace info empty.ctut", "empty.ctut", "this is not a trace file"},
      {"noise.ctut", std::string(500, 'x'), "trace info noise.ctut", "noise.ctut", "this is not a trace file"},
      {"", "", "trace info nowhere.ctut", "nowhere.ctut", "cannot be opened"},
  };
}

/// The last backquoted piece of each row of the table in docs/numerics.md.
std::vector<std::string> documented_messages() {
  std::istringstream document(read_text(CTU_NUMERICS_PAGE));
  std::vector<std::string> messages;
  bool inside = false;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("## ")) inside = line == "## Refused inputs";
    const std::size_t last = line.rfind('`');
    if (!inside || !line.starts_with("| ") || last == std::string::npos) continue;
    const std::size_t first = line.rfind('`', last - 1);
    messages.push_back(line.substr(first + 1, last - first - 1));
  }
  return messages;
}

TEST_F(BrokenInput, every_documented_message_is_one_that_is_asserted_here) {
  std::vector<Case> cases = scene_files();
  for (const auto& more : {options(), configurations_and_traces(), files_and_outputs()})
    cases.insert(cases.end(), more.begin(), more.end());
  const std::vector<std::string> documented = documented_messages();
  EXPECT_GT(documented.size(), 30u);
  for (const std::string& message : documented)
    EXPECT_TRUE(std::any_of(cases.begin(), cases.end(), [&](const Case& c) {
      return c.problem.find(message) != std::string::npos;
    })) << message;
}

TEST_F(BrokenInput, scene_files_are_refused_by_place_problem_and_remedy) { expect_refused(scene_files()); }
TEST_F(BrokenInput, absurd_options_are_refused_by_name) {
  expect_refused(options());
  for (const Case& c : unparsed_options()) expect_refused(c, true);
}
TEST_F(BrokenInput, configurations_and_traces_are_refused_by_place_problem_and_remedy) {
  expect_refused(configurations_and_traces());
}

TEST_F(BrokenInput, pipes_and_folders_are_refused_without_waiting_for_them) {
  for (const char* name : {"pipe", "pipe.obj", "pipe.toml", "pipe.ctut", "pipe.txt"})
    ASSERT_EQ(mkfifo(file(name).c_str(), 0600), 0);
  expect_refused(files_and_outputs());
  struct stat status;
  ASSERT_EQ(stat(file("pipe").c_str(), &status), 0);
  EXPECT_TRUE(S_ISFIFO(status.st_mode)) << "a trace took the place of a pipe";
}

// In the shell that the program is run by: no file longer than a block, no more memory, no room behind standard output.
TEST_F(BrokenInput, a_full_disk_is_named_and_leaves_no_part_of_a_trace) {
  const Outcome outcome = run_program(folder_.path(), "record gen:hair-ball?strands=300 --size 32x32 -o x.ctut",
                                      "ulimit -f 8; trap '' XFSZ");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("x.ctut: cannot be written: File too large"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(file("x.ctut")) || std::filesystem::exists(file("x.ctut.part")));
}

TEST_F(BrokenInput, memory_or_threads_that_are_not_there_end_in_results_or_a_message) {
  for (const std::string arguments : {"record gen:hair-ball?strands=2000000 -o x.ctut",
                                      "record gen:hair-ball?strands=200 --threads 2000 --size 64x64 -o y.ctut"}) {
    const Outcome outcome = run_program(folder_.path(), arguments, kLittleMemory);
    if (outcome.exit_code == 0) continue;  // fewer threads do the work too
    EXPECT_EQ(outcome.exit_code, 2) << arguments << outcome.err;
    EXPECT_NE(outcome.err.find("out of memory"), std::string::npos) << arguments << outcome.err;
  }
}

TEST_F(BrokenInput, standard_output_that_cannot_be_written_ends_with_a_message) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  for (const std::string arguments : {"config show", "config show --plain", "tables", "--version"}) {
    const Outcome outcome = run_program(folder_.path(), arguments + " >/dev/full 2>said.txt; exit $?; true");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(read_text(file("said.txt")).find("remedy: "), std::string::npos) << arguments;
  }
}

TEST_F(BrokenInput, names_that_are_no_utf8_are_recorded_and_reported) {
  write_text(file("caf\xe9.obj"), kTriangle);
  const std::string record = "record 'caf\xe9.obj' --size 8x8 -o 'caf\xe9.ctut'";
  ASSERT_EQ(run_program(folder_.path(), record).exit_code, 0);
  const Outcome outcome = run_program(folder_.path(), "run 'caf\xe9.ctut' --json r.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(read_text(file("r.json")).find("\"wrong_hits\": 0"), std::string::npos);
}

}  // namespace
