// Every bit that a unit keeps on chip, structure by structure, in closed form: tables, caches, what contexts hold, and
// the registers of links and misses. Registers inside pipelined stages are not among them: they are gates' area.
//
// Memories are those of rtl/ with the widths written there; `ctusim area` counts the same bits where the configuration
// is one that it does not round (contexts and stack entries powers of two, both caches alike), by test.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ctu::energy {

struct UnitShape;

/// Bits of an address in memory, as rtl/ctu_unit.sv has them.
inline constexpr int kAddressBits = 40;
/// Of a request's number, the line's place in the answer.
inline constexpr int kRequestIdBits = 8;

enum class Keeping : std::uint8_t {
  Memory,     ///< an array with a word and an address: what `ctusim area` calls memory bits
  Registers,  ///< flip-flops: links, miss registers, the rows that table_fetch brings
};

struct Structure {
  std::string stage;  ///< as rtl/ names it; register files of contexts: "context_file"
  std::string name;
  std::uint64_t bits = 0;
  Keeping keeping = Keeping::Memory;
};

/// A link between stages: its token's bits. It keeps two tokens.
struct LinkBits {
  std::string name;
  int bits = 0;
};
std::vector<LinkBits> links_of(const UnitShape& shape);

std::vector<Structure> on_chip_structures(const UnitShape& shape);

/// Of all of them, or of those of a kind.
std::uint64_t bits_of(const std::vector<Structure>& structures);
std::uint64_t bits_of(const std::vector<Structure>& structures, Keeping keeping);

/// Widths of the contexts' register files in bits (rtl/ctu_unit.sv).
inline constexpr int kRayBits = 173, kSetupBits = 256, kHitBits = 128, kEntryTimesBits = 128, kSlabTimesBits = 1664,
                     kKeyBits = 31, kDecodedBoxBits = 768, kExitTimesBits = 128, kStayBits = 64, kDirectionBits = 96;
/// Of a node as it lies unpacked by context: boxes, children, masks, which are full.
int unpacked_node_bits(const UnitShape& shape);
/// Bits of a context's number.
int slot_bits(const UnitShape& shape);

}  // namespace ctu::energy
