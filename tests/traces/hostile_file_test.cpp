// Files that are damaged, cut, foreign, newer or made to mislead: refused with a message, or read as what was written.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <random>

#include <sys/stat.h>

#include "model/accel/image.h"
#include "model/base/error.h"
#include "model/base/hash.h"
#include "tests/traces/parts.h"
#include "tests/traces/test_support.h"
#include "traces/columns.h"
#include "traces/file.h"
#include "traces/trace_writer.h"
#include "traces/validate_block.h"

namespace ctu::traces {
namespace {

using cull::Design;
using test::TemporaryFolder;

using test::Bytes;
using test::Parts;

class HostileFile : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    RecordOptions options = test::small_options();
    options.rays.width = options.rays.height = 8;
    record(test::hair_scene(), options, good());
    content_ = new test::Content(test::read_all(good()));
  }
  static void TearDownTestSuite() {
    delete content_;
    delete folder_;
  }
  static std::string good() { return folder_->file("good.ctut"); }
  static std::string bad() { return folder_->file("bad.ctut"); }

  /// The message of the refusal; fails when the file is read instead, or when something else is thrown.
  static std::string refusal(const std::string& path) {
    try {
      test::read_all(path);
    } catch (const Error& problem) {
      EXPECT_EQ(problem.where(), path);
      return problem.problem();
    }
    ADD_FAILURE() << "the file was read";
    return "";
  }
  static void expect_refusal(const std::string& path, const std::string& part) {
    const std::string message = refusal(path);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }

  static TemporaryFolder* folder_;
  static test::Content* content_;
};
TemporaryFolder* HostileFile::folder_ = nullptr;
test::Content* HostileFile::content_ = nullptr;

TEST_F(HostileFile, a_changed_byte_is_refused_or_changes_nothing) {
  const std::uint64_t seed = test::test_seed(31);
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  const Bytes whole = test::read_bytes(good());
  int refused = 0, unchanged = 0;
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes = whole;
    const std::size_t place = i < 32    ? static_cast<std::size_t>(i)
                              : i < 104 ? bytes.size() - 104 + static_cast<std::size_t>(i)
                                        : random() % bytes.size();
    const auto change = static_cast<std::uint8_t>(1 + random() % 255);
    bytes[place] ^= change;
    test::write_bytes(bad(), bytes);
    try {
      EXPECT_TRUE(test::same(test::read_all(bad()), *content_)) << "byte " << place << " ^ " << int{change};
      ++unchanged;
    } catch (const Error& problem) {
      EXPECT_EQ(problem.where(), bad());
      ++refused;
    }
  }
  EXPECT_GT(refused, 1900);
  RecordProperty("unchanged", unchanged);
}

TEST_F(HostileFile, a_file_cut_at_any_frame_is_refused) {
  const Bytes whole = test::read_bytes(good());
  const InputFile file(good());
  std::vector<std::size_t> ends = {0, 1, sizeof(FileHeader), whole.size() - sizeof(FileFooter), whole.size() - 1};
  for (const IndexEntry& entry : read_layout(file).index)
    for (const std::uint64_t end : {entry.offset, entry.offset + 1, entry.offset + entry.stored_bytes - 1})
      ends.push_back(end);
  for (const std::size_t end : ends) {
    test::write_bytes(bad(), {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(end)});
    EXPECT_NE(refusal(bad()), "") << "cut at byte " << end;
  }
  Bytes longer = whole;
  longer.push_back(0);
  test::write_bytes(bad(), longer);
  expect_refusal(bad(), "footer");
}

TEST_F(HostileFile, given_another_version_then_another_major_is_refused_and_a_newer_minor_is_read) {
  Bytes bytes = test::read_bytes(good());
  const auto write_version = [&](std::uint16_t major, std::uint16_t minor) {
    FileHeader header = make_header();
    header.major = major;
    header.minor = minor;
    header.checksum = hash64(&header, offsetof(FileHeader, checksum));
    std::memcpy(bytes.data(), &header, sizeof header);
    test::write_bytes(bad(), bytes);
  };
  write_version(kFormatMajor + 1, 0);
  expect_refusal(bad(), "version 3.0");
  write_version(1, 0);
  expect_refusal(bad(), "format version 1.0; this program reads version 2");
  write_version(kFormatMajor, kFormatMinor + 7);
  EXPECT_TRUE(test::same(test::read_all(bad()), *content_));
}

TEST_F(HostileFile, a_foreign_file_is_refused_as_such) {
  for (const std::string text : {"", "v 0 0 0\nf 1 1 1\n", "\x28\xb5\x2f\xfd", "CTUTRACE"}) {
    test::write_bytes(bad(), {text.begin(), text.end()});
    expect_refusal(bad(), "not a trace file");
  }
  test::write_bytes(bad(), Bytes(5000, 0));
  expect_refusal(bad(), "not a trace file");
  expect_refusal(folder_->file("missing.ctut"), "cannot be opened");
  expect_refusal(folder_->file(""), "not a regular file");
}

