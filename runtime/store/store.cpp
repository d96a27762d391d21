// Tables and file names. The database is small: one row a finished episode, in one transaction each
// with full sync.
#include "runtime/store/store.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <mutex>
#include <set>
#include <unordered_map>

#include "runtime/base/file.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/inside.h"
#include "runtime/base/json.h"
#include "runtime/base/paths.h"
#include "runtime/store/calls_table.h"
#include "runtime/store/database.h"
#include "runtime/store/folder_lock.h"
#include "runtime/store/order_table.h"
#include "runtime/store/proof.h"
#include "runtime/store/remarks_table.h"
#include "runtime/store/room.h"
#include "runtime/store/run_plan.h"
#include "runtime/store/stored_trace.h"
#include "runtime/store/unproven_table.h"

namespace probe::store {
namespace {

namespace fs = std::filesystem;

// The columns of `episodes`: the table is made, read, written and checked by this list.
struct EpisodeColumn {
  enum : int {
#define PROBE_EPISODE_COLUMN(Name, name, type, since, value) k##Name,
#include "runtime/store/episode_columns.def"
    kCount
  };
};
constexpr std::string_view kEpisodeColumns[] = {
#define PROBE_EPISODE_COLUMN(Name, name, type, since, value) name,
#include "runtime/store/episode_columns.def"
};
constexpr std::string_view kEpisodeTypes[] = {
#define PROBE_EPISODE_COLUMN(Name, name, type, since, value) type,
#include "runtime/store/episode_columns.def"
};
constexpr int kEpisodeSince[] = {
#define PROBE_EPISODE_COLUMN(Name, name, type, since, value) since,
#include "runtime/store/episode_columns.def"
};
// Of every version; those of version 2 may be absent.
constexpr std::string_view kRunColumns[] = {"name", "value"};
constexpr Database::Table kTables[] = {{"run", kRunColumns},
                                       {"episodes", kEpisodeColumns},
                                       {"calls", kCallColumns},
                                       {"unproven", kUnprovenColumns},
                                       {"remarks", kRemarkColumns},
                                       {"planned", kOrderColumns}};

// What `item` gives for each column, with commas between.
template <typename Item>
std::string each_column(const Item& item) {
  std::string out;
  for (std::size_t k = 0; k < EpisodeColumn::kCount; ++k) {
    out += (k == 0 ? "" : ", ") + item(k);
  }
  return out;
}

std::string column_defined(std::size_t column) {
  return std::string(kEpisodeColumns[column]) + " " + std::string(kEpisodeTypes[column]);
}

std::string episode_schema() {
  return "create table if not exists run (name text primary key, value text not null) "
         "without rowid; create table if not exists episodes (" +
         each_column(column_defined) + ", primary key (task, episode, seed)) without rowid; " +
         std::string(kCallsSchema);
}

// From version 1.
std::string raised_schema() {
  std::string out;
  for (std::size_t k = 0; k < EpisodeColumn::kCount; ++k) {
    if (kEpisodeSince[k] > 1) out += "alter table episodes add column " + column_defined(k) + "; ";
  }
  return out;
}

// Who reads rows keeps writers waiting no longer than so many take.
constexpr std::size_t kRowsAtOnce = 512;

// All columns of a task's rows behind an episode and seed, by EpisodeColumn; null where the file's version has none. Their
// order is the table's own: nothing is sorted.
std::string select_episodes(int version) {
  const auto item = [version](std::size_t k) {
    return kEpisodeSince[k] > version ? std::string("null") : std::string(kEpisodeColumns[k]);
  };
  return "select " + each_column(item) +
         " from episodes where task = ? and (episode, seed) > (?, ?) order by episode, seed limit " +
         std::to_string(kRowsAtOnce);
}

std::string insert_episode() {
  const auto name = [](std::size_t k) { return std::string(kEpisodeColumns[k]); };
  const auto place = [](std::size_t) { return std::string("?"); };
  return "insert or replace into episodes (" + each_column(name) + ") values (" +
         each_column(place) + ")";
}

// What is read of one folder: a campaign has a few million episodes, of some 700 bytes each.
constexpr std::size_t kMostRows = 4'000'000;
constexpr std::size_t kMostBytes = std::size_t{4} << 30;

Failure failed(const std::string& message, const std::string& where) {
  return {Fault::kStore, message, where};
}

using Access = Database::Access;

std::string database_path(const std::string& dir) { return path_in(dir, kRunDatabase); }

Failure no_run(const std::string& dir) {
  return failed(holds_answers(dir)  ? "holds a model's answers, not a run"
                : holds_search(dir) ? "holds a search, not a run: its runs lie in rounds/NNN/policy"
                                    : "no run here: results.sqlite is absent",
                dir);
}

std::string relative_trace(const EpisodeKey& key) { return "traces/" + file_stem(key) + ".trace"; }

// Nothing when the database has no run yet.
Result<std::optional<RunRecord>> load_record(Database& database) {
  PROBE_TRY(database.expect(kTables));
  Statement table(database, "select 1 from sqlite_master where name = 'run'");
  const bool begun = table.next();
  PROBE_TRY(table.done());
  if (!begun) return std::optional<RunRecord>();
  Statement select(database, "select value from run where name = 'record'");
  if (!select.next()) {
    PROBE_TRY(select.done());
    return std::optional<RunRecord>();
  }
  PROBE_ASSIGN(RunRecord record, record_from_text(select.text(0), database.path()));
  return std::optional(std::move(record));
}

std::string metrics_to_text(const std::vector<MetricValue>& metrics) {
  Json json = Json::array();
  for (const MetricValue& metric : metrics) {
    json.push_back({metric.name, metric.is_bool ? 1 : 0, metric.value});
  }
  return json.dump();
}

std::optional<std::vector<MetricValue>> metrics_from_text(const std::string& text) {
  const auto json = Json::parse(text);
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

// Texts of metrics that occur again and again, each read once.
class MetricTexts {
 public:
  const std::optional<std::vector<MetricValue>>& read(const std::string& text) {
    constexpr std::size_t kMost = 4096;
    if (known_.size() >= kMost) known_.clear();
    const auto [at, is_new] = known_.try_emplace(text);
    if (is_new) at->second = metrics_from_text(text);
    return at->second;
  }

 private:
  std::unordered_map<std::string, std::optional<std::vector<MetricValue>>> known_;
};

Failure no_texts(const Database& database) {
  return failed("results.sqlite has names or numbers of another type than any run's; " +
                    std::string(Database::kRunAdvice),
                database.path());
}

// Tasks with rows, in the plan's order, by one look a task.
Result<std::vector<std::string>> tasks_in_order(Database& database) {
  std::vector<std::pair<int, std::string>> tasks;
  Statement first(database, "select task, task_order from episodes order by task limit 1");
  Statement next(database,
                 "select task, task_order from episodes where task > ? order by task limit 1");
  bool found = first.next();
  PROBE_TRY(first.done());
  if (found) tasks.emplace_back(first.number(1), first.text(0));
  while (found) {
    next.restart();
    found = next.bind(tasks.back().second).next();
    PROBE_TRY(next.done());
    if (!found) break;
    if (next.text(0) == tasks.back().second || tasks.size() >= kMostRows) return no_texts(database);
    tasks.emplace_back(next.number(1), next.text(0));
  }
  std::sort(tasks.begin(), tasks.end());
  std::vector<std::string> names;
  for (auto& [order, name] : tasks) names.push_back(std::move(name));
  return names;
}

// While it lives, all that is read is as it was at the first reading.
class Moment {
 public:
  static Result<Moment> begin(Database& database) {
    PROBE_TRY(database.execute("begin"));
    return Moment(database);
  }
  Moment(Moment&& other) noexcept : database_(std::exchange(other.database_, nullptr)) {}
  Moment& operator=(Moment&&) = delete;
  ~Moment() {
    if (database_ != nullptr) (void)database_->execute("rollback");  // nothing was written
  }

 private:
  explicit Moment(Database& database) : database_(&database) {}
  Database* database_;
};

// Rows of a folder's database, some hundred at a time.
class RowReader {
 public:
  static Result<RowReader> open(Database& database, const std::string& dir) {
    PROBE_ASSIGN(auto record, load_record(database));
    if (!record) return failed("no run here: results.sqlite is empty", dir);
    return RowReader(database, dir, std::move(*record));
  }

  // Those of `task` behind an episode and seed, as many as are read at once.
  Result<std::vector<ResultRow>> read(const std::string& task, std::int64_t episode,
                                      std::int64_t seed) {
    std::vector<ResultRow> rows;
    // A row and what its policy said of it are of one moment, whoever writes meanwhile.
    PROBE_ASSIGN(const Moment moment, Moment::begin(database_));
    Statement select(database_, select_.c_str());
    select.bind(task).bind(episode).bind(seed);
    while (select.next()) {
      for (int column = 0; column < EpisodeColumn::kCount; ++column) bytes_ += select.bytes(column);
      if (bytes_ > kMostBytes || ++count_ > kMostRows) {
        return failed("results.sqlite has more rows than any run: more than " +
                          std::to_string(kMostRows) + ", or more than " +
                          std::to_string(kMostBytes >> 20) + " MiB of them",
                      database_.path());
      }
      rows.push_back(row_of(select));
    }
    PROBE_TRY(select.done());
    PROBE_TRY(RemarksTable(database_).add_to(rows));
    return rows;
  }

 private:
  RowReader(Database& database, const std::string& dir, RunRecord record)
      : database_(database),
        dir_(dir),
        base_(absolute_path(dir) + "/"),
        select_(select_episodes(record.schema)),
        record_(std::move(record)) {}

  ResultRow row_of(const Statement& select) {
    ResultRow row;
    row.task = select.text(EpisodeColumn::kTask);
    row.episode = select.number(EpisodeColumn::kEpisode);
    row.seed = select.number(EpisodeColumn::kSeed);
    row.policy = select.text(EpisodeColumn::kPolicy);
    const auto& metrics = metric_texts_.read(select.text(EpisodeColumn::kMetrics));
    if (metrics) row.metrics = *metrics;
    row.steps = select.number(EpisodeColumn::kSteps);
    row.invalid = select.optional_text(EpisodeColumn::kInvalid);
    if (!row.invalid && !metrics) {
      // One damaged row must not hide the others; the next run makes it anew.
      row.invalid = "store: its metrics in results.sqlite cannot be read";
    }
    row.prompt_sha256 = select.text(EpisodeColumn::kPromptSha);
    row.image_sha256 = select.text(EpisodeColumn::kImageSha);
    row.frames_sha256 = select.text(EpisodeColumn::kFramesSha);
    row.trace_sha256 = select.text(EpisodeColumn::kTraceSha);
    row.episode_id = select.text(EpisodeColumn::kEpisodeId);
    row.start_id = select.text(EpisodeColumn::kStartId);
    row.trace = select.text(EpisodeColumn::kTrace);
    // What any run writes is normal as it stands.
    const bool is_ours = row.task.find('/') == row.task.npos && row.task != ".." &&
                         row.trace == relative_trace(key_of(row));
    row.trace = is_ours ? base_ + row.trace : absolute_path((fs::path(dir_) / row.trace).string());
    row.sent_prompt_sha256 = select.optional_text(EpisodeColumn::kSentPromptSha);
    row.sent_image_sha256 = select.optional_text(EpisodeColumn::kSentImageSha);
    row.live = record_.identity.live;
    row.only_success = record_.identity.only_success;
    row.until = record_.identity.until;
    return row;
  }

  Database& database_;
  std::string dir_, base_, select_;
  RunRecord record_;
  MetricTexts metric_texts_;
  std::size_t bytes_ = 0, count_ = 0;
};

Status visit_rows(Database& database, const std::string& dir, const RowVisitor& visit) {
  PROBE_ASSIGN(RowReader reader, RowReader::open(database, dir));
  PROBE_ASSIGN(const auto tasks, tasks_in_order(database));
  for (const std::string& task : tasks) {
    std::pair<std::int64_t, std::int64_t> last{INT64_MIN, INT64_MIN};
    for (;;) {
      PROBE_ASSIGN(std::vector<ResultRow> rows, reader.read(task, last.first, last.second));
      const std::size_t count = rows.size();
      for (ResultRow& row : rows) {
        const std::pair<std::int64_t, std::int64_t> key{row.episode, row.seed};
        if (key <= last) return no_texts(database);
        last = key;
        PROBE_TRY(visit(std::move(row)));
      }
      if (count < kRowsAtOnce) break;
    }
  }
  return {};
}

Result<std::vector<ResultRow>> load_rows(Database& database, const std::string& dir) {
  std::vector<ResultRow> rows;
  PROBE_TRY(visit_rows(database, dir, [&](ResultRow&& row) -> Status {
    rows.push_back(std::move(row));
    return {};
  }));
  return rows;
}

void bind_episode(Statement& insert, const ResultRow& row, int task_order) {
#define PROBE_EPISODE_COLUMN(Name, name, type, since, value) insert.bind(value);
#include "runtime/store/episode_columns.def"
}

class FolderStore final : public Store {
 public:
  FolderStore(std::string dir, FolderLock lock, Database database)
      : dir_(std::move(dir)), lock_(std::move(lock)), database_(std::move(database)) {}

  Status begin(const RunRecord& record, std::span<const std::byte> plan_bytes) {
    PROBE_ASSIGN(auto stored, load_record(database_));
    PROBE_TRY(database_.execute(episode_schema().c_str()));
    if (stored) {
      const RunChanges changes = changes_between(*stored, record);
      for (const std::string& change : {changes.identity, changes.policy_content}) {
        if (change.empty()) continue;
        return failed(change + "; take another folder or remove this one", dir_);
      }
    }
    remove_leftovers();
    if (stored) {
      record_ = std::move(*stored);
      PROBE_TRY(put_plan_back(plan_bytes));
      return record_.schema < kSchemaVersion ? raise_schema() : Status();
    }
    // The plan goes first: a folder with a record always has its plan.
    PROBE_TRY(write_plan(plan_bytes));
    PROBE_TRY(sync_folder(dir_));
    record_ = record;
    record_.schema = kSchemaVersion;
    return write_record("insert into run values ('record', ?)");
  }

  const RunRecord& record() const override { return record_; }

  Result<std::vector<StoredEpisode>> episodes() override {
    PROBE_ASSIGN(const auto rows, load_rows(database_, dir_));
    const auto plan = open_run_plan(dir_);
    std::vector<StoredEpisode> episodes;
    for (const ResultRow& row : rows) {
      StoredEpisode episode{key_of(row), !row.invalid, row.invalid.value_or("")};
      // A row is worth what its trace can show for it.
      if (episode.valid) {
        if (const auto trace = plan ? prove(*plan, row) : read_stored_trace(row); !trace) {
          episode.valid = false;
          episode.why = to_text(trace.failure());
        }
      }
      const auto success = std::ranges::find(row.metrics, "success", &MetricValue::name);
      episode.success = episode.valid && success != row.metrics.end() && success->value != 0;
      episodes.push_back(std::move(episode));
    }
    return episodes;
  }

  Result<std::string> temporary_trace(const EpisodeKey& key) const override {
    const std::string trace = trace_path(dir_, key);
    const std::string folder = fs::path(trace).parent_path().string();
    PROBE_TRY(check_inside(dir_, fs::path(relative_trace(key)).parent_path().string()));
    if (auto made = make_lasting_folders(folder); !made) {
      return failed(made.failure().message, folder);
    }
    return trace + ".tmp";
  }

  Status commit(const ResultRow& row, int task_order) override {
    const std::string trace = trace_path(dir_, key_of(row));
    if (std::rename((trace + ".tmp").c_str(), trace.c_str()) != 0) {
      return failed(std::string("cannot be renamed: ") + std::strerror(errno), trace + ".tmp");
    }
    // Waiting for the disk here is no business of other threads: each has files of its own.
    PROBE_TRY(sync_folder(fs::path(trace).parent_path().string()));
    const std::lock_guard lock(mutex_);
    return in_one([&]() -> Status {
      if (is_watched_) PROBE_TRY(unproven_.add(key_of(row)));
      PROBE_TRY(remarks_.put(key_of(row), row.remark));
      return insert_row(row, task_order);
    });
  }

  Status commit(std::span<const Finished> finished) override {
    std::vector<std::string> traces, temporary;
    std::set<std::string> folders;
    for (const Finished& one : finished) {
      traces.push_back(trace_path(dir_, key_of(one.row)));
      temporary.push_back(traces.back() + ".tmp");
      folders.insert(fs::path(traces.back()).parent_path().string());
    }
    if (auto synced = sync_disk(temporary); !synced)
      return failed(synced.failure().message, synced.failure().where);
    for (std::size_t i = 0; i < traces.size(); ++i) {
      if (std::rename(temporary[i].c_str(), traces[i].c_str()) != 0)
        return failed(std::string("cannot be renamed: ") + std::strerror(errno), temporary[i]);
    }
    for (const std::string& folder : folders) PROBE_TRY(sync_folder(folder));
    const std::lock_guard lock(mutex_);
    return in_one([&]() -> Status {
      for (const Finished& one : finished) {
        if (is_watched_) PROBE_TRY(unproven_.add(key_of(one.row)));
        PROBE_TRY(remarks_.put(key_of(one.row), one.row.remark));
        PROBE_TRY(insert_row(one.row, one.task_order));
      }
      return {};
    });
  }

  Status invalidate(const std::vector<EpisodeKey>& keys, const std::string& reason) override {
    const std::lock_guard lock(mutex_);
    return in_one([&]() -> Status {
      for (const EpisodeKey& key : keys) {
        Statement update(database_,
                         "update episodes set invalid = ? where task = ? and episode = ? and "
                         "seed = ? and invalid is null",
                         Access::kWrite);
        update.bind(reason).bind(key.task).bind(key.episode).bind(key.seed).next();
        PROBE_TRY(update.done());
      }
      return {};
    });
  }

  Status note_unproven() override {
    const std::lock_guard lock(mutex_);
    PROBE_TRY(unproven_.make());
    is_watched_ = true;
    return {};
  }
  Status doubt(const std::vector<EpisodeKey>& keys) override {
    const std::lock_guard lock(mutex_);
    if (keys.empty()) return {};
    PROBE_TRY(unproven_.make());
    return in_one([&]() -> Status {
      for (const EpisodeKey& key : keys) PROBE_TRY(unproven_.add(key));
      return {};
    });
  }
  Result<std::vector<EpisodeKey>> unproven() override {
    const std::lock_guard lock(mutex_);
    return unproven_.valid();
  }
  Status forget_unproven() override {
    const std::lock_guard lock(mutex_);
    return unproven_.clear();
  }
  Status forget_unproven(const std::vector<EpisodeKey>& rows) override {
    const std::lock_guard lock(mutex_);
    if (rows.empty()) return {};
    return in_one([&]() -> Status {
      for (const EpisodeKey& key : rows) PROBE_TRY(unproven_.remove(key));
      return {};
    });
  }

  Status freeze_order(std::span<const OrderedEpisode> order) override {
    const std::lock_guard lock(mutex_);
    PROBE_ASSIGN(const auto there, order_.read());
    if (there.empty()) return in_one([&]() -> Status { return order_.write(order); });
    if (is_same_order(there, order)) return {};
    return failed("was begun over " + std::to_string(there.size()) +
                      " episodes in an order of theirs, and this call chooses " +
                      std::to_string(order.size()) +
                      ", not the same ones: tasks, episodes and seeds of a run with --until stay as "
                      "they were",
                  dir_);
  }
  Status set_order(std::span<const OrderedEpisode> order) override {
    const std::lock_guard lock(mutex_);
    return in_one([&]() -> Status {
      PROBE_TRY(order_.clear());
      return order_.write(order);
    });
  }
  Status forget_until() override {
    const std::lock_guard lock(mutex_);
    record_.identity.until.clear();
    return in_one([&]() -> Status {
      PROBE_TRY(order_.clear());
      return write_record("update run set value = ? where name = 'record'");
    });
  }

  Status write_call(const RunCall& call) override {
    const std::lock_guard lock(mutex_);
    return calls_.write(call_to_json(call));
  }
  Status add_call(const RunCall& call) override {
    const std::lock_guard lock(mutex_);
    return calls_.add(call_to_json(call));
  }

 private:
  // Where each task has an order of its own, how tasks lie between one another means nothing: a merge
  // of shards has them one after the other.
  bool is_same_order(std::vector<OrderedEpisode> there, std::span<const OrderedEpisode> asked) const {
    std::vector<OrderedEpisode> here(asked.begin(), asked.end());
    if (record_.identity.until.ends_with(kOfEachTask)) {
      const auto task = [](const OrderedEpisode& one) -> const std::string& { return one.key.task; };
      std::ranges::stable_sort(there, {}, task);
      std::ranges::stable_sort(here, {}, task);
    }
    return there == here;
  }

  // All that `write` does, or nothing of it.
  Status in_one(const std::function<Status()>& write) {
    PROBE_TRY(database_.execute("begin immediate"));
    if (Status written = write(); !written) {
      (void)database_.execute("rollback");
      return written;
    }
    return database_.execute("commit");
  }
  Status insert_row(const ResultRow& row, int task_order) {
    Statement insert(database_, insert_episode().c_str(), Access::kWrite);
    bind_episode(insert, row, task_order);
    insert.next();
    return insert.done();
  }

  Status write_plan(std::span<const std::byte> plan_bytes) const {
    PROBE_ASSIGN(const std::string file, file_inside(dir_, "suite.plan"));
    return write_file(file, plan_bytes);
  }

  // A plan that was lost, damaged or exchanged since: `plan_bytes` are of the root in the record.
  Status put_plan_back(std::span<const std::byte> plan_bytes) const {
    if (plan_bytes.empty()) return {};
    const auto there = read_file(plan_path(dir_));
    if (there && std::ranges::equal(std::as_bytes(std::span(*there)), plan_bytes)) return {};
    // Of one root there may be two files: with other texts, which are not part of it.
    if (open_run_plan(dir_).ok()) return {};
    PROBE_TRY(write_plan(plan_bytes));
    return sync_folder(dir_);
  }

  Status write_record(const char* sql) {
    Statement write(database_, sql, Access::kWrite);
    write.bind(record_to_text(record_)).next();
    return write.done();
  }

  Status raise_schema() {
    record_.schema = kSchemaVersion;
    PROBE_TRY(database_.execute("begin immediate"));
    PROBE_TRY(database_.execute(raised_schema().c_str()));
    PROBE_TRY(write_record("update run set value = ? where name = 'record'"));
    return database_.execute("commit");
  }

  // Traces and videos that a killed process did not finish: of our names, and only where no link
  // leads out of this folder, because what lies behind one is not ours to clean.
  void remove_leftovers() const {
    // "suite.plan.1234-0.tmp", "chosen.1234-1.tmp": killed before the folder had its plan, or knew
    // what was chosen.
    const auto own = list_folder(dir_);
    for (const std::string& name : own ? *own : std::vector<std::string>{}) {
      const bool is_ours = name.starts_with("suite.plan.") || name.starts_with("chosen.");
      if (is_ours && name.ends_with(".tmp"))
        std::remove((fs::path(dir_) / name).c_str());
    }
    for (const char* kind : {"traces", "videos"}) {
      const std::string all = (fs::path(dir_) / kind).string();
      if (is_link(all)) continue;
      const auto tasks = list_folder(all);
      if (!tasks) continue;
      for (const std::string& task : *tasks) {
        const fs::path folder = fs::path(all) / task;
        if (is_link(folder.string())) continue;
        const auto names = list_folder(folder.string());
        if (!names) continue;
        for (const std::string& name : *names) {
          if (is_leftover(name)) std::remove((folder / name).c_str());
        }
      }
    }
  }

  std::string dir_;
  FolderLock lock_;
  std::mutex mutex_;  // of the database
  bool is_watched_ = false;
  Database database_;
  RunRecord record_;
  CallsTable calls_{database_};
  UnprovenTable unproven_{database_};
  RemarksTable remarks_{database_};
  OrderTable order_{database_};
};

}  // namespace

std::string plan_path(const std::string& dir) { return (fs::path(dir) / "suite.plan").string(); }

std::string trace_path(const std::string& dir, const EpisodeKey& key) {
  return (fs::path(dir) / relative_trace(key)).string();
}

std::string video_path(const std::string& dir, const EpisodeKey& key) {
  return (fs::path(dir) / "videos" / (file_stem(key) + ".mp4")).string();
}

Result<std::unique_ptr<Store>> Store::open(const std::string& dir, const RunRecord& record,
                                           std::span<const std::byte> plan_bytes) {
  if (dir.empty()) return failed("no folder to write into", "-o");
  PROBE_TRY(check_holds_no_other(dir, FolderKind::kRun));
  if (auto made = make_lasting_folders(dir); !made) return failed(made.failure().message, dir);
  PROBE_ASSIGN(FolderLock lock, FolderLock::take(dir));
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kWrite));
  auto store = std::make_unique<FolderStore>(dir, std::move(lock), std::move(database));
  PROBE_TRY(store->begin(record, plan_bytes));
  return std::unique_ptr<Store>(std::move(store));
}

