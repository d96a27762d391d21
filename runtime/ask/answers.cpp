#include "runtime/ask/answers.h"

#include "runtime/ask/answer_table.h"
#include "runtime/ask/vouch.h"
#include "runtime/base/file.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/paths.h"
#include "runtime/store/store.h"

namespace probe::ask {
namespace {

using store::Database;
using store::Statement;
using Access = Database::Access;

Failure failed(const std::string& message, const std::string& where) {
  return {Fault::kStore, message, where};
}

Result<Database> open_to_read(const std::string& dir) {
  if (!holds_answers(dir)) {
    return failed(probe::holds_run(dir) ? "holds a run, not a model's answers"
                                        : "no answers here: answers.sqlite is absent",
                  dir);
  }
  PROBE_ASSIGN(Database database, Database::open(answers_path(dir), Access::kRead, kAnswersAdvice));
  PROBE_ASSIGN(const auto record, load_record(database));
  if (!record) return failed("no answers here: answers.sqlite is empty", dir);
  return database;
}

}  // namespace

Result<std::optional<AskRecord>> find_ask_record(const std::string& dir) {
  if (!holds_answers(dir)) return std::optional<AskRecord>();
  PROBE_ASSIGN(Database database, Database::open(answers_path(dir), Access::kRead, kAnswersAdvice));
  return load_record(database);
}

Result<AskRecord> read_ask_record(const std::string& dir) {
  PROBE_ASSIGN(Database database, open_to_read(dir));
  PROBE_ASSIGN(auto record, load_record(database));
  if (!record) return failed("no answers here: answers.sqlite is empty", dir);
  return std::move(*record);
}

Result<std::vector<AskCall>> read_ask_calls(const std::string& dir) {
  PROBE_ASSIGN(Database database, open_to_read(dir));
  std::vector<AskCall> calls;
  Statement select(database, "select value from calls order by number");
  while (select.next()) {
    PROBE_ASSIGN(AskCall call, call_from_json(select.text(0), database.path()));
    calls.push_back(std::move(call));
  }
  PROBE_TRY(select.done());
  return calls;
}

Result<plan::Plan> open_asked_plan(const std::string& dir) {
  PROBE_ASSIGN(const AskRecord record, read_ask_record(dir));
  const std::string path = store::plan_path(dir);
  auto plan = plan::Plan::open(path);
  const char* const mend = "; `vlaprobe ask` with the plan it was begun with puts it back";
  if (!plan) return failed("the plan cannot be read: " + plan.failure().message + mend, path);
  if (to_hex(plan->root()) == record.identity.plan_root) return plan;
  return failed(std::string("is not the plan whose questions were asked") + mend, path);
}

Status for_each_answer(const std::string& dir,
                       const std::function<Status(AnswerRow, std::uint32_t)>& visit) {
  PROBE_ASSIGN(Database database, open_to_read(dir));
  PROBE_ASSIGN(const plan::Plan plan, open_asked_plan(dir));
  PROBE_ASSIGN(const AskRecord record, read_ask_record(dir));
  Voucher voucher(plan, record.identity.model);
  const std::string sql =
      select_answers() + " order by place, episode, seed, arm, rotation, question_id, start_id";
  Statement select(database, sql.c_str());
  while (select.next()) {
    PlacedAnswer found = answer_at(select);
    voucher.vouch(found.row);
    PROBE_TRY(visit(std::move(found.row), found.place));
  }
  return select.done();
}

Result<std::vector<AnswerRow>> read_answers(const std::string& dir) {
  std::vector<AnswerRow> rows;
  PROBE_TRY(for_each_answer(dir, [&](AnswerRow row, std::uint32_t) -> Status {
    rows.push_back(std::move(row));
    return {};
  }));
  return rows;
}

Status for_each_left_out(const std::string& dir,
                         const std::function<Status(LeftOut, std::uint32_t)>& visit) {
  PROBE_ASSIGN(Database database, open_to_read(dir));
  const std::string sql =
      select_left_out() + " order by place, episode, seed, question_id, start_id";
  Statement select(database, sql.c_str());
  while (select.next()) {
    PlacedLeftOut found = left_out_at(select);
    PROBE_TRY(visit(std::move(found.left_out), found.place));
  }
  return select.done();
}

}  // namespace probe::ask
