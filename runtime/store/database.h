// SQLite behind two classes whose failures are ours. database.cpp is the only file that includes
// SQLite. Knows nothing of runs. A database may come from a stranger: what it brings along is never
// run (triggers, views, functions), and values have a largest size.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace probe::store {

class Database {
 public:
  enum class Access { kRead, kWrite };
  // Of the rows of a run, which its traces bear.
  static constexpr const char* kRunAdvice =
      "the traces are intact: move this file away and run again";

  // Readers too may have to roll back what a killed writer left. A writer makes the file if it is
  // absent and waits for the disk after each transaction. Fails with kStore, where = path, also on
  // what is no regular file. `advice`: what to do about a file that cannot be read.
  static Result<Database> open(const std::string& path, Access access,
                               std::string advice = kRunAdvice);
  ~Database();
  Database(Database&& other) noexcept
      : handle_(std::exchange(other.handle_, nullptr)),
        path_(std::move(other.path_)),
        advice_(std::move(other.advice_)) {}
  Database& operator=(Database&&) = delete;

  Status execute(const char* sql);

  // Fails (kStore) unless the database has nothing but tables, all of them among `tables`, with
  // those of their columns and no others; a table may be absent.
  struct Table {
    std::string_view name;
    std::span<const std::string_view> columns;
  };
  Status expect(std::span<const Table> tables);
  const std::string& path() const { return *path_; }

 private:
  friend class Statement;
  Database() = default;
  Failure failure(Access access) const;
  std::string name() const;  // of the file, without its folder
  sqlite3* handle_ = nullptr;
  std::unique_ptr<std::string> path_;  // stays in its place when this is moved: SQLite knows it
  std::string advice_;
};

// A prepared statement: values are bound from left to right, then next() goes from row to row.
class Statement {
 public:
  Statement(Database& database, const char* sql, Database::Access access = Database::Access::kRead);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(const std::string& value);
  Statement& bind(int value);
  Statement& bind(std::int64_t value);
  Statement& bind(double value);
  Statement& bind_null();
  Statement& bind(const std::optional<std::string>& value);

  // From the beginning, with values bound anew.
  void restart();
  // True while there is a row.
  bool next();
  std::string text(int column) const;
  std::optional<std::string> optional_text(int column) const;
  int number(int column) const;  // the nearest there is: never what is left of a larger one
  std::int64_t whole(int column) const;
  double real(int column) const;
  enum class Kind { kNull, kWhole, kReal, kText, kOther };
  Kind kind(int column) const;
  std::size_t bytes(int column) const;  // of its text

  // After the last next(); the failure's place is the database's file.
  Status done() const;

 private:
  Database& database_;
  Database::Access access_;
  sqlite3_stmt* statement_ = nullptr;
  int code_ = 0;
  int bound_ = 0;
};

}  // namespace probe::store
