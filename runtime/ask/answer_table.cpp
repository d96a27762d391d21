#include "runtime/ask/answer_table.h"

#include <filesystem>

#include "runtime/ask/answer_fields.h"
#include "runtime/store/calls_table.h"
#include "runtime/base/folder_kind.h"

namespace probe::ask {
namespace {

using store::Database;
using store::Statement;
using Kind = Statement::Kind;

constexpr std::string_view kRecordColumns[] = {"name", "value"};
constexpr std::string_view kLeftOutColumns[] = {
    "question_id", "start_id", "episode", "seed", "place", "set", "family", "task", "why"};

std::vector<std::string_view> answer_columns() {
  std::vector<std::string_view> columns = {"place"};
  columns.insert(columns.end(), answer_fields().begin(), answer_fields().end());
  return columns;
}

Status expect_tables(Database& database) {
  const std::vector<std::string_view> columns = answer_columns();
  const Database::Table tables[] = {{"ask", kRecordColumns},
                                    {"answers", columns},
                                    {"left_out", kLeftOutColumns},
                                    {"calls", store::kCallColumns}};
  return database.expect(tables);
}

// Names in quotes, as `set` and `right` are words of SQL.
template <typename Names>
std::string listed(const Names& names) {
  std::string text;
  for (const std::string_view name : names)
    text += (text.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  return text;
}

std::string places(std::size_t count) {
  std::string text = "?";
  for (std::size_t i = 1; i < count; ++i) text += ", ?";
  return text;
}

void bind_cell(Statement& statement, const Json& cell) {
  if (cell.is_null()) {
    statement.bind_null();
  } else if (cell.is_boolean()) {
    statement.bind(cell.get<bool>() ? 1 : 0);
  } else if (cell.is_number_integer()) {
    statement.bind(cell.get<std::int64_t>());
  } else if (cell.is_number()) {
    statement.bind(cell.get<double>());
  } else {
    statement.bind(cell.is_string() ? cell.text() : cell.dump());
  }
}

Json cell_at(const Statement& row, int column) {
  switch (row.kind(column)) {
    case Kind::kNull:
      return {};
    case Kind::kWhole:
      return Json(row.whole(column));
    case Kind::kReal:
      return Json(row.real(column));
    case Kind::kText:
      break;
    case Kind::kOther:
      return Json::object();  // of no field's type
  }
  return Json(row.text(column));
}

// A list is stored as its text.
bool set_stored_cell(AnswerRow& row, std::size_t field, const Json& cell) {
  if (set_cell(row, field, cell)) return true;
  return cell.is_string() && set_cell(row, field, Json::parse(cell.text()));
}

}  // namespace

std::string answers_path(const std::string& dir) {
  return probe::path_in(dir, probe::kAnswersDatabase);
}

std::string answers_schema() {
  std::string key = "\"start_id\"";  // first: the answers about a start are asked for together
  for (std::size_t i = 0; i < kKeyFields; ++i) {
    if (answer_fields()[i] != "start_id") key += ", \"" + std::string(answer_fields()[i]) + "\"";
  }
  return "create table if not exists ask (name text primary key, value text not null) without "
         "rowid; create table if not exists answers (" +
         listed(answer_columns()) + ", primary key (" + key +
         ")) without rowid; create table if not exists left_out (" + listed(kLeftOutColumns) +
         ", primary key (\"start_id\", \"question_id\", \"episode\", \"seed\")) without rowid; " +
         std::string(store::kCallsSchema);
}

Result<std::optional<AskRecord>> load_record(Database& database) {
  PROBE_TRY(expect_tables(database));
  Statement table(database, "select 1 from sqlite_master where name = 'ask'");
  const bool begun = table.next();
  PROBE_TRY(table.done());
  if (!begun) return std::optional<AskRecord>();
  Statement select(database, "select value from ask where name = 'record'");
  if (!select.next()) {
    PROBE_TRY(select.done());
    return std::optional<AskRecord>();
  }
  PROBE_ASSIGN(AskRecord record, record_from_text(select.text(0), database.path()));
  return std::optional(std::move(record));
}

const std::string& insert_answer() {
  static const std::string sql = "insert or replace into answers (" + listed(answer_columns()) +
                                 ") values (" + places(answer_columns().size()) + ")";
  return sql;
}

const std::string& insert_left_out() {
  static const std::string sql = "insert or replace into left_out (" + listed(kLeftOutColumns) +
                                 ") values (" + places(std::size(kLeftOutColumns)) + ")";
  return sql;
}

void bind_answer(Statement& insert, const AnswerRow& row, std::uint32_t place) {
  insert.bind(std::int64_t{place});
  for (std::size_t field = 0; field < answer_fields().size(); ++field)
    bind_cell(insert, cell_of(row, field));
}

void bind_left_out(Statement& insert, const LeftOut& out, std::uint32_t place) {
  insert.bind(out.question_id).bind(out.start_id).bind(out.episode).bind(out.seed);
  insert.bind(std::int64_t{place}).bind(out.set).bind(out.family).bind(out.task);
  insert.bind(out.why);
}

const std::string& select_answers() {
  static const std::string sql = "select " + listed(answer_columns()) + " from answers";
  return sql;
}

PlacedAnswer answer_at(const Statement& select) {
  PlacedAnswer found{{}, static_cast<std::uint32_t>(select.whole(0))};
  std::string damaged;
  for (std::size_t field = 0; field < answer_fields().size(); ++field) {
    if (!set_stored_cell(found.row, field, cell_at(select, 1 + static_cast<int>(field))))
      damaged = answer_fields()[field];
  }
  if (damaged.empty()) return found;
  found.row.invalid = "store: its `" + damaged + "` in answers.sqlite cannot be read";
  found.row.right.reset();
  return found;
}

const std::string& select_left_out() {
  static const std::string sql = "select " + listed(kLeftOutColumns) + " from left_out";
  return sql;
}

PlacedLeftOut left_out_at(const Statement& select) {
  return {{select.text(0), select.text(1), select.number(2), select.number(3), select.text(5),
           select.text(6), select.text(7), select.text(8)},
          static_cast<std::uint32_t>(select.whole(4))};
}

}  // namespace probe::ask