TEST_F(HostileFile, sections_and_columns_of_a_newer_program_are_skipped) {
  Parts parts(good());
  parts.replace("\"sections\": [", "\"colour\": \"red\", \"sections\": [");
  parts.replace("\"name\": \"kind\",",
                "\"name\": \"weight\", \"type\": \"f64\", \"per\": \"ray\", \"unit\": \"\","
                " \"description\": \"\" }, { \"name\": \"kind\",");
  const std::size_t end = parts.manifest.rfind(']');
  parts.manifest.insert(end,
                        ", {\"name\": \"weather\", \"columns\": [{\"name\": \"rain\", \"type\": \"mm\","
                        " \"per\": \"day\", \"unit\": \"\", \"description\": \"\"}]}\n");
  std::vector<Parts::Chunk> chunks;
  for (Parts::Chunk chunk : parts.chunks) {
    if (chunk.entry.section == 1 && chunk.entry.column == 8) {
      Parts::Chunk weight = chunk;
      weight.frame.assign(40, 7);
      if (chunk.entry.block == 0) chunks.push_back(weight);
      chunk.entry.column = 9;
    }
    chunks.push_back(chunk);
  }
  // A column in front of the image's words.
  parts.replace("\"name\": \"words\",",
                "\"name\": \"age\", \"type\": \"u8\", \"per\": \"day\", \"unit\": \"\","
                " \"description\": \"\" }, { \"name\": \"words\",");
  for (Parts::Chunk& chunk : chunks)
    if (chunk.entry.section == 0) chunk.entry.column = 1;
  Parts::Chunk rain = chunks.back();
  rain.entry.section = 6;
  rain.entry.column = 0;
  rain.entry.block = 0;
  chunks.push_back(rain);
  parts.chunks = chunks;
  parts.write(bad());
  test::Content read = test::read_all(bad());
  EXPECT_NE(read.hash, content_->hash);
  read.hash = content_->hash;
  EXPECT_TRUE(test::same(read, *content_));
  EXPECT_NO_THROW(TraceReader(bad()).verify());
}

TEST_F(HostileFile, given_numbers_that_lie_when_every_checksum_is_right_then_they_are_refused) {
  const auto forged = [&](const std::function<void(Parts&)>& change) {
    Parts parts(good());
    change(parts);
    parts.write(bad());
    return refusal(bad());
  };
  const auto contains = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  // Sizes that would take all memory, if they were believed.
  contains(forged([](Parts& p) { p.chunk_of(3, 2).entry.elements = UINT32_MAX; }), "steps.none.ref");
  contains(forged([](Parts& p) { p.chunk_of(0, 0).entry.elements = 1u << 30; }), "image");
  contains(forged([](Parts& p) { p.replace("\"size_bytes\": ", "\"size_bytes\": 9"); }), "image");
  contains(forged([](Parts& p) { p.chunk_of(1, 0).entry.elements = kMaxRaysPerBlock + 1; }), "rays");
  contains(forged([](Parts& p) { p.chunk_of(1, 3).entry.elements -= 1; }), "rays");
  contains(forged([](Parts& p) { p.chunk_of(1, 3).entry.block = 5; }), "index");
  contains(forged([](Parts& p) { p.chunk_of(1, 3).entry.section = 77; }), "index");
  contains(forged([](Parts& p) { p.chunk_of(2, 3).entry.column = 77; }), "index");
  contains(forged([](Parts& p) { p.chunks.pop_back(); }), "steps.comparators");
  contains(forged([](Parts& p) { p.replace("\"name\": \"hits\"", "\"name\": \"lost\""); }), "hits");
  contains(forged([](Parts& p) { p.replace("\"name\": \"tmax\"", "\"name\": \"lost\""); }), "tmax");
  contains(forged([](Parts& p) { p.replace("\"ray_count\": ", "\"ray_count\": 1"); }), "rays");
  // A manifest that is none.
  contains(forged([](Parts& p) { p.manifest = "{"; }), "manifest");
  contains(forged([](Parts& p) { p.manifest = "[1]"; }), "manifest");
  contains(forged([](Parts& p) { p.manifest = std::string(1 << 20, '['); }), "manifest");
  contains(forged([](Parts& p) { p.manifest.clear(); }), "manifest");
  contains(forged([](Parts& p) { p.replace("\"resolution\": 4", "\"resolution\": 99"); }), "resolution");
  contains(forged([](Parts& p) { p.replace("\"width\": 8", "\"width\": -8"); }), "width");
  contains(forged([](Parts& p) { p.replace("\"seed\": 1", "\"seed\": 1.5"); }), "seed");
  contains(forged([](Parts& p) { p.replace("\"node_count\": ", "\"node_count\": 1"); }), "image");
  contains(forged([](Parts& p) { p.replace("\"mask_bits\": 64", "\"mask_bits\": 63"); }), "image");
  contains(forged([](Parts& p) { p.replace("\"triangles\": ", "\"triangles\": 0, \"x\": "); }), "hits");
}

