// An AnswerRow as named cells, for the database, JSON and CSV alike. Knows no files.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "runtime/ask/reading/answer_row.h"
#include "runtime/base/json.h"

namespace probe::ask {

// In the order of answer_fields.def.
std::span<const std::string_view> answer_fields();
inline constexpr std::size_t kKeyFields = 6;

// The row's `field`-th cell: null, a truth, a number, a text, or a list.
Json cell_of(const AnswerRow& row, std::size_t field);
// False where the cell is not of the field's type.
bool set_cell(AnswerRow& row, std::size_t field, const Json& cell);

// An object with exactly the documented keys.
Json to_json(const AnswerRow& row);
// One line without its end; csv_header() has the names. Lists are JSON in quotes.
std::string to_csv(const AnswerRow& row);
std::string csv_header();

}  // namespace probe::ask
