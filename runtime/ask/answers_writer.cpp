// The writer of a folder of answers, and the thread that fills its tables.
#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <thread>

#include "runtime/ask/answer_table.h"
#include "runtime/ask/answers.h"
#include "runtime/ask/vouch.h"
#include "runtime/base/file.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/inside.h"
#include "runtime/base/paths.h"
#include "runtime/store/calls_table.h"
#include "runtime/store/folder_lock.h"
#include "runtime/store/store.h"

namespace probe::ask {
namespace {

namespace fs = std::filesystem;
using store::Database;
using store::Statement;
using Access = Database::Access;

// Rows that wait for the disk at most; whoever brings one more waits with them.
constexpr std::size_t kMostWaiting = 1024;

class FolderAnswers final : public Answers {
 public:
  FolderAnswers(std::string dir, store::FolderLock lock, Database database)
      : dir_(std::move(dir)), lock_(std::move(lock)), database_(std::move(database)) {}
  ~FolderAnswers() override {
    {
      const std::lock_guard guard(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    if (writer_.joinable()) writer_.join();
  }

  Status begin(const AskRecord& record, std::span<const std::byte> plan_bytes) {
    PROBE_ASSIGN(const auto stored, load_record(database_));
    PROBE_TRY(database_.execute(answers_schema().c_str()));
    if (stored) {
      const AskChanges changes = changes_between(*stored, record);
      for (const std::string& change : {changes.identity, changes.content}) {
        if (!change.empty())
          return Failure{Fault::kStore, change + "; take another folder or remove this one", dir_};
      }
    }
    remove_leftovers();
    if (stored) {
      PROBE_TRY(put_plan_back(plan_bytes));
    } else {
      // The plan goes first: a folder with a record always has its plan.
      PROBE_TRY(write_plan(plan_bytes));
      PROBE_TRY(sync_folder(dir_));
      Statement write(database_, "insert into ask values ('record', ?)", Access::kWrite);
      write.bind(to_text(record)).next();
      PROBE_TRY(write.done());
    }
    if (auto plan = open_asked_plan(dir_)) {
      plan_ = std::move(*plan);
      voucher_.emplace(*plan_, record.identity.model);
    }
    writer_ = std::thread([this] { write_on(); });
    return {};
  }

  Result<Stored> stored(const std::string& start_id) override {
    const std::lock_guard guard(database_mutex_);
    Stored found;
    PROBE_ASSIGN(const auto rows, valid_rows(start_id));
    for (const AnswerRow& row : rows) found.answers.push_back(key_of(row));
    Statement left_out(database_, (select_left_out() + " where \"start_id\" = ?").c_str());
    left_out.bind(start_id);
    while (left_out.next()) {
      const LeftOut out = left_out_at(left_out).left_out;
      found.left_out.push_back({out.question_id, 0, Arm::kPicture, out.episode, out.seed});
    }
    PROBE_TRY(left_out.done());
    std::ranges::sort(found.left_out);
    return found;
  }

  Result<std::vector<AnswerRow>> rows(const std::string& start_id) override {
    const std::lock_guard guard(database_mutex_);
    return valid_rows(start_id);
  }

  Status commit(const AnswerRow& row, std::uint32_t place) override {
    return hand_over({row, {}, place, false});
  }
  Status leave_out(const LeftOut& left_out, std::uint32_t place) override {
    return hand_over({{}, left_out, place, true});
  }

  Status flush() override {
    std::unique_lock guard(mutex_);
    changed_.wait(guard, [this] { return (waiting_.empty() && !is_writing_) || failure_; });
    if (failure_) return *failure_;
    return {};
  }

  Status write_call(const AskCall& call) override {
    const std::lock_guard guard(database_mutex_);
    return calls_.write(call_to_json(call));
  }
  Status add_call(const AskCall& call) override {
    const std::lock_guard guard(database_mutex_);
    return calls_.add(call_to_json(call));
  }

 private:
  // By key. Whoever calls holds the database.
  Result<std::vector<AnswerRow>> valid_rows(const std::string& start_id) {
    std::vector<AnswerRow> rows;
    Statement answers(database_, (select_answers() + " where \"start_id\" = ?").c_str());
    answers.bind(start_id);
    while (answers.next()) {
      AnswerRow row = answer_at(answers).row;
      if (voucher_) voucher_->vouch(row);
      if (!row.invalid) rows.push_back(std::move(row));
    }
    PROBE_TRY(answers.done());
    std::ranges::sort(rows, {}, [](const AnswerRow& row) { return key_of(row); });
    return rows;
  }

  struct Waiting {
    AnswerRow row;
    LeftOut left_out;
    std::uint32_t place = 0;
    bool is_left_out = false;
  };

  Status hand_over(Waiting item) {
    std::unique_lock guard(mutex_);
    changed_.wait(guard, [this] { return waiting_.size() < kMostWaiting || failure_; });
    if (failure_) return *failure_;
    waiting_.push_back(std::move(item));
    changed_.notify_all();
    return {};
  }

  // Whatever waits goes into one transaction, and one wait for the disk.
  void write_on() {
    std::unique_lock guard(mutex_);
    for (;;) {
      changed_.wait(guard, [this] { return !waiting_.empty() || ended_; });
      if (waiting_.empty()) return;
      std::vector<Waiting> items;
      items.swap(waiting_);
      is_writing_ = true;
      changed_.notify_all();
      guard.unlock();
      Status written = write(items);
      guard.lock();
      is_writing_ = false;
      if (!written) failure_ = written.failure();
      changed_.notify_all();
      if (failure_) return;
    }
  }

  Status write(const std::vector<Waiting>& items) {
    const std::lock_guard guard(database_mutex_);
    PROBE_TRY(database_.execute("begin immediate"));
    for (const Waiting& item : items) {
      if (Status put = item.is_left_out ? put_left_out(item) : put_row(item); !put) {
        (void)database_.execute("rollback");
        return put;
      }
    }
    return database_.execute("commit");
  }

  Status put_row(const Waiting& item) {
    Statement insert(database_, insert_answer().c_str(), Access::kWrite);
    bind_answer(insert, item.row, item.place);
    insert.next();
    return insert.done();
  }

  Status put_left_out(const Waiting& item) {
    Statement insert(database_, insert_left_out().c_str(), Access::kWrite);
    bind_left_out(insert, item.left_out, item.place);
    insert.next();
    return insert.done();
  }

  Status write_plan(std::span<const std::byte> plan_bytes) const {
    PROBE_ASSIGN(const std::string file, file_inside(dir_, "suite.plan"));
    return write_file(file, plan_bytes);
  }

  // A plan that was lost, damaged or exchanged since.
  Status put_plan_back(std::span<const std::byte> plan_bytes) const {
    if (plan_bytes.empty() || open_asked_plan(dir_).ok()) return {};
    PROBE_TRY(write_plan(plan_bytes));
    return sync_folder(dir_);
  }

  void remove_leftovers() const {
    const auto names = list_folder(dir_);
    for (const std::string& name : names ? *names : std::vector<std::string>{}) {
      if (name.starts_with("suite.plan.") && name.ends_with(".tmp"))
        std::remove((fs::path(dir_) / name).c_str());
    }
  }

  std::string dir_;
  store::FolderLock lock_;
  std::mutex database_mutex_;
  Database database_;
  store::CallsTable calls_{database_};
  // Of rows that are found here; none: their plan cannot be read.
  std::optional<plan::Plan> plan_;
  std::optional<Voucher> voucher_;

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  bool is_writing_ = false, ended_ = false;
  std::optional<Failure> failure_;
  std::thread writer_;
};

}  // namespace

bool Answers::Stored::has(const AnswerKey& key) const {
  if (std::ranges::binary_search(answers, key)) return true;
  AnswerKey question = key;
  question.rotation = 0;
  question.arm = Arm::kPicture;
  return std::ranges::binary_search(left_out, question);
}

Result<std::unique_ptr<Answers>> Answers::open(const std::string& dir, const AskRecord& record,
                                               std::span<const std::byte> plan_bytes) {
  if (dir.empty()) return Failure{Fault::kStore, "no folder to write into", "-o"};
  PROBE_TRY(check_holds_no_other(dir, FolderKind::kAnswers));
  if (auto made = make_lasting_folders(dir); !made)
    return Failure{Fault::kStore, made.failure().message, dir};
  PROBE_ASSIGN(store::FolderLock lock, store::FolderLock::take(dir));
  PROBE_ASSIGN(Database database,
               Database::open(answers_path(dir), Access::kWrite, kAnswersAdvice));
  auto answers = std::make_unique<FolderAnswers>(dir, std::move(lock), std::move(database));
  PROBE_TRY(answers->begin(record, plan_bytes));
  return std::unique_ptr<Answers>(std::move(answers));
}

}  // namespace probe::ask
