// SQLite and file names. The database is small: one row a finished episode, in one transaction each
// with full sync.
#include "runtime/run/store.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runtime/base/file.h"
#include "runtime/run/stored_trace.h"

namespace probe::run {
namespace {

namespace fs = std::filesystem;

// Raised when the tables change; another number is refused.
constexpr const char* kSchemaVersion = "1";
constexpr const char* kSchema = R"(
create table if not exists run (name text primary key, value text not null) without rowid;
create table if not exists episodes (
  task text not null, episode integer not null, seed integer not null,
  task_order integer not null, episode_id text not null, start_id text not null,
  policy text not null, metrics text not null, steps integer not null, invalid text,
  prompt_sha256 text not null, image_sha256 text not null, frames_sha256 text not null,
  trace_sha256 text not null, trace text not null,
  primary key (task, episode, seed)) without rowid;
)";

Failure failed(const std::string& message, const std::string& where) {
  return {"store", message, where};
}

enum class Access { kRead, kWrite };

// What SQLite said, with what to do about it: the traces do not depend on the database.
Failure sqlite_failure(sqlite3* database, Access access, const std::string& where) {
  const int code = sqlite3_errcode(database);
  const std::string said = sqlite3_errmsg(database);
  if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT) {
    return failed("results.sqlite cannot be read (" + said +
                      "); the traces are intact: move this file away and run again",
                  where);
  }
  return failed(std::string("the results cannot be ") +
                    (access == Access::kRead ? "read: " : "stored: ") + said,
                where);
}

// A prepared statement; every failure becomes ours, with the folder's name.
class Statement {
 public:
  Statement(sqlite3* database, const char* sql, Access access = Access::kRead)
      : database_(database), access_(access) {
    code_ = sqlite3_prepare_v2(database, sql, -1, &statement_, nullptr);
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(const std::string& value) {
    if (code_ == SQLITE_OK) {
      code_ = sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()),
                                SQLITE_TRANSIENT);
    }
    return *this;
  }
  Statement& bind(int value) {
    if (code_ == SQLITE_OK) code_ = sqlite3_bind_int(statement_, ++bound_, value);
    return *this;
  }
  Statement& bind(const std::optional<std::string>& value) {
    if (value) return bind(*value);
    if (code_ == SQLITE_OK) code_ = sqlite3_bind_null(statement_, ++bound_);
    return *this;
  }
  // True while there is a row.
  bool next() {
    if (code_ == SQLITE_OK || code_ == SQLITE_ROW) code_ = sqlite3_step(statement_);
    return code_ == SQLITE_ROW;
  }
  std::string text(int column) const {
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return bytes == nullptr
               ? std::string()
               : std::string(bytes,
                             static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
  }
  int number(int column) const { return sqlite3_column_int(statement_, column); }
  bool is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }

  // After the last next().
  Status done(const std::string& where) const {
    if (code_ == SQLITE_DONE || code_ == SQLITE_OK || code_ == SQLITE_ROW) return {};
    return sqlite_failure(database_, access_, where);
  }

 private:
  sqlite3* database_;
  Access access_;
  sqlite3_stmt* statement_ = nullptr;
  int code_ = SQLITE_OK;
  int bound_ = 0;
};

class Database {
 public:
  ~Database() { sqlite3_close(handle_); }
  Database() = default;
  Database(Database&& other) noexcept
      : handle_(std::exchange(other.handle_, nullptr)), path_(std::move(other.path_)) {}
  Database& operator=(Database&&) = delete;

  static Result<Database> open(const std::string& path, bool write) {
    Database database;
    database.path_ = path;
    // Readers too may have to roll back what a killed writer left; SQLite falls back to read-only
    // by itself.
    const int flags = SQLITE_OPEN_READWRITE | (write ? SQLITE_OPEN_CREATE : 0);
    if (sqlite3_open_v2(path.c_str(), &database.handle_, flags, nullptr) != SQLITE_OK) {
      return failed(std::string("cannot be opened: ") + sqlite3_errmsg(database.handle_), path);
    }
    sqlite3_busy_timeout(database.handle_, 10000);
    if (write) PROBE_TRY(database.execute("pragma synchronous = full"));
    return database;
  }
  Status execute(const char* sql) {
    if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) == SQLITE_OK) return {};
    return sqlite_failure(handle_, Access::kWrite, path_);
  }
  sqlite3* handle() const { return handle_; }
  const std::string& path() const { return path_; }

 private:
  sqlite3* handle_ = nullptr;
  std::string path_;
};

std::string database_path(const std::string& dir) {
  return (fs::path(dir) / "results.sqlite").string();
}

std::string relative_trace(const std::string& task, int episode, int seed) {
  return "traces/" + task + "/" + std::to_string(episode) + "-" + std::to_string(seed) + ".trace";
}

nlohmann::json to_json(const RunRecord& record) {
  return {{"schema", kSchemaVersion},
          {"plan_root", record.identity.plan_root},
          {"policy", record.identity.policy},
          {"suite", record.suite},
          {"seeds", record.seeds},
          {"fingerprint", to_json(record.fingerprint)}};
}

