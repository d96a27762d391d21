// The tables of answers.sqlite: their columns, and rows in and out of statements. What a folder is
// and who writes it: answers.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/ask/answers.h"
#include "runtime/store/database.h"

namespace probe::ask {

inline constexpr const char* kAnswersAdvice = "move this file away and ask again";
std::string answers_path(const std::string& dir);

// SQL that makes the tables that are absent.
std::string answers_schema();
// Nothing when the database has no record yet; fails (kStore) on tables of another layout.
Result<std::optional<AskRecord>> load_record(store::Database& database);

// "insert or replace into TABLE", for the binders below.
const std::string& insert_answer();
const std::string& insert_left_out();
void bind_answer(store::Statement& insert, const AnswerRow& row, std::uint32_t place);
void bind_left_out(store::Statement& insert, const LeftOut& left_out, std::uint32_t place);

// "select PLACE, FIELDS from answers", for answer_at().
const std::string& select_answers();
// The statement's row; a damaged one is told as invalid.
struct PlacedAnswer {
  AnswerRow row;
  std::uint32_t place = 0;
};
PlacedAnswer answer_at(const store::Statement& select);
const std::string& select_left_out();
struct PlacedLeftOut {
  LeftOut left_out;
  std::uint32_t place = 0;
};
PlacedLeftOut left_out_at(const store::Statement& select);

}  // namespace probe::ask