Result<std::optional<RunRecord>> find_run_record(const std::string& dir) {
  if (!is_there(database_path(dir))) return std::optional<RunRecord>();
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  return load_record(database);
}

Result<RunRecord> read_run_record(const std::string& dir) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(auto record, find_run_record(dir));
  if (!record) return failed("no run here: results.sqlite is empty", dir);
  return std::move(*record);
}

Result<std::vector<RunCall>> read_run_calls(const std::string& dir) {
  PROBE_ASSIGN(const RunRecord record, read_run_record(dir));
  std::vector<RunCall> calls;
  if (record.schema < 2) return calls;
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  Statement select(database, "select value from calls order by number");
  while (select.next()) {
    PROBE_ASSIGN(RunCall call, call_from_json(select.text(0), database.path()));
    calls.push_back(std::move(call));
  }
  PROBE_TRY(select.done());
  return calls;
}

Result<std::vector<EpisodeKey>> read_unproven(const std::string& dir) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  return UnprovenTable(database).valid();
}

Result<std::vector<OrderedEpisode>> read_order(const std::string& dir) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  return OrderTable(database).read();
}

Result<ReadingSummary> read_reading_summary(const std::string& dir) {
  PROBE_ASSIGN(const auto calls, read_run_calls(dir));
  PROBE_ASSIGN(const auto unproven, read_unproven(dir));
  return summarize_readings(calls, unproven.size());
}

