// The adapter to SQLite.
#include "runtime/store/database.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "runtime/base/paths.h"
#include "runtime/base/printable.h"
#include "runtime/store/folder_lock.h"

namespace probe::store {
namespace {

// Of one value: a row of results has a few thousand bytes.
constexpr int kLargestValue = 1 << 20;

// SQLite's own advice for databases of strangers (sqlite.org/security.html), and more.
void distrust(sqlite3* database) {
  for (const int on : {SQLITE_DBCONFIG_DEFENSIVE}) sqlite3_db_config(database, on, 1, nullptr);
  for (const int off : {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER,
                        SQLITE_DBCONFIG_ENABLE_VIEW, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION}) {
    sqlite3_db_config(database, off, 0, nullptr);
  }
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, kLargestValue);
  sqlite3_limit(database, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_limit(database, SQLITE_LIMIT_TRIGGER_DEPTH, 0);
  sqlite3_limit(database, SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 100);
}

// Of the folder that it lies in.
std::string folder_of(const std::string& path) {
  const auto end = path.rfind('/');
  return end == path.npos ? "." : path.substr(0, end);
}

// Another process writes for a moment; a file system without locks says the same, for ever.
int wait_for_lock(void* database, int tries) {
  constexpr int kPause = 20'000, kMostTries = 500;  // us
  if (tries == 0 && !FolderLock::lack(folder_of(*static_cast<std::string*>(database))).empty())
    return 0;
  if (tries >= kMostTries) return 0;
  ::usleep(kPause);
  return 1;
}

}  // namespace

Result<Database> Database::open(const std::string& path, Access access, std::string advice) {
  Database database;
  database.path_ = std::make_unique<std::string>(path);
  database.advice_ = std::move(advice);
  if (is_there(path) && !is_file(path)) {
    return Failure{Fault::kStore, "is no file but a folder, a device or a pipe", path};
  }
  if (access == Access::kWrite && is_link(path)) {
    return Failure{Fault::kStore,
                   "is a link, which is not written through; put the file itself in its place",
                   path};
  }
  // SQLite would make it for its owner alone to write, whatever the umask of a folder that a group
  // shares. Its journals are as the database is.
  if (access == Access::kWrite && !is_there(path)) {
    const int made = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (made >= 0) ::close(made);
  }
  // Without write permission SQLite falls back to read-only by itself.
  // Who reads does so in one thread; a lock for each value of a million rows costs more than they.
  const int flags = SQLITE_OPEN_READWRITE |
                    (access == Access::kWrite ? SQLITE_OPEN_CREATE : SQLITE_OPEN_NOMUTEX);
  if (sqlite3_open_v2(path.c_str(), &database.handle_, flags, nullptr) != SQLITE_OK) {
    return Failure{Fault::kStore,
                   std::string("cannot be opened: ") + sqlite3_errmsg(database.handle_), path};
  }
  sqlite3_busy_handler(database.handle_, wait_for_lock, database.path_.get());
  distrust(database.handle_);
  if (access == Access::kWrite) PROBE_TRY(database.execute("pragma synchronous = full"));
  return database;
}

Database::~Database() { sqlite3_close(handle_); }

std::string Database::name() const { return path_->substr(path_->rfind('/') + 1); }

// What SQLite said, with what to do about it.
Failure Database::failure(Access access) const {
  const int code = sqlite3_errcode(handle_);
  const std::string said = sqlite3_errmsg(handle_);
  if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT)
    return {Fault::kStore, name() + " cannot be read (" + said + "); " + advice_, *path_};
  if (code == SQLITE_ERROR && (said == "no such table: episodes" || said == "no such table: run" ||
                               said == "no such table: answers")) {
    return {Fault::kStore,
            name() +
                " has no rows and no room for them: what writes it was cut off as it began; the "
                "same command goes on",
            *path_};
  }
  // SQLite takes ENOLCK for a lock of another, and what else says the same for a broken disk.
  if (const int kind = code & 0xff; kind == SQLITE_BUSY || kind == SQLITE_IOERR) {
    const std::string lack = FolderLock::lack(folder_of(*path_));
    if (!lack.empty()) {
      return {Fault::kStore,
              lack +
                  ", so that another run could change the results while they are read: copy the "
                  "folder to a disk that has locks, or have this one mounted with them",
              folder_of(*path_)};
    }
  }
  return {Fault::kStore,
          std::string("the results cannot be ") +
              (access == Access::kRead ? "read: " : "stored: ") + said,
          *path_};
}

Status Database::execute(const char* sql) {
  if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) == SQLITE_OK) return {};
  return failure(Access::kWrite);
}

