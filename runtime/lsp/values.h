// Values of the protocol as JSON, and what is read of them: nothing is believed to be there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/diag/diagnostic.h"
#include "compiler/language/snapshot.h"
#include "runtime/base/json.h"

namespace probe::lsp {

Json to_json(const language::Position& position);
Json to_json(const language::Range& range);
Json location(const language::Snapshot& snapshot, const Span& span);
Json text_edit(const language::Range& range, const std::string& text);
// `has_related`: whether the editor shows other places.
Json to_json(const language::Snapshot& snapshot, const Diagnostic& diagnostic, bool has_related);
Json markdown(const std::string& text);

// Nothing where it is not what it should be.
std::optional<language::Position> read_position(const Json* value);
std::optional<language::Range> read_range(const Json* value);
// Null where a key on the way is missing: find(params, {"textDocument", "uri"}).
const Json* find(const Json& value, std::initializer_list<std::string_view> keys);
std::string read_text(const Json& value, std::initializer_list<std::string_view> keys);
bool read_flag(const Json& value, std::initializer_list<std::string_view> keys);

}  // namespace probe::lsp
