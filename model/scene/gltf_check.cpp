#include "model/scene/gltf_check.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>

#include "model/base/error.h"
#include "model/base/read_file.h"
#include "model/scene/byte_cursor.h"

namespace ctu::scene {
namespace {

using Json = nlohmann::json;

constexpr int kDeepestValue = 100;
constexpr std::uint64_t kMostCopiedBytes = std::uint64_t{256} << 20;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
constexpr const char* kDamaged = "the file is damaged or was exported wrongly: export it again";

/// Follows the text without keeping it: how deep it goes, and how many buffers it names.
class GltfText : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override {
    buffers_ += in_buffers_ && depth_ == 2;
    return enter();
  }
  bool key(string_t& name) override {
    if (depth_ == 1) in_buffers_ = name == "buffers";
    return true;
  }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t position, const std::string&, const Json::exception& problem) override {
    byte_ = position;
    problem_ = std::string("is no glTF file: ") + problem.what();
    return false;
  }

  std::size_t byte() const { return byte_; }
  const std::string& problem() const { return problem_; }
  std::uint64_t buffers() const { return buffers_; }

 private:
  bool enter() {
    if (++depth_ <= kDeepestValue) return true;
    problem_ = fmt::format("values are nested more than {} deep", kDeepestValue);
    return false;
  }
  bool leave() {
    --depth_;
    return true;
  }

  int depth_ = 0;
  bool in_buffers_ = false;
  std::uint64_t buffers_ = 0;
  std::size_t byte_ = 0;
  std::string problem_;
};

/// The number of buffers.
std::uint64_t check_text(const SourceFile& file, std::string_view text, std::size_t offset) {
  GltfText handler;
  if (!Json::sax_parse(text.begin(), text.end(), &handler))
    throw Error(fmt::format("{}: byte {}", file.path, offset + handler.byte()), handler.problem(), kDamaged);
  return handler.buffers();
}

}  // namespace

void check_gltf(const SourceFile& file) { check_text(file, file.bytes, 0); }

void check_glb(const SourceFile& file) {
  ByteCursor bytes(file);
  if (!file.bytes.starts_with("glTF"))
    throw Error(file.path + ": byte 0", "is no GLB: it does not start with 'glTF'", "check the file's name");
  bytes.skip(12, "the header");
  const auto text_bytes = bytes.take<std::uint32_t>("the JSON chunk's header");
  if (bytes.take<std::uint32_t>("the JSON chunk's header") != kJsonChunk)
    throw Error(file.path + ": byte 16", "the first chunk is not JSON", kDamaged);
  const std::size_t text_offset = bytes.offset();
  bytes.skip(text_bytes, "the JSON chunk");
  const std::uint64_t buffers =
      check_text(file, std::string_view(file.bytes).substr(text_offset, text_bytes), text_offset);
  if (bytes.bytes_left() == 0) return;
  const auto binary_bytes = bytes.take<std::uint32_t>("the binary chunk's header");
  if (bytes.take<std::uint32_t>("the binary chunk's header") != kBinChunk)
    throw Error(bytes.where(), "the second chunk is not binary", kDamaged);
  bytes.expect(binary_bytes, 1, "bytes of the binary chunk");
  if (buffers > 1 && buffers * binary_bytes > kMostCopiedBytes)
    throw Error(file.path, fmt::format("{} buffers share a binary chunk of {}", buffers, bytes_text(binary_bytes)),
                "only the first buffer of a GLB lies in the file: export it again");
}

}  // namespace ctu::scene