TEST_F(HostileFile, given_an_image_that_is_no_tree_when_every_checksum_is_right_then_it_is_refused) {
  const std::uint64_t seed = test::test_seed(41);
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  Parts parts(good());
  const auto words = Parts::elements<std::uint32_t>(parts.chunks[0]);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::uint32_t> changed = words;
    changed[random() % changed.size()] ^= static_cast<std::uint32_t>(1 + random() % 255) << (8 * (random() % 4));
    Parts::set_elements(parts.chunks[0], changed);
    parts.write(bad());
    try {
      const Bytes image = test::read_all(bad()).image;  // another box or mask is still an image
      EXPECT_EQ(image.size(), 4 * changed.size());
      EXPECT_EQ(std::memcmp(image.data(), changed.data(), image.size()), 0);
    } catch (const Error& problem) {
      EXPECT_EQ(problem.where(), bad());
    }
  }
}

/// What a replay does with steps: it follows its own stack and looks nothing up that was not checked.
bool walk_ends(const reference::RayBlock& block, const accel::Bvh4& bvh) {
  for (std::uint64_t ray = 0; ray < block.rays.size(); ++ray) {
    std::vector<accel::ChildRef> stack = {0};
    const bool any_hit = block.rays[ray].kind == intersect::RayKind::AnyHit;
    bool found = false;
    for (std::uint64_t i = block.steps.first_step.at(ray); i < block.steps.first_step.at(ray + 1); ++i) {
      const reference::Step& step = block.steps.steps.at(i);
      for (int n = 0; n <= step.dropped; ++n) {
        if (stack.empty()) return false;
        if (n == step.dropped && stack.back() != step.ref) return false;
        stack.pop_back();
      }
      found = found || (step.is_leaf() && any_hit && step.became_best() != 0);
      if (step.is_leaf()) continue;
      int survivors = 0;
      for (unsigned lanes = step.survivors(); lanes != 0; lanes &= lanes - 1) ++survivors;
      for (int n = survivors - 1; n >= 0; --n) {
        const accel::ChildRef child = bvh.nodes.at(step.ref).child[step.survivor(n)];
        if (child == accel::kEmptyChild) return false;
        stack.push_back(child);
      }
    }
    if (block.steps.first_step[ray] == block.steps.first_step[ray + 1]) continue;
    if (!found && stack.size() != block.steps.tail_dropped.at(ray)) return false;
  }
  return true;
}

TEST_F(HostileFile, steps_that_pass_the_check_are_a_walk_through_the_image) {
  const std::uint64_t seed = test::test_seed(51);
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  const TraceReader reader(good());
  const accel::Bvh4 bvh = accel::decode(reader.read_image());
  const reference::RayBlock block = reader.read_block(0, Design::MaskLut);
  ASSERT_TRUE(walk_ends(block, bvh));
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    reference::RayBlock changed = block;
    auto& list = changed.steps;
    const std::size_t at = random() % list.steps.size();
    reference::Step& step = list.steps[at];
    const int what = i % 7;
    if (what == 0) step.ref ^= 1u << (random() % 32);
    if (what == 1) step.dropped = static_cast<std::uint8_t>(step.dropped + 1 + random() % 255);
    if (what == 2) step.lanes = static_cast<std::uint8_t>(random());
    if (what == 3) step.detail = static_cast<std::uint16_t>(random());
    if (what == 4)
      list.tail_dropped[random() % list.tail_dropped.size()] += static_cast<std::uint8_t>(1 + random() % 255);
    if (what == 5) list.keys[random() % list.keys.size()] = 0x00444444u << (random() % 2);
    if (what == 6) changed.rays[random() % changed.rays.size()].kind = intersect::RayKind::AnyHit;
    bool passed = true;
    try {
      validate_block(changed, bvh, reader.manifest().masks, good());
    } catch (const Error&) {
      passed = false;
      ++refused;
    }
    const bool must_be_refused = what <= 1 || what == 4 || what == 5;
    EXPECT_FALSE(passed && must_be_refused) << "change " << i << " of kind " << what;
    EXPECT_TRUE(!passed || walk_ends(changed, bvh)) << "change " << i << " of kind " << what;
  }
  EXPECT_GT(refused, 10000);
}

TEST_F(HostileFile, a_pipe_is_neither_waited_for_nor_replaced) {
  const std::string pipe = folder_->file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(refusal(pipe).find("is not a regular file"), std::string::npos);
  EXPECT_THROW(OutputFile{pipe}, Error);
  struct stat status;
  ASSERT_EQ(stat(pipe.c_str(), &status), 0);
  EXPECT_TRUE(S_ISFIFO(status.st_mode));
}

}  // namespace
}  // namespace ctu::traces