Status Database::expect(std::span<const Table> tables) {
  const auto refuse = [&](const std::string& what) {
    return Failure{Fault::kStore, name() + " has " + what + ", which no run makes; " + advice_,
                   *path_};
  };
  Statement things(*this, "select type, name, rootpage from sqlite_master");
  std::vector<std::string> found;
  while (things.next()) {
    const std::string type = things.text(0), name = things.text(1);
    // SQLite's own, for a primary key.
    if (type == "index" && name.starts_with("sqlite_autoindex_")) continue;
    const auto known = std::ranges::find(tables, name, &Table::name);
    const bool is_virtual = things.number(2) == 0;
    if (type != "table" || is_virtual || known == tables.end()) {
      return refuse("the " + printable(type, 20) + " `" + printable(name, 60) + "`");
    }
    found.push_back(name);
  }
  PROBE_TRY(things.done());
  for (const std::string& name : found) {
    const auto known = std::ranges::find(tables, name, &Table::name);
    Statement columns(*this, "select name, hidden from pragma_table_xinfo(?)");
    columns.bind(name);
    while (columns.next()) {
      const std::string column = columns.text(0);
      if (columns.number(1) != 0 ||
          std::ranges::find(known->columns, column) == known->columns.end())
        return refuse("the column `" + printable(column, 60) + "` in `" + name + "`");
    }
    PROBE_TRY(columns.done());
  }
  return {};
}

Statement::Statement(Database& database, const char* sql, Database::Access access)
    : database_(database), access_(access) {
  code_ = sqlite3_prepare_v2(database.handle_, sql, -1, &statement_, nullptr);
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement& Statement::bind(const std::string& value) {
  if (code_ == SQLITE_OK) {
    code_ = sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()),
                              SQLITE_TRANSIENT);
  }
  return *this;
}

Statement& Statement::bind(int value) {
  if (code_ == SQLITE_OK) code_ = sqlite3_bind_int(statement_, ++bound_, value);
  return *this;
}

Statement& Statement::bind(std::int64_t value) {
  if (code_ == SQLITE_OK) code_ = sqlite3_bind_int64(statement_, ++bound_, value);
  return *this;
}

Statement& Statement::bind(double value) {
  if (code_ == SQLITE_OK) code_ = sqlite3_bind_double(statement_, ++bound_, value);
  return *this;
}

Statement& Statement::bind_null() {
  if (code_ == SQLITE_OK) code_ = sqlite3_bind_null(statement_, ++bound_);
  return *this;
}

Statement& Statement::bind(const std::optional<std::string>& value) {
  return value ? bind(*value) : bind_null();
}

void Statement::restart() {
  if (statement_ == nullptr) return;
  sqlite3_reset(statement_);
  code_ = SQLITE_OK;
  bound_ = 0;
}

bool Statement::next() {
  if (code_ == SQLITE_OK || code_ == SQLITE_ROW) code_ = sqlite3_step(statement_);
  return code_ == SQLITE_ROW;
}

std::string Statement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  if (bytes == nullptr) return {};
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::optional<std::string> Statement::optional_text(int column) const {
  if (sqlite3_column_type(statement_, column) == SQLITE_NULL) return std::nullopt;
  return text(column);
}

int Statement::number(int column) const {
  constexpr std::int64_t kLeast = std::numeric_limits<int>::min(),
                         kMost = std::numeric_limits<int>::max();
  return static_cast<int>(std::clamp(whole(column), kLeast, kMost));
}

std::int64_t Statement::whole(int column) const { return sqlite3_column_int64(statement_, column); }

double Statement::real(int column) const { return sqlite3_column_double(statement_, column); }

Statement::Kind Statement::kind(int column) const {
  switch (sqlite3_column_type(statement_, column)) {
    case SQLITE_NULL:
      return Kind::kNull;
    case SQLITE_INTEGER:
      return Kind::kWhole;
    case SQLITE_FLOAT:
      return Kind::kReal;
    case SQLITE_TEXT:
      return Kind::kText;
    default:
      return Kind::kOther;
  }
}

std::size_t Statement::bytes(int column) const {
  // Of a number SQLite would write the text to count it.
  const int type = sqlite3_column_type(statement_, column);
  if (type == SQLITE_INTEGER || type == SQLITE_FLOAT) return sizeof(std::int64_t);
  return static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
}

Status Statement::done() const {
  if (code_ == SQLITE_DONE || code_ == SQLITE_OK || code_ == SQLITE_ROW) return {};
  return database_.failure(access_);
}

}  // namespace probe::store