Result<std::vector<ResultRow>> read_results(const std::string& dir) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  return load_rows(database, dir);
}

Status for_each_row(const std::string& dir, const RowVisitor& visit) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  return visit_rows(database, dir, visit);
}

Result<std::vector<ResultRow>> read_episode(const std::string& dir, const std::string& task,
                                            int episode) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  PROBE_ASSIGN(RowReader reader, RowReader::open(database, dir));
  std::vector<ResultRow> found;
  std::pair<std::int64_t, std::int64_t> last{std::int64_t{episode} - 1, INT64_MAX};
  for (;;) {
    PROBE_ASSIGN(std::vector<ResultRow> rows, reader.read(task, last.first, last.second));
    for (ResultRow& row : rows) {
      const std::pair<std::int64_t, std::int64_t> key{row.episode, row.seed};
      if (row.episode != episode) return found;
      if (key <= last) return no_texts(database);
      last = key;
      found.push_back(std::move(row));
    }
    if (rows.size() < kRowsAtOnce) return found;
  }
}

Result<std::vector<std::string>> read_stored_tasks(const std::string& dir) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  PROBE_ASSIGN(const auto record, load_record(database));
  if (!record) return failed("no run here: results.sqlite is empty", dir);
  return tasks_in_order(database);
}

Result<std::size_t> count_rows(const std::string& dir) {
  if (!is_there(database_path(dir))) return no_run(dir);
  PROBE_ASSIGN(Database database, Database::open(database_path(dir), Access::kRead));
  Statement count(database, "select count(*) from episodes");
  const std::int64_t rows = count.next() ? count.whole(0) : 0;
  PROBE_TRY(count.done());
  return static_cast<std::size_t>(rows);
}

}  // namespace probe::store
