// write_sqlite: the collected table as a database.
#include <sqlite3.h>

#include <memory>

#include <nlohmann/json.hpp>

#include "model/base/error.h"
#include "sim/sweep/collect.h"

namespace ctu::sweep {
namespace {

using nlohmann::ordered_json;

class Database {
 public:
  explicit Database(const std::filesystem::path& file) : file_(file) {
    if (sqlite3_open(file.c_str(), &database_) != SQLITE_OK) refuse();
  }
  ~Database() { sqlite3_close(database_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void run(const std::string& statement) {
    if (sqlite3_exec(database_, statement.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) refuse();
  }
  /// A row for the placeholders of an INSERT.
  void insert(const std::string& statement, const std::vector<const ordered_json*>& cells) {
    sqlite3_stmt* prepared = nullptr;
    if (sqlite3_prepare_v2(database_, statement.c_str(), -1, &prepared, nullptr) != SQLITE_OK) refuse();
    const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> owner(prepared, &sqlite3_finalize);
    for (std::size_t i = 0; i < cells.size(); ++i) bind(prepared, static_cast<int>(i) + 1, cells[i]);
    if (sqlite3_step(prepared) != SQLITE_DONE) refuse();
  }

 private:
  void bind(sqlite3_stmt* statement, int place, const ordered_json* cell) {
    int outcome = SQLITE_OK;
    if (cell == nullptr || cell->is_null())
      outcome = sqlite3_bind_null(statement, place);
    else if (cell->is_boolean())
      outcome = sqlite3_bind_int(statement, place, cell->get<bool>() ? 1 : 0);
    else if (cell->is_number_integer())
      outcome = sqlite3_bind_int64(statement, place, cell->get<std::int64_t>());
    else if (cell->is_number())
      outcome = sqlite3_bind_double(statement, place, cell->get<double>());
    else
      outcome = sqlite3_bind_text(statement, place, cell->get_ref<const std::string&>().c_str(), -1, SQLITE_TRANSIENT);
    if (outcome != SQLITE_OK) refuse();
  }
  [[noreturn]] void refuse() const {
    throw Error(file_.string(), sqlite3_errmsg(database_),
                "check the folder, its permissions and the space on the disk");
  }

  std::filesystem::path file_;
  sqlite3* database_ = nullptr;
};

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

const char* type_of(const Table& table, const std::string& column) {
  bool fractions = false;
  for (const ordered_json& row : table.rows) {
    const auto cell = row.find(column);
    if (cell == row.end() || cell->is_null()) continue;
    if (cell->is_string()) return "TEXT";
    fractions |= cell->is_number_float();
  }
  return fractions ? "REAL" : "INTEGER";
}

std::string placeholders(std::size_t count) {
  std::string text = "?";
  for (std::size_t i = 1; i < count; ++i) text += ",?";
  return text;
}

void write_results(Database& database, const Table& table) {
  std::string columns;
  for (const std::string& column : table.columns)
    columns += (columns.empty() ? "" : ", ") + quoted(column) + " " + type_of(table, column);
  database.run("CREATE TABLE results (" + columns + ")");
  const std::string insert = "INSERT INTO results VALUES (" + placeholders(table.columns.size()) + ")";
  for (const ordered_json& row : table.rows) {
    std::vector<const ordered_json*> cells;
    for (const std::string& column : table.columns) {
      const auto cell = row.find(column);
      cells.push_back(cell == row.end() ? nullptr : &*cell);
    }
    database.insert(insert, cells);
  }
}

}  // namespace

void write_sqlite(const Table& table, const std::filesystem::path& file) {
  const std::filesystem::path fresh = file.string() + ".new";
  std::filesystem::remove(fresh);
  {
    Database database(fresh);
    database.run("PRAGMA synchronous = OFF; PRAGMA journal_mode = OFF");  // a file of that name is whole already
    database.run("BEGIN");
    if (!table.columns.empty()) write_results(database, table);
    database.run("CREATE TABLE columns (name TEXT PRIMARY KEY, unit TEXT, meaning TEXT)");
    for (const ColumnNote& note : table.notes) {
      const ordered_json name = note.name, unit = note.unit, meaning = note.meaning;
      database.insert("INSERT INTO columns VALUES (?,?,?)", {&name, &unit, &meaning});
    }
    database.run("COMMIT");
  }
  std::filesystem::rename(fresh, file);
}

}  // namespace ctu::sweep