Failure bad_record(const std::string& key, const char* wanted, const std::string& where) {
  return failed(
      "`" + key + "` of its run record is not " + wanted + "; move this file away and run again",
      where);
}

Result<std::string> record_text(const nlohmann::json& json, const char* key,
                                const std::string& where) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_string()) return bad_record(key, "a text", where);
  return found->get<std::string>();
}

// Nothing when the database has no run yet.
Result<std::optional<RunRecord>> load_record(Database& database) {
  Statement select(database.handle(), "select value from run where name = 'record'");
  if (!select.next()) {
    PROBE_TRY(select.done(database.path()));
    return std::optional<RunRecord>();
  }
  const auto json = nlohmann::json::parse(select.text(0), nullptr, false);
  if (!json.is_object()) {
    return failed("its run record is no JSON object; move this file away and run again",
                  database.path());
  }
  PROBE_ASSIGN(const std::string schema, record_text(json, "schema", database.path()));
  if (schema != kSchemaVersion) {
    return failed("was written by a program with another layout of results", database.path());
  }
  RunRecord record;
  PROBE_ASSIGN(record.identity.plan_root, record_text(json, "plan_root", database.path()));
  PROBE_ASSIGN(record.identity.policy, record_text(json, "policy", database.path()));
  PROBE_ASSIGN(record.suite, record_text(json, "suite", database.path()));
  const auto seeds = json.find("seeds");
  if (seeds == json.end() || !seeds->is_array()) {
    return bad_record("seeds", "a list of whole numbers", database.path());
  }
  for (const auto& seed : *seeds) {
    if (!seed.is_number_integer()) {
      return bad_record("seeds", "a list of whole numbers", database.path());
    }
    record.seeds.push_back(seed.get<int>());
  }
  PROBE_ASSIGN(const std::string fingerprint, record_text(json, "fingerprint", database.path()));
  auto read = fingerprint_from_json(fingerprint);
  if (!read) return bad_record("fingerprint", "an object of texts", database.path());
  record.fingerprint = std::move(*read);
  return std::optional(std::move(record));
}

// The first thing that differs, for people.
std::string difference(const RunIdentity& stored, const RunIdentity& asked) {
  if (stored.policy != asked.policy) {
    return "holds a run of policy `" + stored.policy + "`, not `" + asked.policy + "`";
  }
  return "holds a run of another plan (root " + stored.plan_root.substr(0, 12) + ", this one is " +
         asked.plan_root.substr(0, 12) + ")";
}

void sync_folder(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

std::string metrics_to_text(const std::vector<MetricValue>& metrics) {
  nlohmann::json json = nlohmann::json::array();
  for (const MetricValue& metric : metrics) {
    json.push_back({metric.name, metric.is_bool ? 1 : 0, metric.value});
  }
  return json.dump();
}

std::optional<std::vector<MetricValue>> metrics_from_text(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_array()) return std::nullopt;
  std::vector<MetricValue> metrics;
  for (const auto& entry : json) {
    if (!entry.is_array() || entry.size() != 3 || !entry[0].is_string() || !entry[1].is_number() ||
        !entry[2].is_number()) {
      return std::nullopt;
    }
    metrics.push_back(
        {entry[0].get<std::string>(), entry[1].get<int>() != 0, entry[2].get<double>()});
  }
  return metrics;
}

Result<std::vector<ResultRow>> load_rows(Database& database, const std::string& dir) {
  Statement select(database.handle(),
                   "select task, episode, seed, policy, metrics, steps, invalid, prompt_sha256, "
                   "image_sha256, frames_sha256, trace_sha256, episode_id, start_id, trace "
                   "from episodes order by task_order, task, episode, seed");
  std::vector<ResultRow> rows;
  while (select.next()) {
    ResultRow row;
    row.task = select.text(0);
    row.episode = select.number(1);
    row.seed = select.number(2);
    row.policy = select.text(3);
    auto metrics = metrics_from_text(select.text(4));
    if (metrics) row.metrics = std::move(*metrics);
    row.steps = select.number(5);
    if (!select.is_null(6)) {
      row.invalid = select.text(6);
    } else if (!metrics) {
      // One damaged row must not hide the others; the next run makes it anew.
      row.invalid = "store: its metrics in results.sqlite cannot be read";
    }
    row.prompt_sha256 = select.text(7);
    row.image_sha256 = select.text(8);
    row.frames_sha256 = select.text(9);
    row.trace_sha256 = select.text(10);
    row.episode_id = select.text(11);
    row.start_id = select.text(12);
    row.trace = fs::absolute(fs::path(dir) / select.text(13)).lexically_normal().string();
    rows.push_back(std::move(row));
  }
  PROBE_TRY(select.done(database.path()));
  return rows;
}

class FolderStore final : public Store {
 public:
  FolderStore(std::string dir, int lock, Database database)
      : dir_(std::move(dir)), lock_(lock), database_(std::move(database)) {}
  ~FolderStore() override { ::close(lock_); }

