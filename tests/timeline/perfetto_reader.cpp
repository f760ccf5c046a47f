#include "tests/timeline/perfetto_reader.h"

#include <gtest/gtest.h>

#include <string_view>

namespace ctu::test {
namespace {

/// The fields of one message, by number.
struct Message {
  std::map<int, std::uint64_t> numbers;
  std::map<int, std::vector<std::string_view>> texts;

  explicit Message(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::uint64_t tag = varint(bytes);
      const int field = static_cast<int>(tag >> 3);
      if ((tag & 7) == 0) {
        numbers[field] = varint(bytes);
      } else if ((tag & 7) == 2) {
        const std::uint64_t size = varint(bytes);
        if (size > bytes.size()) {
          ADD_FAILURE() << "field " << field << " is longer than its message";
          return;
        }
        texts[field].push_back(bytes.substr(0, size));
        bytes.remove_prefix(size);
      } else {
        ADD_FAILURE() << "wire type " << (tag & 7);
        return;
      }
    }
  }
  std::string text(int field) const {
    const auto found = texts.find(field);
    return found == texts.end() ? "" : std::string(found->second.back());
  }
  std::uint64_t number(int field) const {
    const auto found = numbers.find(field);
    return found == numbers.end() ? 0 : found->second;
  }

  static std::uint64_t varint(std::string_view& bytes) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64 && !bytes.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes.front());
      bytes.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
      if (byte < 0x80) return value;
    }
    ADD_FAILURE() << "a number does not end";
    return value;
  }
};

class Reader {
 public:
  std::map<std::uint64_t, PerfettoTrack> read(const std::string& bytes) {
    const Message trace(bytes);
    EXPECT_EQ(trace.texts.size(), 1u);
    EXPECT_TRUE(trace.numbers.empty());
    for (const std::string_view packet : trace.texts.at(1)) read_packet(Message(packet));
    for (const auto& [number, open] : open_)
      EXPECT_TRUE(open.empty()) << "a slice has no end: " << tracks_[number].name;
    return tracks_;
  }

 private:
  void read_packet(const Message& packet) {
    EXPECT_EQ(packet.number(10), 1u) << "sequence";
    EXPECT_TRUE(!first_ || (packet.number(13) & 1) == 1) << "the state of the sequence begins anew";
    first_ = false;
    if (packet.texts.contains(60)) read_track(Message(packet.texts.at(60).front()));
    if (packet.texts.contains(12)) read_names(Message(packet.texts.at(12).front()));
    if (packet.texts.contains(11)) read_event(packet.number(8), Message(packet.texts.at(11).front()));
  }

  void read_names(const Message& interned) {
    for (const std::string_view text : interned.texts.at(2)) {
      const Message name(text);
      EXPECT_TRUE(names_.emplace(name.number(1), name.text(2)).second);
    }
  }

  void read_track(const Message& descriptor) {
    PerfettoTrack& track = tracks_[descriptor.number(1)];
    EXPECT_TRUE(track.name.empty() && track.process.empty()) << "described twice";
    track.name = descriptor.text(2);
    track.parent = descriptor.number(5);
    track.counter = descriptor.texts.contains(8);
    if (descriptor.texts.contains(3)) track.process = Message(descriptor.texts.at(3).front()).text(6);
    EXPECT_TRUE(track.parent == 0 || tracks_.contains(track.parent));
  }

  void read_event(std::uint64_t at, const Message& event) {
    EXPECT_GE(at, now_);
    now_ = at;
    ASSERT_TRUE(tracks_.contains(event.number(11)));
    PerfettoTrack& track = tracks_[event.number(11)];
    std::vector<std::size_t>& open = open_[event.number(11)];
    EXPECT_EQ(track.counter, event.number(9) == 4);
    switch (event.number(9)) {
      case 1:
        ASSERT_TRUE(names_.contains(event.number(10)));
        open.push_back(track.slices.size());
        track.slices.push_back({names_[event.number(10)], at, at, static_cast<int>(open.size()) - 1});
        break;
      case 2:
        ASSERT_FALSE(open.empty());
        track.slices[open.back()].end = at;
        open.pop_back();
        break;
      default:
        ASSERT_EQ(event.number(9), 4u);
        track.counted.emplace_back(at, static_cast<std::int64_t>(event.number(30)));
    }
  }

  std::map<std::uint64_t, PerfettoTrack> tracks_;
  std::map<std::uint64_t, std::vector<std::size_t>> open_;
  std::map<std::uint64_t, std::string> names_;
  std::uint64_t now_ = 0;
  bool first_ = true;
};

}  // namespace

std::map<std::uint64_t, PerfettoTrack> read_perfetto(const std::string& bytes) { return Reader().read(bytes); }

}  // namespace ctu::test
