// What an operation, an access, a stored bit and a gate cost: a table with the source of every number, ours of 45 nm
// (default_table.toml) or the user's.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace ctu::energy {

struct TableEntry {
  double value = 0;
  std::string unit, source;
};

class EnergyTable {
 public:
  /// default_table.toml.
  static const EnergyTable& standard();
  /// A TOML file with every entry of the default one. Throws Error naming the place for what is no table, for entries
  /// missing or unknown, in other units, without a source, or not positive.
  static EnergyTable read(const std::string& path);
  static EnergyTable parse(const std::string& text, const std::string& place);

  const std::string& name() const { return name_; }
  const std::string& technology() const { return technology_; }
  const std::string& hash() const { return hash_; }  ///< of its text: 32 hexadecimal digits
  /// By key, as "operation.add".
  const std::map<std::string, TableEntry>& entries() const { return entries_; }

  /// One of the entries; asking for one that no table has is a mistake of ours.
  double at(const std::string& key) const { return entries_.at(key).value; }
  /// pJ of a bit read or written in a memory of so many bits: memory.access for access_bits, scaled from access_bytes
  /// by capacity to the power of capacity_exponent, and never below least_bytes.
  double access_pj(double capacity_bits) const;
  /// pJ that so many nW take in so many cycles of clock.frequency.
  double leakage_pj(double nanowatts, double cycles) const;

 private:
  std::string name_, technology_, hash_;
  std::map<std::string, TableEntry> entries_;
};

/// The text of default_table.toml.
const char* default_table_text();

}  // namespace ctu::energy