  Status begin(const RunRecord& record, std::span<const std::byte> plan_bytes) {
    PROBE_TRY(database_.execute(kSchema));
    PROBE_ASSIGN(auto stored, load_record(database_));
    if (stored && stored->identity != record.identity) {
      return failed(difference(stored->identity, record.identity) +
                        "; take another folder or remove this one",
                    dir_);
    }
    remove_leftovers();
    if (stored) {
      record_ = std::move(*stored);
      return {};
    }
    // The plan goes first: a folder with a record always has its plan.
    PROBE_TRY(write_file(plan_path(dir_), plan_bytes));
    sync_folder(dir_);
    Statement insert(database_.handle(), "insert into run values ('record', ?)", Access::kWrite);
    insert.bind(to_json(record).dump()).next();
    PROBE_TRY(insert.done(dir_));
    record_ = record;
    return {};
  }

  const RunRecord& record() const override { return record_; }

  Result<std::vector<StoredEpisode>> episodes() override {
    PROBE_ASSIGN(const auto rows, load_rows(database_, dir_));
    std::vector<StoredEpisode> episodes;
    for (const ResultRow& row : rows) {
      StoredEpisode episode{row.task, row.episode, row.seed, !row.invalid,
                            row.invalid.value_or("")};
      // A row is worth what its trace can show for it.
      if (episode.valid) {
        if (const auto trace = read_stored_trace(row); !trace) {
          episode.valid = false;
          episode.why = to_text(trace.failure());
        }
      }
      episodes.push_back(std::move(episode));
    }
    return episodes;
  }

  std::string temporary_trace(const std::string& task, int episode, int seed) const override {
    std::error_code ignored;  // the trace's own opening says what is wrong
    fs::create_directories(fs::path(dir_) / "traces" / task, ignored);
    return trace_path(dir_, task, episode, seed) + ".tmp";
  }

  Status commit(const ResultRow& row, int task_order) override {
    const std::string trace = trace_path(dir_, row.task, row.episode, row.seed);
    if (::rename((trace + ".tmp").c_str(), trace.c_str()) != 0) {
      return failed(std::string("cannot be renamed: ") + std::strerror(errno), trace + ".tmp");
    }
    sync_folder(fs::path(trace).parent_path());
    Statement insert(database_.handle(),
                     "insert or replace into episodes values (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
                     Access::kWrite);
    insert.bind(row.task).bind(row.episode).bind(row.seed).bind(task_order);
    insert.bind(row.episode_id).bind(row.start_id).bind(row.policy);
    insert.bind(metrics_to_text(row.metrics)).bind(row.steps).bind(row.invalid);
    insert.bind(row.prompt_sha256).bind(row.image_sha256).bind(row.frames_sha256);
    insert.bind(row.trace_sha256).bind(relative_trace(row.task, row.episode, row.seed));
    insert.next();
    return insert.done(dir_);
  }

 private:
  // Traces and videos that a killed process did not finish.
  void remove_leftovers() const {
    for (const char* folder : {"traces", "videos"}) {
      std::error_code error;
      for (fs::recursive_directory_iterator at(fs::path(dir_) / folder, error), end;
           !error && at != end; at.increment(error)) {
        std::error_code ignored;
        if (at->path().extension() == ".tmp") fs::remove(at->path(), ignored);
      }
    }
  }

  std::string dir_;
  int lock_;
  Database database_;
  RunRecord record_;
};

}  // namespace

std::string plan_path(const std::string& dir) { return (fs::path(dir) / "suite.plan").string(); }

std::string trace_path(const std::string& dir, const std::string& task, int episode, int seed) {
  return (fs::path(dir) / relative_trace(task, episode, seed)).string();
}

Result<std::unique_ptr<Store>> Store::open(const std::string& dir, const RunRecord& record,
                                           std::span<const std::byte> plan_bytes) {
  if (dir.empty()) return failed("no folder to write into", "-o");
  std::error_code error;
  fs::create_directories(dir, error);
  if (error) return failed("the folder cannot be made: " + error.message(), dir);
  const std::string lock_path = (fs::path(dir) / "lock").string();
  const int lock = ::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock < 0) {
    return failed(std::string("the folder cannot be written: ") + std::strerror(errno), dir);
  }
  // The kernel drops this lock with the process, however it ends.
  if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock);
    return failed("another run is writing into this folder", dir);
  }
  auto database = Database::open(database_path(dir), true);
  if (!database) {
    ::close(lock);
    return database.failure();
  }
  auto store = std::make_unique<FolderStore>(dir, lock, std::move(*database));
  PROBE_TRY(store->begin(record, plan_bytes));
  return std::unique_ptr<Store>(std::move(store));
}

Result<RunRecord> read_run_record(const std::string& dir) {
  if (!fs::exists(database_path(dir))) return failed("no run here: results.sqlite is absent", dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), false));
  PROBE_ASSIGN(auto record, load_record(database));
  if (!record) return failed("no run here: results.sqlite is empty", dir);
  return std::move(*record);
}

Result<std::vector<ResultRow>> read_results(const std::string& dir) {
  if (!fs::exists(database_path(dir))) return failed("no run here: results.sqlite is absent", dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), false));
  return load_rows(database, dir);
}

}  // namespace probe::run
